// SPDX-License-Identifier: BSD-3-Clause
// Distance bounds against 100 digits over all pairs.

#include "collide/collide.h"
#include "collide/search/relative_pose.h"
#include "spheretree/build.h"
#include "tests/collide/exact_scene.h"
#include "tests/collide/trees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace spherule::test::distance_test {
namespace {

struct Scene {
  SphereTree a, b;
  Pose world_from_a, world_from_b;

  DistanceResult distance(const DistanceRequest& request = {}) const {
    return spherule::distance(a, world_from_a, b, world_from_b, request);
  }
  Real gap(std::size_t i, std::size_t j) const {
    return PlacedSphereSets{a.spheres()[i], b.spheres()[j], world_from_a, world_from_b}.gap();
  }
  Real exact_distance() const {
    Real least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < a.spheres().size(); ++i) {
      for (std::size_t j = 0; j < b.spheres().size(); ++j) {
        const Real one = gap(i, j);
        if (one < least) least = one;
      }
    }
    return least < 0 ? Real(0) : least;
  }
  double error() const {
    return internal::RelativePose(a, world_from_a, b, world_from_b).gap_error();
  }
};

Scene random_scene(SceneRandom& random) {
  const double size = std::ldexp(1.0, random.whole(-30, 30));
  const auto tree = [&] {
    return build_tree(random_spheres(random, random.whole(1, 25), size, 0.2 * size),
                      {.branching = random.whole(2, SphereTree::kMaxBranching)});
  };
  SphereTree a = tree();
  SphereTree b = tree();
  return {std::move(a), std::move(b), random.pose(size), random.pose(2.0 * size)};
}

TEST(Distance, BoundsEncloseTheExactDistanceTightly) {
  SceneRandom random(1);
  int apart = 0;
  int overlapping = 0;
  for (int i = 0; i < 120; ++i) {
    const Scene scene = random_scene(random);
    const DistanceResult result = scene.distance();
    const Real exact = scene.exact_distance();
    ASSERT_LE(result.lower, exact);
    ASSERT_GE(result.upper, exact);
    ASSERT_LE(result.upper - result.lower, 2.5 * scene.error());
    ASSERT_LE(scene.gap(static_cast<std::size_t>(result.nearest.a),
                        static_cast<std::size_t>(result.nearest.b)),
              result.upper);
    if (exact > 0) {
      ++apart;
    } else {
      ++overlapping;
      ASSERT_EQ(result.lower, 0.0);
    }
  }
  EXPECT_GT(apart, 30);
  EXPECT_GT(overlapping, 5);
}

TEST(Distance, StopsWhenItKnowsEnough) {
  SceneRandom random(2);
  int early = 0;
  for (int i = 0; i < 60; ++i) {
    const Scene scene = random_scene(random);
    const DistanceResult full = scene.distance();
    const Real exact = scene.exact_distance();
    const double tolerance = 0.3 * full.upper;
    const DistanceResult rough = scene.distance({.tolerance = tolerance});
    ASSERT_LE(rough.upper - rough.lower, std::max(tolerance, 2.5 * scene.error()));
    const DistanceResult far_enough = scene.distance({.enough = 0.25 * full.lower});
    ASSERT_TRUE(far_enough.lower > 0.25 * full.lower || full.lower == 0.0);
    for (const DistanceResult& result : {rough, far_enough}) {
      ASSERT_LE(result.lower, exact);
      ASSERT_GE(result.upper, exact);
      early += result.cost.node_tests < full.cost.node_tests;
    }
  }
  EXPECT_GT(early, 20);
}

TEST(Distance, IsStillBoundedWhenTheBudgetRunsOut) {
  SceneRandom random(3);
  int cut = 0;
  for (int i = 0; i < 40; ++i) {
    const Scene scene = random_scene(random);
    const Real exact = scene.exact_distance();
    const std::uint64_t full = scene.distance().cost.node_tests;
    for (std::uint64_t budget = 0; budget < 300; budget = budget * 2 + 1) {
      const DistanceResult result = scene.distance({.max_node_tests = budget});
      ASSERT_LE(result.cost.node_tests, budget);
      ASSERT_LE(result.lower, exact);
      ASSERT_GE(result.upper, exact);
      cut += budget < full;
    }
  }
  EXPECT_GT(cut, 50);
}

TEST(Distance, IsStillBoundedWhenThereIsNoTime) {
  SceneRandom random(5);
  for (int i = 0; i < 20; ++i) {
    const Scene scene = random_scene(random);
    const Real exact = scene.exact_distance();
    for (const int nanoseconds : {0, 300, 3000}) {
      const DistanceResult result =
          scene.distance({.max_time = std::chrono::nanoseconds(nanoseconds)});
      ASSERT_LE(result.lower, exact);
      ASSERT_GE(result.upper, exact);
      ASSERT_TRUE(nanoseconds > 0 || result.cost.node_tests == 0);
    }
  }
}

TEST(Distance, AgreesWithCollides) {
  SceneRandom random(4);
  for (int i = 0; i < 300; ++i) {
    const Scene scene = random_scene(random);
    const DistanceResult result = scene.distance();
    const bool hit = collides(scene.a, scene.world_from_a, scene.b, scene.world_from_b);
    ASSERT_TRUE(hit || result.upper > 0.0);
    ASSERT_TRUE(!hit || result.lower == 0.0);
  }
}

TEST(Distance, OfTwoSpheres) {
  const SphereTree sphere = build_tree(std::vector<Sphere>{{{0.0, 0.0, 0.0}, 1.0}});
  const DistanceResult result =
      distance(sphere, Pose(), sphere, Pose::from_translation({3.0, 4.0, 0.0}));
  EXPECT_NEAR(result.lower, 3.0, 1e-12);
  EXPECT_NEAR(result.upper, 3.0, 1e-12);
  EXPECT_LE(result.lower, 3.0);
  EXPECT_GE(result.upper, 3.0);
  EXPECT_EQ(result.nearest, (SpherePair{0, 0}));
  EXPECT_EQ(result.cost.leaf_tests, 1u);
  EXPECT_EQ(distance(sphere, Pose(), sphere, Pose()).upper, 0.0);
}

}  // namespace
}  // namespace spherule::test::distance_test
