// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

#include <memory>

namespace spherule {

// All pairs of spheres: each body's centres are moved to the world and compared with every sphere
// of the obstacles in a plain loop that the compiler turns into vector instructions (single
// precision; radii padded by what that costs). Without any hierarchy or box.
std::unique_ptr<Checker> make_brute_force_checker(const Workload& workload);

}  // namespace spherule
