// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Do two sets of spheres stay apart while they move?
//
// @code{.cpp}
// #include <spherule/collide/sweep.h>
// #include <spherule/spheretree/sphere_tree.h>
// #include <cassert>
// #include <vector>
//
// const auto tree = spherule::build_tree(std::vector<spherule::Sphere>{{{0, 0, 0}, 1}});
// const auto still = spherule::Motion::still(spherule::Pose());
// const auto passing = spherule::Motion::between(spherule::Pose::from_translation({-5, 0, 0}),
//                                                spherule::Pose::from_translation({5, 0, 0}));
// const spherule::SweepResult swept = sweep(tree, passing, tree, still);
// assert(swept.verdict == spherule::Verdict::kCollision);
// assert(swept.free_until <= 0.3 && 0.3 <= swept.contact_at && swept.contact_at < 0.301);
// @endcode

#include "collide/collide.h"
#include "collide/motion/motion.h"
#include "geometry/pose.h"
#include "spheretree/sphere_tree.h"

#include <chrono>
#include <cstdint>
#include <limits>

namespace spherule {

// How closely a motion is examined.
struct SweepRequest {
  // What comes this close counts as contact.
  double clearance = 0.0;
  // Intervals of t no longer than this are not divided any further: if the gap exceeds the
  // clearance by more than about (half the resolution) x (speed at which the bodies can approach)
  // everywhere, the motion is proved free. The default leaves 0.05 mm per metre of way. A finer one
  // costs little, because the search ends at the first interval that it cannot prove; what costs is
  // a free motion close by, of up to 2 / resolution evaluations. From 2^-40 to 1.
  double resolution = 1e-4;
  // Limits, with the verdict kUnknown unless a contact was found before.
  std::uint64_t max_node_tests = std::numeric_limits<std::uint64_t>::max();
  std::chrono::nanoseconds max_time = std::chrono::nanoseconds::max();
};

// What is proved of a motion.
struct SweepResult {
  // kFree: proved free at every t in [0, 1]. kCollision: in contact at `contact_at`. kUnknown
  // counts as a collision.
  Verdict verdict = Verdict::kUnknown;
  // If positive, every t in [0, free_until] is proved free. Unless a limit cut the search short,
  // it is less than the resolution away from a t that could not be proved (or it is 1).
  double free_until = 0.0;
  // Only with kCollision, otherwise infinite: a t at which contact is proved, in the sense of
  // collides(), but for rounding not before free_until. The first contact may be earlier.
  double contact_at = std::numeric_limits<double>::infinity();
  SpherePair contact;             // two spheres in contact at that t
  std::uint64_t evaluations = 0;  // instants at which the trees were examined
  QueryCost cost;
};

// Whether two sets of spheres stay apart while they move (G6).
//
// A gap of at most the clearance in exact arithmetic, touching included, at any t in [0, 1], under
// exactly the motions (see Motion), is never called free. Nor is a motion for which collides(), or
// with a clearance within(), says yes at pose_at(t) for any t. kCollision means that the canonical
// test accepts the spheres `contact` at pose_at(contact_at) of the two motions. The verdict and
// the times do not change if the bodies are exchanged, nor with the shape of the trees, unless a
// limit cuts the search short.
//
// How (adaptive bisection with motion bounds: Schwarzer, Saha and Latombe, "Adaptive dynamic
// collision checking for single and multiple articulated robots in complex environments", 2005; in
// the manner of conservative advancement, Mirtich, 1996): what is apart by more at the middle of an
// interval than it can approach until its ends is apart throughout; else the part for which the gap
// suffices is cut out, and the rest is divided, from left to right. Allocates no more than
// collides().
//
// Throws Error for a clearance or a resolution that cannot be used.
SweepResult sweep(const SphereTree& a, const Motion& motion_a, const SphereTree& b,
                  const Motion& motion_b, const SweepRequest& request = {});

}  // namespace spherule

// What is requested of a motion in the space of a mechanism's variables, and what is proved of it:
// by RobotChecker::check_edge() (robot/check/robot_checker.h).
//
// @code{.cpp}
//
// const spherule::EdgeRequest request{.resolution = 1e-3, .first = true};
// spherule::require_resolution(request.resolution);  // throws Error unless above zero
// const spherule::EdgeResult unchecked;
// assert(unchecked.verdict == spherule::Verdict::kUnknown && unchecked.free_until == 0.0);
// @endcode

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
