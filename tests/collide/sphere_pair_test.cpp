// SPDX-License-Identifier: BSD-3-Clause
#include "collide/collide.h"
#include "collide/search/box_gap.h"
#include "collide/search/nearest_first.h"
#include "collide/search/relative_pose.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/effort.h"
#include "tests/support/exact/spheres.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

// G4 and G5 on single pairs of spheres, against exact arithmetic.

// What a test without a pad would say.
bool plain_test(const PlacedSphereSets& spheres) {
  const Eigen::Vector3d offset =
      (spheres.world_from_a.matrix() * spheres.a.center -
       spheres.world_from_b.matrix() * spheres.b.center) +
      (spheres.world_from_a.translation() - spheres.world_from_b.translation());
  const double limit = spheres.a.radius + spheres.b.radius;
  return offset.squaredNorm() <= limit * limit;
}

struct Tally {
  int pairs = 0;
  int overlapping = 0;
  int pad_needed = 0;  // overlapping, and missed without the pad
  int extra = 0;       // free, and called a collision
};

void judge(const PlacedSphereSets& spheres, Tally& tally) {
  const SphereTree a = tree_of(spheres.a);
  const SphereTree b = tree_of(spheres.b);
  const bool answer = collides(a, spheres.world_from_a, b, spheres.world_from_b);
  const bool overlap = spheres.overlap();
  ++tally.pairs;
  tally.overlapping += overlap;
  tally.pad_needed += overlap && !plain_test(spheres);
  tally.extra += answer && !overlap;
  ASSERT_TRUE(answer || !overlap) << "missed, gap " << spheres.gap();
  ASSERT_EQ(answer, collides(b, spheres.world_from_b, a, spheres.world_from_a)) << "not symmetric";
  const double slack = collision_slack(a, spheres.world_from_a, b, spheres.world_from_b);
  ASSERT_TRUE(!answer || spheres.gap() <= slack) << "gap " << spheres.gap() << ", slack " << slack;
}

// Sets the larger radius so that the spheres are within a few ulps of contact, on either side.
bool bring_to_contact(PlacedSphereSets& spheres, int ulps) {
  const Real rest = spheres.center_distance() - spheres.b.radius;
  if (rest <= 0) return false;
  spheres.a.radius = rest.convert_to<double>();
  for (int i = 0; i < std::abs(ulps); ++i) {
    spheres.a.radius = std::nextafter(spheres.a.radius, ulps > 0 ? 1e300 : 0.0);
  }
  return true;
}

struct Scene {
  const char* name;
  double size;      // of the coordinates in the frames of the bodies
  double away;      // distance of both bodies from the origin of the world
  double apart;     // distance of one body from the other
  double radius_b;  // largest radius of b
};

void PrintTo(const Scene& scene, std::ostream* out) {
  *out << scene.name;
}

class NearContact : public testing::TestWithParam<Scene> {};

