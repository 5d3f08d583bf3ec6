// SPDX-License-Identifier: BSD-3-Clause
// G4 and G5 on single pairs of spheres, against exact arithmetic.

#include "collide/collide.h"
#include "collide/search/relative_pose.h"
#include "spheretree/build.h"
#include "tests/collide/exact_scene.h"
#include "tests/collide/scene_random.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace spherule::test::pair_test {
namespace {

SphereTree tree_of(const Sphere& sphere) {
  return build_tree(std::span(&sphere, 1));
}

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
  SceneRandom random(7);
  Tally tally;
  for (int i = 0; i < effort(4000, 1000); ++i) {
    PlacedSphereSets spheres;
    const Eigen::Vector3d center = random.point(scene.away);
    spheres.a.center = random.point(scene.size);
    spheres.b = {random.point(scene.size), random.uniform(0.0, scene.radius_b)};
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
  SceneRandom random(11);
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

}  // namespace
}  // namespace spherule::test::pair_test
