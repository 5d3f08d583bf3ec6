// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Moving bodies with an oracle for each, and what the tests of sweep() check of every answer.

#include "collide/sweep.h"
#include "tests/collide/exact_motion.h"
#include "tests/collide/trees.h"

#include <vector>

namespace spherule::test {

struct Body {
  SphereTree tree;
  Motion motion;
  ExactMotion<long double> exact;
};

Body turning_body(const std::vector<Sphere>& spheres, const Pose& start,
                  const Eigen::Vector3d& axis, double angle,
                  const Eigen::Vector3d& displacement = Eigen::Vector3d::Zero(),
                  const Eigen::Vector3d& reference = Eigen::Vector3d::Zero(), int branching = 8);
Body body_between(const std::vector<Sphere>& spheres, const Pose& start, const Pose& end,
                  const Eigen::Vector3d& reference = Eigen::Vector3d::Zero());
Body still_body(const std::vector<Sphere>& spheres, const Pose& pose = {});

// Static, from pose to pose, or turning (three times as often as each), within some `size`.
Body random_body(SceneRandom& random, double size);

// The gap of the two sets at t under the exact motions, negative where they overlap.
double gap_at(const Body& a, const Body& b, double t);

// How fast two bodies can approach each other, roughly from above.
double fastest(const Body& a, const Body& b);

SweepResult run(const Body& a, const Body& b, const SweepRequest& request = {});

// Holds a result against `steps` instants; returns the least gap there.
double expect_true(const Body& a, const Body& b, const SweepResult& result, int steps,
                   const SweepRequest& request = {});

void expect_same(const SweepResult& one, const SweepResult& other);

}  // namespace spherule::test