TEST_P(NearContact, IsNeverMissedAndExtraOnlyWithinTheSlack) {
  const Scene& scene = GetParam();
  Random random(7);
  Tally tally;
  for (int i = 0; i < effort(4000, 1000); ++i) {
    PlacedSphereSets spheres;
    const Eigen::Vector3d center = random.point(scene.away);
    spheres.a.center = random.point(scene.size);
    spheres.b = {random.point(scene.size), random.between(0.0, scene.radius_b)};
    spheres.world_from_a = Pose(random.quaternion(), center + random.point(scene.apart));
    spheres.world_from_b = Pose(random.quaternion(), center + random.point(scene.apart));
    if (!bring_to_contact(spheres, random.whole(-2, 2))) continue;
    judge(spheres, tally);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(tally.pairs, effort(3000, 750));
  EXPECT_GT(tally.overlapping, tally.pairs / 3);
  EXPECT_GT(tally.pad_needed, effort(50, 12));
  EXPECT_GT(tally.extra, effort(100, 25));
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, NearContact,
    testing::Values(Scene{"metres", 1.0, 1.0, 1.0, 0.5}, Scene{"points", 1.0, 1.0, 1.0, 0.0},
                    Scene{"far_from_the_origin", 1.0, 1e6, 1.0, 0.5},
                    Scene{"far_frames", 1e6, 1.0, 1.0, 0.5}, Scene{"tiny", 1e-9, 1e-9, 1e-9, 1e-9},
                    Scene{"huge", 1e9, 1e9, 1e9, 1e9}, Scene{"no_translation", 1.0, 0.0, 0.0, 0.5},
                    Scene{"mixed", 1e-3, 10.0, 1e3, 100.0}),
    [](const auto& scene) { return std::string(scene.param.name); });

// Contact that doubles represent exactly: rational rotations and whole numbers.
TEST(Touching, IsACollision) {
  const std::vector<Eigen::Quaterniond> rotations = {{1, 0, 0, 0}, {1, 1, 0, 0},  {0, 0, 3, 0},
                                                     {1, 1, 1, 1}, {1, -1, 0, 0}, {2, 2, 2, -2}};
  const std::vector<Eigen::Vector3d> steps = {
      {3, 4, 0}, {1, 2, 2}, {2, 3, 6}, {0, 0, 5}, {-4, 4, 7}};
  int touching = 0;
  for (const auto& qa : rotations) {
    for (const auto& qb : rotations) {
      for (const auto& step : steps) {
        for (const double scale : {1.0, 0x1p-30, 0x1p30}) {
          PlacedSphereSets spheres;
          spheres.a = {{scale, 2.0 * scale, 3.0 * scale}, 0.25 * scale * step.norm()};
          spheres.b = {{-scale, 0.0, scale}, 0.75 * scale * step.norm()};
          // Right-angled rotations: rounding the image to whole multiples of the scale is exact.
          const auto image = [&](const Eigen::Quaterniond& q, const Eigen::Vector3d& p) {
            return Eigen::Vector3d((q.normalized() * (p / scale)).array().round() * scale);
          };
          spheres.world_from_a = Pose(qa, Eigen::Vector3d(1.0, 2.0, 3.0) * scale);
          spheres.world_from_b =
              Pose(qb, spheres.world_from_a.translation() + image(qa, spheres.a.center) -
                           image(qb, spheres.b.center) + scale * step);
          const Rational sum = Rational(spheres.a.radius) + Rational(spheres.b.radius);
          ASSERT_EQ(spheres.squared_center_distance<Rational>(), Rational(sum * sum));
          ASSERT_TRUE(collides(tree_of(spheres.a), spheres.world_from_a, tree_of(spheres.b),
                               spheres.world_from_b));
          ++touching;
        }
      }
    }
  }
  EXPECT_EQ(touching, 6 * 6 * 5 * 3);
}

TEST(Touching, PointsOnOneSpotAreACollision) {
  const SphereTree point = tree_of({{0.0, 0.0, 0.0}, 0.0});
  EXPECT_TRUE(collides(point, Pose(), point, Pose()));
  const Pose far = Pose::from_translation({1e15, -1e15, 1e15});
  EXPECT_TRUE(collides(point, far, point, far));
  EXPECT_FALSE(collides(point, Pose(), point, Pose::from_translation({1e-100, 0.0, 0.0})));
}

TEST(Slack, IsAboutTheRoundingOfTheSceneAndNotOfTheWorld) {
  const SphereTree sphere = tree_of({{1.0, 0.0, 0.0}, 0.5});
  const Pose pose = Pose::from_translation({1.0, 0.0, 0.0});
  const Pose far = Pose::from_translation({1e9 + 1.0, 1e9, 0.0});
  const Pose far_origin = Pose::from_translation({1e9, 1e9, 0.0});
  const double near_slack = collision_slack(sphere, pose, sphere, Pose());
  EXPECT_LT(near_slack, 1e-13);
  EXPECT_GT(near_slack, 0.0);
  EXPECT_EQ(collision_slack(sphere, far, sphere, far_origin), near_slack);
}

// The constants of the budget against what rounding really does, so that a wrong proof shows.
TEST(ErrorBudget, CoversTheImagesOfBothFrames) {
  Random random(11);
  double worst = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const double size = std::ldexp(1.0, random.whole(-20, 20));
    PlacedSphereSets spheres{
        {random.point(size), 0.0}, {random.point(1.0), 0.0}, random.pose(1.0), random.pose(1.0)};
    const SphereTree a = tree_of(spheres.a);
    const SphereTree b = tree_of(spheres.b);
    const internal::RelativePose pose(a, spheres.world_from_a, b, spheres.world_from_b);
    const double exact = spheres.center_distance().convert_to<double>();
    const auto distance_by = [](const internal::FrameChange& change, const Eigen::Vector3d& x,
                                const Eigen::Vector3d& y) {
      const Eigen::Vector3d image(change.x(x[0], x[1], x[2]), change.y(x[0], x[1], x[2]),
                                  change.z(x[0], x[1], x[2]));
      return (image - y).norm();
    };
    for (const double computed : {distance_by(pose.b_from_a(), spheres.a.center, spheres.b.center),
                                  distance_by(pose.a_from_b(), spheres.b.center, spheres.a.center),
                                  pose.gap(spheres.a, spheres.b)}) {
      ASSERT_LE(std::abs(computed - exact), pose.gap_error());
      worst = std::max(worst, std::abs(computed - exact) / pose.gap_error());
    }
  }
  EXPECT_GT(worst, 1e-3);
}

