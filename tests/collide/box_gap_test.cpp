// SPDX-License-Identifier: BSD-3-Clause
// The tests of two trees before a search, where sphere and box or two boxes meet or nearly so:
// against exact gaps, and verdicts against the canonical test of all pairs.

#include "collide/search/box_gap.h"

#include "collide/collide.h"
#include "spheretree/build.h"
#include "tests/collide/exact_scene.h"
#include "tests/collide/trees.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace spherule::test::box_gap_test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

struct Scene {
  SphereTree a, b;
  Pose world_from_a, world_from_b;

  internal::RelativePose pose() const {
    return internal::RelativePose(a, world_from_a, b, world_from_b);
  }

  Real exact_gap() const {
    Real least = std::numeric_limits<double>::infinity();
    for (const Sphere& of_a : a.spheres()) {
      for (const Sphere& of_b : b.spheres()) {
        least = std::min(least, PlacedSphereSets{of_a, of_b, world_from_a, world_from_b}.gap());
      }
    }
    return least;
  }

  // By the canonical test of all pairs.
  bool some_pair_within(double clearance) const {
    const internal::RelativePose relative = pose();
    for (const Sphere& of_a : a.spheres()) {
      for (const Sphere& of_b : b.spheres()) {
        if (relative.touches(of_a, of_b, clearance)) return true;
      }
    }
    return false;
  }
};

// The eight corners of a box, as spheres.
std::vector<Sphere> corners(const Vector3d& center, const Vector3d& half_size, double radius) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < 8; ++i) {
    const Vector3d signs(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
    spheres.push_back({center + half_size.cwiseProduct(signs), radius});
  }
  return spheres;
}

// A sphere that touches all faces of the box around it and `count` smaller ones in it.
std::vector<Sphere> sphere_with_others(SceneRandom& random, const Vector3d& center, double radius,
                                       int count) {
  std::vector<Sphere> spheres = {{center, radius}};
  for (int i = 0; i < count; ++i) {
    spheres.push_back({center + random.point(0.5 * radius), radius * random.uniform(0.0, 0.4)});
  }
  return spheres;
}

// A box is brought with a corner to the middle of a face of the other set's box, so that the gap
// along the face's normal is that of two spheres: `gap` units of 2^-53 of the scene, up to what the
// rounding of the poses adds. Corners are points, or spheres where the boxes are parallel. Either
// set comes first.
Scene facing(SceneRandom& random, double gap) {
  const double size = std::ldexp(1.0, random.whole(-40, 36));
  const bool parallel = random.whole(0, 2) == 0;
  const Vector3d flatness(random.uniform(0.0, 1.0), random.whole(0, 3) == 0 ? 0.0 : 1.0,
                          random.uniform(0.1, 1.0));
  const std::vector<Sphere> box = corners(random.point(size * random.whole(0, 4)), size * flatness,
                                          parallel ? size * random.uniform(0.0, 0.5) : 0.0);
  const double radius = random.whole(0, 4) == 0 ? 0.0 : size * random.uniform(0.01, 2.0);
  const Vector3d center = random.point(size * random.whole(0, 4));
  const std::vector<Sphere> round = sphere_with_others(random, center, radius, random.whole(0, 4));

  const Quaterniond turn =
      parallel ? Quaterniond(1.0, random.whole(0, 1), 0.0, 0.0) : random.quaternion();
  Vector3d normal = Vector3d::Zero();
  normal[random.whole(0, 2)] = random.whole(0, 1) == 0 ? 1.0 : -1.0;
  const Pose turned(turn, Vector3d::Zero());
  const auto along = [&](const Sphere& sphere) { return normal.dot(turned * sphere.center); };
  const Sphere nearest = *std::min_element(
      box.begin(), box.end(), [&](const auto& p, const auto& q) { return along(p) < along(q); });
  const Vector3d goal =
      center + (radius + nearest.radius + 16.0 * size * gap * kUnitRoundoff) * normal;
  const Pose round_from_box(turn, goal - turned * nearest.center);

  const double far = size * std::ldexp(1.0, random.whole(0, 6));
  const Pose world_from_round = random.pose(far);
  const Pose world_from_box = world_from_round * round_from_box;
  SphereTree box_tree = build_tree(box);
  SphereTree round_tree = build_tree(round);
  if (random.whole(0, 1) == 0) {
    return {std::move(box_tree), std::move(round_tree), world_from_box, world_from_round};
  }
  return {std::move(round_tree), std::move(box_tree), world_from_round, world_from_box};
}

