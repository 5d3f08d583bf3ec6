// SPDX-License-Identifier: BSD-3-Clause
#include "tests/collide/swept_bodies.h"

#include "collide/collide.h"
#include "spheretree/build.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using LongMotion = ExactMotion<long double>;

std::vector<Vector<long double>> centers_at(const Body& body, double t) {
  std::vector<Vector<long double>> centers;
  for (const Sphere& sphere : body.tree.spheres()) {
    centers.push_back(body.exact.at(t, sphere.center));
  }
  return centers;
}

bool touch_at(const Body& a, const Body& b, double t, double clearance) {
  return within(a.tree, a.motion.pose_at(t), b.tree, b.motion.pose_at(t), clearance);
}

}  // namespace

Body turning_body(const std::vector<Sphere>& spheres, const Pose& start, const Vector3d& axis,
                  double angle, const Vector3d& displacement, const Vector3d& reference,
                  int branching) {
  return {build_tree(spheres, {.branching = branching}),
          Motion::turning(start, axis, angle, displacement, reference),
          LongMotion::turning(start, axis, angle, displacement, reference)};
}

Body body_between(const std::vector<Sphere>& spheres, const Pose& start, const Pose& end,
                  const Vector3d& reference) {
  return {build_tree(spheres), Motion::between(start, end, reference),
          LongMotion::between(start, end, reference)};
}

Body still_body(const std::vector<Sphere>& spheres, const Pose& pose) {
  return body_between(spheres, pose, pose);
}

double gap_at(const Body& a, const Body& b, double t) {
  const auto centers_a = centers_at(a, t);
  const auto centers_b = centers_at(b, t);
  long double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < centers_a.size(); ++i) {
    for (std::size_t j = 0; j < centers_b.size(); ++j) {
      const long double gap = std::sqrt(squared_distance(centers_a[i], centers_b[j])) -
                              a.tree.spheres()[i].radius - b.tree.spheres()[j].radius;
      least = std::min(least, gap);
    }
  }
  return static_cast<double>(least);
}

double fastest(const Body& a, const Body& b) {
  const auto turn = [](const Body& body) {
    double reach = 0.0;
    for (const Sphere& sphere : body.tree.spheres()) {
      reach = std::max(reach, (sphere.center - body.motion.reference()).norm());
    }
    return std::abs(body.motion.angle()) * reach;
  };
  return (a.motion.displacement() - b.motion.displacement()).norm() + turn(a) + turn(b);
}

SweepResult run(const Body& a, const Body& b, const SweepRequest& request) {
  return sweep(a.tree, a.motion, b.tree, b.motion, request);
}

double expect_true(const Body& a, const Body& b, const SweepResult& result, int steps,
                   const SweepRequest& request) {
  double least = std::numeric_limits<double>::infinity();
  const bool free = result.verdict == Verdict::kFree;
  EXPECT_TRUE(!free || result.free_until == 1.0);
  EXPECT_GE(result.free_until, 0.0);
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const double gap = gap_at(a, b, t);
    least = std::min(least, gap);
    if (free || (result.free_until > 0.0 && t <= result.free_until)) {
      EXPECT_GT(gap, request.clearance) << "called free at " << t;
      EXPECT_TRUE(i % 16 != 0 || !touch_at(a, b, t, request.clearance)) << t;
    }
  }
  if (result.free_until > 0.0) {
    EXPECT_GT(gap_at(a, b, result.free_until), request.clearance);
  }
  if (result.verdict == Verdict::kCollision) {
    const double t = result.contact_at;
    EXPECT_GE(t, result.free_until);
    EXPECT_LE(t, 1.0);
    EXPECT_TRUE(spheres_within(a.tree, result.contact.a, a.motion.pose_at(t), b.tree,
                               result.contact.b, b.motion.pose_at(t), request.clearance));
  } else {
    EXPECT_GT(result.contact_at, 1.0);
  }
  return least;
}

void expect_same(const SweepResult& one, const SweepResult& other) {
  EXPECT_EQ(one.verdict, other.verdict);
  EXPECT_EQ(one.free_until, other.free_until);
  EXPECT_EQ(one.contact_at, other.contact_at);
  EXPECT_EQ(one.evaluations, other.evaluations);
}

Body random_body(SceneRandom& random, double size) {
  const int count = random.whole(1, 12);
  const std::vector<Sphere> spheres = random_spheres(random, count, size, 0.3 * size);
  const Pose start = random.pose(1.5 * size);
  const Vector3d reference = random.whole(0, 1) ? random.point(size) : Vector3d::Zero();
  switch (random.whole(0, 3)) {
    case 0:
      return still_body(spheres, start);
    case 1:
      return body_between(spheres, start, random.pose(1.5 * size), reference);
    default:
      return turning_body(spheres, start, random.point(1.0),
                          random.uniform(-1.0, 1.0) * std::ldexp(8.0, -random.whole(0, 12)),
                          random.point(random.whole(0, 1) ? 3.0 * size : 0.0), reference,
                          random.whole(2, 16));
  }
}

}  // namespace spherule::test