// The kernels of the inner loop give the same bits as the portable code, lane by lane.

TEST(OverlapMask, IsThePortableOneForEveryCountNearTheLimit) {
  Random random(1);
  int overlapping = 0;
  int apart = 0;
  int equal = 0;
  for (int round = 0; round < 3000; ++round) {
    const double size = std::ldexp(1.0, random.whole(-30, 30));
    std::vector<double> x, y, z, radius;
    const internal::QuerySphere query{random.between(-size, size), random.between(-size, size),
                                      random.between(-size, size), random.between(0.0, 0.1 * size)};
    // Radii within two ulps of where the test turns. The last ones are never to be read as part of
    // a mask, and overlap, so that a lane too many shows.
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector3d p = random.point(size);
      const double dx = p.x() - query.x, dy = p.y() - query.y, dz = p.z() - query.z;
      double r = std::sqrt(dx * dx + dy * dy + dz * dz) - query.radius;
      const int ulps = random.whole(-2, 2);
      for (int step = 0; step < std::abs(ulps); ++step) {
        r = std::nextafter(r, ulps > 0 ? 1e300 : -1e300);
      }
      if (i >= 36) r = 10.0 * size;
      x.push_back(p.x());
      y.push_back(p.y());
      z.push_back(p.z());
      radius.push_back(std::max(0.0, r));
      const double limit = query.radius + radius.back();
      equal += dx * dx + dy * dy + dz * dz == limit * limit;
    }
    const internal::SphereArrays spheres{x.data(), y.data(), z.data(), radius.data()};
    for (std::int32_t count = 1; count <= 32; ++count) {
      for (const std::int32_t first : {0, 1, 36 - std::min(count, 36)}) {
        const std::uint32_t mask = internal::overlap_mask(spheres, first, count, query);
        ASSERT_EQ(mask, internal::portable_overlap_mask(spheres, first, count, query))
            << count << " spheres from " << first;
        for (std::int32_t i = 0; i < 32; ++i) {
          const bool bit = mask >> i & 1u;
          ASSERT_EQ(bit, i < count && internal::overlaps(spheres, first + i, query));
          if (i < count) bit ? ++overlapping : ++apart;
        }
      }
    }
  }
  EXPECT_GT(overlapping, 100000);
  EXPECT_GT(apart, 100000);
  EXPECT_GT(equal, 1000);
}

// The tests of two trees before a search, where sphere and box or two boxes meet or nearly so:
// against exact gaps, and verdicts against the canonical test of all pairs.

