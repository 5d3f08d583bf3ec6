// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What is requested of a motion in the space of a mechanism's variables, and what is proved of it:
// by RobotChecker::check_edge() (robot/check/robot_checker.h).
//
// @code{.cpp}
// #include <spherule/collide/edge.h>
// #include <cassert>
//
// const spherule::EdgeRequest request{.resolution = 1e-3, .first = true};
// spherule::require_resolution(request.resolution);  // throws Error unless above zero
// const spherule::EdgeResult unchecked;
// assert(unchecked.verdict == spherule::Verdict::kUnknown && unchecked.free_until == 0.0);
// @endcode

#include "collide/collide.h"

#include <cstdint>
#include <limits>

namespace spherule {

// Which way a continuous joint turns on a motion from one angle to another.
enum class ContinuousMotion {
  // Straight from number to number: from 3 to -3 rad back by 6 rad.
  kAsGiven,
  // To the same posture by at most half a turn: from 3 to -3 rad on through pi, by 0.28 rad.
  kShortest,
};

// How to check a straight motion in the space of a mechanism's variables.
struct EdgeRequest {
  // What comes closer than about half of this, in the unit of the trees, need not be proved free.
  // All else is proved free, or a contact found, unless the budget ends before.
  double resolution = 1e-4;
  // Find the first contact, and prove all before it; otherwise any will do, which is faster.
  bool first = false;
  // Of a robot with continuous joints: which of the motions between two configurations is meant.
  ContinuousMotion continuous = ContinuousMotion::kAsGiven;
  // Evaluate no more configurations than this, with the verdict kUnknown unless a contact was
  // found.
  std::uint64_t max_configurations = std::numeric_limits<std::uint64_t>::max();
};

// Throws Error for a resolution that is not above zero.
void require_resolution(double resolution);

// What is proved of a motion.
struct EdgeResult {
  // kFree: proved at every point of the motion (G6). kCollision: at `contact_at` the canonical test
  // finds a contact or, where limits are enforced, a joint is outside of its limits. kUnknown:
  // something comes closer than the resolution tells apart and no contact was found, or
  // max_configurations was reached; count it as a collision.
  Verdict verdict = Verdict::kUnknown;
  // Every point of the motion before this fraction is proved free; 1 for kFree (then its end is,
  // too). Nothing is proved if it is 0. More may be free unless the first contact was requested.
  double free_until = 0.0;
  // The fraction of the motion at which that is, from 0 to 1; infinite unless kCollision.
  double contact_at = std::numeric_limits<double>::infinity();
  // Evaluated: the middles of parts of the motion, by a RobotChecker up to eight side by side.
  std::uint64_t configurations = 0;
};

}  // namespace spherule