TEST(BoxGap, IsNeverAboveTheExactGap) {
  SceneRandom random(1);
  int needed = 0;
  int near = 0;
  for (int i = 0; i < effort(1500, 200); ++i) {
    const Scene scene = facing(random, random.uniform(0.0, 2000.0));
    const Real exact = scene.exact_gap();
    const internal::RelativePose pose = scene.pose();
    const double lowered = internal::box_gap(scene.a, scene.b, pose);
    const double given_away = internal::kBoxError * pose.scene_size();
    ASSERT_LE(lowered, exact) << i;
    // Without the lowering this would have failed.
    needed += lowered + given_away > exact;
    // The scene is one where the boxes' gap is that of spheres.
    near += lowered + 2.0 * given_away > exact;
  }
  EXPECT_GT(needed, effort(60, 5));
  EXPECT_GT(near, effort(1400, 180));
}

TEST(BoxGap, ChangesNoVerdict) {
  SceneRandom random(2);
  int touching = 0;
  int far_apart = 0;
  int apart_by_boxes = 0;
  for (int i = 0; i < effort(20000, 2000); ++i) {
    const bool close = random.whole(0, 1) == 0;
    const Scene scene =
        facing(random, close ? random.uniform(-200.0, 400.0) : random.uniform(400.0, 4000.0));
    const internal::RelativePose pose = scene.pose();
    const bool truth = scene.some_pair_within(0.0);
    ASSERT_EQ(collides(scene.a, scene.world_from_a, scene.b, scene.world_from_b), truth) << i;
    const CollisionResult found = collide(scene.a, scene.world_from_a, scene.b, scene.world_from_b);
    ASSERT_EQ(found.verdict, truth ? Verdict::kCollision : Verdict::kFree) << i;
    touching += truth;
    far_apart += internal::far_apart(scene.a, scene.world_from_a, scene.b, scene.world_from_b);
    apart_by_boxes += internal::boxes_apart(scene.a, scene.b, pose);
  }
  EXPECT_GT(touching, effort(3000, 300));
  EXPECT_GT(far_apart, effort(300, 30));
  EXPECT_GT(apart_by_boxes, effort(2000, 200));
}

TEST(BoxGap, ChangesNoVerdictWithAClearance) {
  SceneRandom random(3);
  int counts[2] = {};
  int far_apart = 0;
  int apart_by_boxes = 0;
  for (int i = 0; i < effort(4000, 400); ++i) {
    const Scene scene = facing(random, std::ldexp(1.0, random.whole(0, 52)));
    const internal::RelativePose pose = scene.pose();
    const double gap = std::max(
        0.0, internal::box_gap(scene.a, scene.b, pose) + internal::kBoxError * pose.scene_size());
    for (const double step : {-1000.0, -100.0, -10.0, -1.0, 0.0, 1.0, 10.0, 100.0}) {
      const double clearance = std::max(0.0, gap + step * kUnitRoundoff * pose.scene_size());
      const bool truth = scene.some_pair_within(clearance);
      ASSERT_EQ(within(scene.a, scene.world_from_a, scene.b, scene.world_from_b, clearance), truth)
          << i << ' ' << step;
      ++counts[truth];
      far_apart +=
          internal::far_apart(scene.a, scene.world_from_a, scene.b, scene.world_from_b, clearance);
      apart_by_boxes += internal::boxes_apart(scene.a, scene.b, pose, clearance);
    }
  }
  EXPECT_GT(counts[0], effort(4000, 400));
  EXPECT_GT(counts[1], effort(4000, 400));
  EXPECT_GT(far_apart, effort(300, 30));
  EXPECT_GT(apart_by_boxes, effort(1000, 100));
}

// Numbers at the ends of what is allowed: nothing overflows, and what underflows is in the pads.
TEST(BoxGap, HoldsForTheSmallestAndTheLargest) {
  for (const double size : {0.0, 0x1p-1074, 0x1p-1000, 0x1p-540, 0x1p-500, 1e-30, 1e14}) {
    const std::vector<Sphere> spheres = {{{size, -size, size}, 0.0}, {{-size, size, 0.0}, size}};
    const SphereTree pair = build_tree(spheres);
    const SphereTree single = build_tree(std::vector<Sphere>{{{-size, size, size}, 0.0}});
    for (const Quaterniond& turn : {Quaterniond::Identity(), Quaterniond(1.0, 2.0, -3.0, 4.0)}) {
      for (const double way : {0.0, 0.5, 3.0, 1e3}) {
        const Pose pose(turn, Vector3d(way, -0.1 * way, 0.2 * way) * std::min(size, 1e11));
        for (const auto& [a, b] : {std::pair(&pair, &single), std::pair(&pair, &pair),
                                   std::pair(&single, &pair), std::pair(&single, &single)}) {
          const Scene scene = {*a, *b, pose, Pose()};
          ASSERT_LE(internal::box_gap(*a, *b, scene.pose()), scene.exact_gap());
          ASSERT_EQ(collides(*a, pose, *b, Pose()), scene.some_pair_within(0.0));
        }
      }
    }
  }
}

}  // namespace
}  // namespace spherule::test::box_gap_test