using Eigen::Quaterniond;
using Eigen::Vector3d;

struct BoxScene {
  SphereTree a, b;
  Pose world_from_a, world_from_b;

  internal::RelativePose pose() const {
    return internal::RelativePose(a, world_from_a, b, world_from_b);
  }

  Real exact_gap() const {
    return test::exact_gap({a.spheres(), world_from_a}, {b.spheres(), world_from_b});
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
std::vector<Sphere> sphere_with_others(Random& random, const Vector3d& center, double radius,
                                       int count) {
  std::vector<Sphere> spheres = {{center, radius}};
  for (int i = 0; i < count; ++i) {
    spheres.push_back({center + random.point(0.5 * radius), radius * random.between(0.0, 0.4)});
  }
  return spheres;
}

// A box is brought with a corner to the middle of a face of the other set's box, so that the gap
// along the face's normal is that of two spheres: `gap` units of 2^-53 of the scene, up to what the
// rounding of the poses adds. Corners are points, or spheres where the boxes are parallel. Either
// set comes first.
BoxScene facing(Random& random, double gap) {
  const double size = std::ldexp(1.0, random.whole(-40, 36));
  const bool parallel = random.whole(0, 2) == 0;
  const Vector3d flatness(random.between(0.0, 1.0), random.whole(0, 3) == 0 ? 0.0 : 1.0,
                          random.between(0.1, 1.0));
  const std::vector<Sphere> box = corners(random.point(size * random.whole(0, 4)), size * flatness,
                                          parallel ? size * random.between(0.0, 0.5) : 0.0);
  const double radius = random.whole(0, 4) == 0 ? 0.0 : size * random.between(0.01, 2.0);
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
  Random random(1);
  int needed = 0;
  int near = 0;
  for (int i = 0; i < effort(1500, 200); ++i) {
    const BoxScene scene = facing(random, random.between(0.0, 2000.0));
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

// With a clearance, too: zero, and next to the gap of the boxes.
TEST(BoxGap, ChangesNoVerdict) {
  Random random(2);
  int counts[2] = {}, far_apart = 0, apart_by_boxes = 0;
  for (int i = 0; i < effort(6000, 600); ++i) {
    const double size = std::ldexp(1.0, random.whole(0, 52));
    const BoxScene scene = facing(random, random.coin() ? random.between(-200.0, 400.0) : size);
    const auto& [a, b, world_from_a, world_from_b] = scene;
    const internal::RelativePose pose = scene.pose();
    const double gap =
        std::max(0.0, internal::box_gap(a, b, pose) + internal::kBoxError * pose.scene_size());
    std::vector<double> clearances = {0.0};
    for (const double step : {-1000.0, -100.0, -10.0, -1.0, 0.0, 1.0, 10.0, 100.0}) {
      clearances.push_back(std::max(0.0, gap + step * kUnitRoundoff * pose.scene_size()));
    }
    for (const double clearance : clearances) {
      const bool truth = scene.some_pair_within(clearance);
      ASSERT_EQ(within(a, world_from_a, b, world_from_b, clearance), truth) << i;
      if (clearance == 0.0) {
        ASSERT_EQ(collides(a, world_from_a, b, world_from_b), truth) << i;
        ASSERT_EQ(collide(a, world_from_a, b, world_from_b).verdict,
                  truth ? Verdict::kCollision : Verdict::kFree);
      }
      ++counts[truth];
      far_apart += internal::far_apart(a, world_from_a, b, world_from_b, clearance);
      apart_by_boxes += internal::boxes_apart(a, b, pose, clearance);
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
          const BoxScene scene = {*a, *b, pose, Pose()};
          ASSERT_LE(internal::box_gap(*a, *b, scene.pose()), scene.exact_gap());
          ASSERT_EQ(collides(*a, pose, *b, Pose()), scene.some_pair_within(0.0));
        }
      }
    }
  }
}

}  // namespace
}  // namespace spherule::test
