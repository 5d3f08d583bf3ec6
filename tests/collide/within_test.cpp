// SPDX-License-Identifier: BSD-3-Clause
// Clearances against exact arithmetic and against distance().

#include "base/error.h"
#include "collide/collide.h"
#include "spheretree/build.h"
#include "tests/collide/exact_scene.h"
#include "tests/collide/trees.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace spherule::test::within_test {
namespace {

struct Scene {
  SphereTree a, b;
  Pose world_from_a, world_from_b;

  bool within(double clearance) const {
    return spherule::within(a, world_from_a, b, world_from_b, clearance);
  }
  double slack(double clearance) const {
    return within_slack(a, world_from_a, b, world_from_b, clearance);
  }
  PlacedSphereSets spheres(std::size_t i, std::size_t j) const {
    return {a.spheres()[i], b.spheres()[j], world_from_a, world_from_b};
  }
};

Scene random_scene(SceneRandom& random, int largest_count) {
  const double size = std::ldexp(1.0, random.whole(-20, 20));
  const auto tree = [&] {
    return build_tree(random_spheres(random, random.whole(1, largest_count), size, 0.1 * size),
                      {.branching = random.whole(2, SphereTree::kMaxBranching)});
  };
  SphereTree a = tree();
  SphereTree b = tree();
  return {std::move(a), std::move(b), random.pose(size), random.pose(3.0 * size)};
}

// D <= ra + rb + c for the exact gap, in rational numbers.
bool exactly_within(const PlacedSphereSets& spheres, const Rational& clearance) {
  const Rational sum = Rational(spheres.a.radius) + Rational(spheres.b.radius) + clearance;
  return spheres.squared_center_distance<Rational>() <= sum * sum;
}

TEST(Within, IsExactToTheSlackOnPairsOfSpheres) {
  SceneRandom random(1);
  int needed = 0;
  for (int i = 0; i < effort(800, 60); ++i) {
    const double size = std::ldexp(1.0, random.whole(-20, 20));
    const std::vector<Sphere> one = random_spheres(random, 1, size, 0.5 * size);
    const std::vector<Sphere> other = random_spheres(random, 1, size, 0.5 * size);
    const Scene scene = {build_tree(one), build_tree(other), random.pose(size),
                         random.pose(size * std::ldexp(1.0, random.whole(0, 12)))};
    const Real gap = scene.spheres(0, 0).gap();
    if (gap <= 0) continue;
    // Clearances next to the gap: a few units in the last place, and a few slacks, to both sides.
    const auto near = static_cast<double>(gap);
    for (int k = -4; k <= 4; ++k) {
      for (const double unit : {std::abs(std::nextafter(near, 0.0) - near), scene.slack(near)}) {
        const double clearance = near + k * unit;
        if (clearance < 0.0) continue;
        const bool answer = scene.within(clearance);
        const bool truth = exactly_within(scene.spheres(0, 0), Rational(clearance));
        ASSERT_TRUE(answer || !truth) << "missed";
        if (answer) {
          ASSERT_TRUE(exactly_within(scene.spheres(0, 0),
                                     Rational(clearance) + Rational(scene.slack(clearance))));
        }
        needed += answer && !truth;
        ASSERT_EQ(answer,
                  within(scene.b, scene.world_from_b, scene.a, scene.world_from_a, clearance));
        ASSERT_EQ(answer, spheres_within(scene.a, 0, scene.world_from_a, scene.b, 0,
                                         scene.world_from_b, clearance));
      }
    }
  }
  EXPECT_GT(needed, effort(100, 7));
}

TEST(Within, IsWhatTheTestOfSomePairSays) {
  SceneRandom random(2);
  int counts[2] = {};
  for (int i = 0; i < 300; ++i) {
    const Scene scene = random_scene(random, 120);
    const DistanceResult bounds =
        distance(scene.a, scene.world_from_a, scene.b, scene.world_from_b);
    for (const double factor : {0.0, 0.5, 1.0 - 1e-15, 1.0, 1.0 + 1e-15, 1.5}) {
      const double clearance = bounds.upper * factor;
      const bool answer = scene.within(clearance);
      bool any = false;
      for (std::size_t j = 0; j < scene.a.spheres().size(); ++j) {
        for (std::size_t k = 0; k < scene.b.spheres().size(); ++k) {
          any = any ||
                spheres_within(scene.a, static_cast<std::int32_t>(j), scene.world_from_a, scene.b,
                               static_cast<std::int32_t>(k), scene.world_from_b, clearance);
        }
      }
      ASSERT_EQ(answer, any);
      ASSERT_TRUE(answer || bounds.upper > clearance);
      ASSERT_TRUE(!answer || bounds.lower <= clearance + scene.slack(clearance));
      ++counts[answer ? 1 : 0];
    }
    ASSERT_EQ(scene.within(0.0),
              collides(scene.a, scene.world_from_a, scene.b, scene.world_from_b));
  }
  EXPECT_GT(counts[0], 200);
  EXPECT_GT(counts[1], 200);
}

TEST(Within, RefusesWhatCannotBeUsed) {
  const SphereTree sphere = build_tree(std::vector<Sphere>{{{0.0, 0.0, 0.0}, 1.0}});
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), -1e-300, 2e15}) {
    EXPECT_THROW(within(sphere, Pose(), sphere, Pose(), bad), Error);
    EXPECT_THROW(within_slack(sphere, Pose(), sphere, Pose(), bad), Error);
    EXPECT_THROW(spheres_within(sphere, 0, Pose(), sphere, 0, Pose(), bad), Error);
  }
  EXPECT_TRUE(within(sphere, Pose(), sphere, Pose::from_translation({1e14, 0.0, 0.0}), 1e15));
}

}  // namespace
}  // namespace spherule::test::within_test
