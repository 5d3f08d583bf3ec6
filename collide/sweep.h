// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Do two sets of spheres stay apart while they move?
//
// @code{.cpp}
// #include <spherule/collide/sweep.h>
// #include <spherule/spheretree/build.h>
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
#include "collide/motion.h"

#include <chrono>
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
