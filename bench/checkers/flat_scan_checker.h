// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"
#include "collide/search/instruction_set.h"

#include <memory>

namespace spherule {

// The same spheres without a hierarchy, scanned in single precision by the widest vectors that the
// machine has: what a user of a list of spheres would write, as well as we can. Forward kinematics
// in double, with sines and cosines side by side. Radii are padded by what rounding costs, so that
// no contact is missed.
enum class FlatScan {
  // All pairs of each body's and each obstacle's spheres, to the first contact.
  kAllPairs,
  // The sphere around each body goes first, against the sphere around the obstacle and against each
  // of
  // its spheres; what is left is compared with all spheres of the body.
  kSpheresInFront,
};

// Throws Error for a robot with more than 8 variables or a joint that shifts, for more than 32
// obstacles, and for instructions that this machine has not got.
std::unique_ptr<Checker> make_flat_scan_checker(
    const Workload& workload, FlatScan scan, InstructionSet instructions = best_instruction_set());

}  // namespace spherule
