// SPDX-License-Identifier: BSD-3-Clause
// Whole trees: pairs, limits, verdicts and bounds against all pairs of spheres.

#include "collide/collide.h"

#include "collide/search/relative_pose.h"
#include "spheretree/build.h"
#include "tests/collide/exact_scene.h"
#include "tests/collide/trees.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace spherule::test {
namespace {

struct Scene {
  SphereTree a, b;
  Pose world_from_a, world_from_b;

  CollisionResult collide(const CollisionRequest& request = {}) const {
    return spherule::collide(a, world_from_a, b, world_from_b, request);
  }
  bool collides() const { return spherule::collides(a, world_from_a, b, world_from_b); }

  PlacedSphereSets spheres(int i, int j) const {
    return {a.spheres()[static_cast<std::size_t>(i)], b.spheres()[static_cast<std::size_t>(j)],
            world_from_a, world_from_b};
  }
  int count_a() const { return static_cast<int>(a.spheres().size()); }
  int count_b() const { return static_cast<int>(b.spheres().size()); }

  // All pairs that the canonical test accepts, in order.
  std::vector<SpherePair> all_pairs() const {
    const internal::RelativePose pose(a, world_from_a, b, world_from_b);
    std::vector<SpherePair> pairs;
    for (int i = 0; i < count_a(); ++i) {
      for (int j = 0; j < count_b(); ++j) {
        if (pose.touches(spheres(i, j).a, spheres(i, j).b)) pairs.push_back({i, j});
      }
    }
    return pairs;
  }
};

Scene random_scene(SceneRandom& random, int largest_count) {
  const double size = std::ldexp(1.0, random.whole(-20, 20));
  const auto tree = [&] {
    const int count = random.whole(1, largest_count);
    const double largest_radius = size * random.uniform(0.0, 4.0) / std::sqrt(count);
    return build_tree(random_spheres(random, count, size, largest_radius),
                      {.branching = random.whole(2, SphereTree::kMaxBranching)});
  };
  SphereTree a = tree();
  SphereTree b = tree();
  return {std::move(a), std::move(b), random.pose(size), random.pose(1.5 * size)};
}

TEST(Collide, FindsExactlyTheTouchingPairsOfAllPairs) {
  SceneRandom random(1);
  int free = 0;
  int colliding = 0;
  std::size_t pairs = 0;
  for (int i = 0; i < 400; ++i) {
    const Scene scene = random_scene(random, 150);
    const CollisionResult result = scene.collide();
    const std::vector<SpherePair> expected = scene.all_pairs();
    ASSERT_EQ(result.pairs, expected);
    ASSERT_TRUE(result.complete);
    ASSERT_EQ(result.verdict, expected.empty() ? Verdict::kFree : Verdict::kCollision);
    ASSERT_EQ(scene.collides(), !expected.empty());
    ASSERT_EQ(spherule::collides(scene.b, scene.world_from_b, scene.a, scene.world_from_a),
              !expected.empty());
    expected.empty() ? ++free : ++colliding;
    pairs += expected.size();
  }
  EXPECT_GT(free, 50);
  EXPECT_GT(colliding, 50);
  EXPECT_GT(pairs, 1000u);
}

TEST(Collide, AgreesWithExactArithmeticOnEveryPair) {
  SceneRandom random(2);
  int touching = 0;
  for (int i = 0; i < 40; ++i) {
    const Scene scene = random_scene(random, 30);
    const CollisionResult result = scene.collide();
    const double slack = collision_slack(scene.a, scene.world_from_a, scene.b, scene.world_from_b);
    for (int j = 0; j < scene.count_a(); ++j) {
      for (int k = 0; k < scene.count_b(); ++k) {
        const bool found =
            std::binary_search(result.pairs.begin(), result.pairs.end(), SpherePair{j, k});
        const Real gap = scene.spheres(j, k).gap();
        ASSERT_TRUE(found || gap > 0) << gap;
        ASSERT_TRUE(!found || gap <= slack) << gap;
        touching += found;
      }
    }
  }
  EXPECT_GT(touching, 50);
}

TEST(Collide, DoesNotDependOnTheShapeOfTheTree) {
  SceneRandom random(3);
  for (int i = 0; i < 50; ++i) {
    const std::vector<Sphere> spheres_a = random_spheres(random, 200, 1.0, 0.1);
    const std::vector<Sphere> spheres_b = random_spheres(random, 200, 1.0, 0.1);
    const Pose pose_a = random.pose(1.0);
    const Pose pose_b = random.pose(1.0);
    const auto pairs = [&](int branching) {
      return collide(build_tree(spheres_a, {.branching = branching}), pose_a,
                     build_tree(spheres_b, {.branching = branching}), pose_b)
          .pairs;
    };
    const std::vector<SpherePair> binary = pairs(2);
    ASSERT_EQ(pairs(8), binary);
    ASSERT_EQ(pairs(16), binary);
  }
}

TEST(Collide, SwappedArgumentsSwapThePairs) {
  SceneRandom random(4);
  for (int i = 0; i < 50; ++i) {
    const Scene scene = random_scene(random, 60);
    std::vector<SpherePair> swapped =
        collide(scene.b, scene.world_from_b, scene.a, scene.world_from_a).pairs;
    for (SpherePair& pair : swapped) std::swap(pair.a, pair.b);
    std::sort(swapped.begin(), swapped.end());
    ASSERT_EQ(swapped, scene.collide().pairs);
  }
}

TEST(Collide, GivesTheSameAnswerAndCostTwice) {
  SceneRandom random(5);
  const Scene scene = random_scene(random, 150);
  const CollisionResult first = scene.collide({.max_pairs = 7});
  const CollisionResult second = scene.collide({.max_pairs = 7});
  EXPECT_EQ(first.pairs, second.pairs);
  EXPECT_EQ(first.cost.node_tests, second.cost.node_tests);
  EXPECT_EQ(first.cost.leaf_tests, second.cost.leaf_tests);
}

TEST(Collide, StopsAtTheLimitOfPairs) {
  SceneRandom random(6);
  int limited = 0;
  for (int i = 0; i < 100; ++i) {
    const Scene scene = random_scene(random, 100);
    const std::vector<SpherePair> all = scene.collide().pairs;
    for (const std::size_t limit : {std::size_t{1}, std::size_t{3}, all.size()}) {
      const CollisionResult result = scene.collide({.max_pairs = limit});
      ASSERT_TRUE(std::includes(all.begin(), all.end(), result.pairs.begin(), result.pairs.end()));
      ASSERT_EQ(result.pairs.size(), std::min(limit, all.size()));
      ASSERT_EQ(result.verdict, all.empty() ? Verdict::kFree : Verdict::kCollision);
      ASSERT_TRUE(!result.complete || result.pairs == all);
      limited += result.pairs.size() < all.size();
    }
  }
  EXPECT_GT(limited, 10);
}

TEST(Collide, SaysUnknownWhenTheBudgetRunsOut) {
  SceneRandom random(7);
  int unknown = 0;
  for (int i = 0; i < 100; ++i) {
    const Scene scene = random_scene(random, 100);
    const CollisionResult full = scene.collide();
    for (std::uint64_t budget = 0; budget < 400; budget = budget * 2 + 1) {
      const CollisionResult result = scene.collide({.max_node_tests = budget});
      ASSERT_LE(result.cost.node_tests, budget);
      ASSERT_TRUE(std::includes(full.pairs.begin(), full.pairs.end(), result.pairs.begin(),
                                result.pairs.end()));
      if (result.verdict == Verdict::kUnknown) {
        ++unknown;
        ASSERT_TRUE(result.pairs.empty());
        ASSERT_FALSE(result.complete);
        ASSERT_EQ(result.distance_lower_bound, 0.0);
      } else {
        ASSERT_EQ(result.verdict, full.verdict);
      }
      if (result.complete) {
        ASSERT_EQ(result.pairs, full.pairs);
      }
    }
  }
  EXPECT_GT(unknown, 100);
}

TEST(Collide, SaysUnknownWhenThereIsNoTime) {
  SceneRandom random(9);
  for (int i = 0; i < 20; ++i) {
    const Scene scene = random_scene(random, 100);
    const CollisionResult none = scene.collide({.max_time = std::chrono::nanoseconds(0)});
    ASSERT_EQ(none.verdict, Verdict::kUnknown);
    ASSERT_FALSE(none.complete);
    ASSERT_EQ(none.cost.node_tests, 0u);
    // The shortest time is over at some reading of the clock, and what was found until then is
    // true.
    const CollisionResult full = scene.collide();
    const CollisionResult little = scene.collide({.max_time = std::chrono::nanoseconds(500)});
    ASSERT_TRUE(std::includes(full.pairs.begin(), full.pairs.end(), little.pairs.begin(),
                              little.pairs.end()));
    ASSERT_TRUE(little.verdict == Verdict::kUnknown || little.verdict == full.verdict);
    ASSERT_TRUE(!little.complete || little.pairs == full.pairs);
    ASSERT_EQ(scene.collide({.max_time = std::chrono::hours(1)}).pairs, full.pairs);
  }
}

TEST(Collide, WithoutRoomForAPairSaysOnlyWhether) {
  const SphereTree sphere = build_tree(std::vector<Sphere>{{{0.0, 0.0, 0.0}, 1.0}});
  const CollisionResult hit = collide(sphere, Pose(), sphere, Pose(), {.max_pairs = 0});
  EXPECT_EQ(hit.verdict, Verdict::kCollision);
  EXPECT_TRUE(hit.pairs.empty());
  EXPECT_FALSE(hit.complete);
}

TEST(Collide, BoundsTheDistanceFromBelow) {
  SceneRandom random(8);
  int positive = 0;
  for (int i = 0; i < 60; ++i) {
    const Scene scene = random_scene(random, 20);
    const CollisionResult result = scene.collide();
    if (result.verdict != Verdict::kFree) {
      ASSERT_EQ(result.distance_lower_bound, 0.0);
      continue;
    }
    for (int j = 0; j < scene.count_a(); ++j) {
      for (int k = 0; k < scene.count_b(); ++k) {
        ASSERT_LE(result.distance_lower_bound, scene.spheres(j, k).gap());
      }
    }
    positive += result.distance_lower_bound > 0.0;
  }
  EXPECT_GT(positive, 10);
}

TEST(Collide, CountsTheTestOfTheRootsAlone) {
  const SphereTree sphere = build_tree(std::vector<Sphere>{{{0.0, 0.0, 0.0}, 1.0}});
  const CollisionResult far =
      collide(sphere, Pose(), sphere, Pose::from_translation({5.0, 0.0, 0.0}));
  EXPECT_EQ(far.verdict, Verdict::kFree);
  EXPECT_EQ(far.cost.node_tests, 1u);
  EXPECT_EQ(far.cost.leaf_tests, 1u);
  EXPECT_NEAR(far.distance_lower_bound, 3.0, 1e-12);
}

}  // namespace
}  // namespace spherule::test
