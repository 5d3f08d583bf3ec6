// SPDX-License-Identifier: BSD-3-Clause
// Motions made to deceive: thin walls, long rods, many turns, instants of contact.

#include "collide/sweep.h"
#include "tests/collide/swept_bodies.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

TEST(Sweep, NothingTunnelsThroughAThinWall) {
  std::vector<Sphere> wall;
  for (int y = -8; y <= 8; ++y) {
    for (int z = -8; z <= 8; ++z) wall.push_back({{0.0, 1e-3 * y, 1e-3 * z}, 7.2e-4});
  }
  SceneRandom random(3);
  for (int i = 0; i < 300; ++i) {
    // Through a point of the wall, very fast, at any time, turning or not.
    const Vector3d target(0.0, random.uniform(-7e-3, 7e-3), random.uniform(-7e-3, 7e-3));
    const double length = std::ldexp(1.0, random.whole(-3, 17));
    Vector3d way = random.point(1.0);
    way.x() += way.x() < 0.0 ? -0.5 : 0.5;
    way = way.normalized() * length;
    const double when = random.uniform(0.01, 0.99);
    const Body bullet =
        turning_body({{Vector3d::Zero(), 1e-5}}, Pose::from_translation(target - when * way),
                     random.point(1.0), random.uniform(-50.0, 50.0), way);
    const Body still = still_body(wall);
    const SweepResult result = run(bullet, still, {.resolution = 0x1p-30});
    ASSERT_EQ(result.verdict, Verdict::kCollision);
    ASSERT_LT(result.free_until, when);
    ASSERT_GT(result.free_until, when - 0.02 / length - 1e-8);
    ASSERT_GE(result.contact_at, result.free_until);
    ASSERT_LE(result.contact_at, when + 0.01 / length + 1e-8);
    // With a coarse resolution the answer may be unknown, but never free.
    ASSERT_NE(run(bullet, still, {.resolution = 0.1}).verdict, Verdict::kFree);
    ASSERT_NE(run(still, bullet).verdict, Verdict::kFree);
  }
}

std::vector<Sphere> rod() {
  std::vector<Sphere> spheres;
  for (int i = 0; i <= 40; ++i) spheres.push_back({{0.025 * i, 0.0, 0.0}, 0.02});
  return spheres;
}

TEST(Sweep, ARodThatTurnsManyTimes) {
  SceneRandom random(4);
  for (int i = 0; i < effort(100, 12); ++i) {
    const double rho = random.uniform(0.1, 1.0);
    const double at = random.uniform(0.3, 2.0 * kPi - 0.3);
    const int turns = random.whole(0, 6);
    // Beside a sphere, over it at a height that the rod just misses, or just does not.
    const double height = random.whole(0, 1) ? 0.031 : 0.0299;
    const Body obstacle = still_body({{{rho * std::cos(at), rho * std::sin(at), height}, 0.01}});
    const Vector3d axis(0.0, 0.0, random.whole(1, 3));
    const double before = at - 0.2 + 2.0 * kPi * turns;
    if (before <= 2.0 * kPi && turns == 0) {
      const Body short_of_it = turning_body(rod(), Pose(), axis, at - 0.35 / (rho + 0.5));
      const SweepResult result = run(short_of_it, obstacle, {.resolution = 1e-6});
      if (gap_at(short_of_it, obstacle, 1.0) > 1e-3) {
        ASSERT_EQ(result.verdict, Verdict::kFree);
      }
      expect_true(short_of_it, obstacle, result, 500);
    }
    const Body past_it = turning_body(rod(), Pose(), axis, at + 0.3 + 2.0 * kPi * turns);
    const SweepResult result = run(past_it, obstacle, {.resolution = 1e-6});
    if (height > 0.03) {
      ASSERT_EQ(result.verdict, Verdict::kFree);
    } else if (rho < 0.9) {
      // Between two spheres of the rod there is a dent, which the low sphere does not fit through
      // everywhere; where it does, brute force must agree.
      expect_true(past_it, obstacle, result, 3000);
    }
  }
}

TEST(Sweep, AFullTurnBackToTheStartIsNoRest) {
  const Body obstacle = still_body({{{0.0, 0.5, 0.0}, 0.05}});
  for (const double turns : {1.0, -1.0, 2.0, 5.0}) {
    const Body turning = turning_body(rod(), Pose(), {0.0, 0.0, 1.0}, 2.0 * kPi * turns);
    EXPECT_EQ(run(turning, obstacle).verdict, Verdict::kCollision);
    EXPECT_LT(gap_at(turning, obstacle, (turns > 0.0 ? 0.25 : 0.75) / std::abs(turns)), 0.0);
  }
  // A sphere about its own centre goes nowhere: one evaluation.
  const Body sphere = turning_body({{{1.0, 2.0, 3.0}, 1.0}}, Pose(), {1.0, 1.0, 0.0}, 1e4,
                                   Vector3d::Zero(), {1.0, 2.0, 3.0});
  const SweepResult result = run(sphere, still_body({{{3.0001, 2.0, 3.0}, 1.0}}));
  EXPECT_EQ(result.verdict, Verdict::kFree);
  EXPECT_EQ(result.evaluations, 1u);
}

TEST(Sweep, ABodyThatTurnsWithoutHaltNeedsNoManyLooksFarAway) {
  const Body turning = turning_body(rod(), Pose(), {0.0, 0.0, 1.0}, 1e6);
  const SweepResult result = run(turning, still_body({{{4.0, 0.0, 0.0}, 1.0}}));
  EXPECT_EQ(result.verdict, Verdict::kFree);
  EXPECT_EQ(result.evaluations, 1u);
}

TEST(Sweep, StartsOrEndsInContact) {
  const std::vector<Sphere> sphere = {{Vector3d::Zero(), 1.0}};
  for (const double overlap : {0.5, 1e-6, 0.0}) {
    const Vector3d at(2.0 - overlap, 0.0, 0.0);
    const Body away =
        turning_body(sphere, Pose::from_translation(at), {0.0, 0.0, 1.0}, 1.0, {3.0, 0.0, 0.0});
    const SweepResult first = run(away, still_body(sphere));
    EXPECT_EQ(first.verdict, Verdict::kCollision);
    EXPECT_EQ(first.free_until, 0.0);
    EXPECT_EQ(first.contact_at, 0.0);
    const Body towards = body_between(sphere, Pose::from_translation(at + Vector3d(3.0, 0.0, 0.0)),
                                      Pose::from_translation(at));
    const SweepResult last = run(towards, still_body(sphere), {.resolution = 1e-9});
    EXPECT_EQ(last.verdict, Verdict::kCollision);
    EXPECT_NEAR(last.free_until, 1.0 - overlap / 3.0, 1e-8);
    EXPECT_NEAR(last.contact_at, 1.0 - overlap / 3.0, 1e-6);
  }
  const SweepResult resting = run(still_body(sphere), still_body(sphere));
  EXPECT_EQ(resting.verdict, Verdict::kCollision);
  EXPECT_EQ(resting.contact_at, 0.0);
}

TEST(Sweep, TouchingForAnInstantIsContact) {
  SceneRandom random(5);
  for (int i = 0; i < effort(150, 20); ++i) {
    // A sphere passes another whose surface it touches at exactly one instant; the numbers are
    // exact.
    const double when = random.uniform(0.0, 1.0);
    const double speed = std::ldexp(1.0, random.whole(-10, 10));
    const Vector3d way(speed, 0.0, 0.0);
    const Pose start = Pose::from_translation({-speed * when, 2.0, 0.0});
    const Body passing = turning_body({{Vector3d::Zero(), 1.0}}, start, random.point(1.0),
                                      random.uniform(-9.0, 9.0), way);
    const Body still = still_body({{Vector3d::Zero(), 1.0}});
    for (const double resolution : {1.0, 1e-3, 1e-6, i < effort(5, 1) ? 0x1p-40 : 1e-7}) {
      const SweepResult result = run(passing, still, {.resolution = resolution});
      ASSERT_NE(result.verdict, Verdict::kFree);
      ASSERT_LE(result.free_until, when);
    }
    // A little farther away it is free, and proved to be.
    const Body beside =
        turning_body({{Vector3d::Zero(), 1.0 - speed * 1e-4}}, start, random.point(1.0), 0.0, way);
    ASSERT_EQ(run(beside, still).verdict, Verdict::kFree);
  }
}

// Poses far from the origin are rounded by more than the spheres overlap. They overlap all the way.
TEST(Sweep, RoundingOfThePosesHidesNoContact) {
  SceneRandom random(7);
  int apart_by_rounding = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector3d place(std::ldexp(random.whole(1, 1000), 12), 0.0, 0.0);
    const Vector3d beside(2.0 - 0x1.8p-30, 0.0, 0.0);  // an overlap of 2^-31; the sum is exact
    const Vector3d way = random.point(1e8);
    const Vector3d axis = random.point(1.0);
    const double angle = random.whole(0, 1) ? random.uniform(-3.0, 3.0) : 0.0;
    const std::vector<Sphere> sphere = {{Vector3d::Zero(), 1.0 - 0x1p-31}};
    const Body a = turning_body(sphere, Pose::from_translation(place), axis, angle, way);
    const Body b = turning_body(sphere, Pose::from_translation(place + beside), axis, -angle, way);
    const SweepResult result = run(a, b);
    ASSERT_NE(result.verdict, Verdict::kFree);
    ASSERT_EQ(result.free_until, 0.0);
    apart_by_rounding += !collides(a.tree, a.motion.pose_at(0.5), b.tree, b.motion.pose_at(0.5));
  }
  EXPECT_GT(apart_by_rounding, 20);
}

TEST(Sweep, BodiesThatMoveAlikeFarAwayNeedOneLook) {
  SceneRandom random(6);
  const std::vector<Sphere> spheres = random_spheres(random, 30, 1.0, 0.1);
  for (const double far : {0.0, 1e3, 1e6, 1e9}) {
    const Vector3d place = Vector3d(far, -0.5 * far, 0.25 * far);
    const Vector3d way = 10.0 * place + Vector3d(1e4, 0.0, 0.0);
    const Pose pose_a = Pose::from_translation(place);
    const Pose pose_b = Pose::from_translation(place + Vector3d(3.0, 0.0, 0.0));
    const Body a = turning_body(spheres, pose_a, Vector3d::UnitX(), 0.0, way);
    const Body b = turning_body(spheres, pose_b, Vector3d::UnitX(), 0.0, way);
    const SweepResult straight = run(a, b);
    EXPECT_EQ(straight.verdict, Verdict::kFree) << far;
    EXPECT_EQ(straight.evaluations, 1u) << far;

    // As one rigid body, about one point.
    const Body c = turning_body(spheres, pose_a, {1.0, 2.0, 3.0}, 50.0, way);
    const Body d = turning_body(spheres, pose_b, {1.0, 2.0, 3.0}, 50.0, way, {-3.0, 0.0, 0.0});
    const SweepResult turning = run(c, d);
    EXPECT_EQ(turning.verdict, Verdict::kFree) << far;
    EXPECT_LE(turning.evaluations, far > 1e6 ? 15u : 1u) << far;
    expect_true(c, d, turning, 300);
  }
}

}  // namespace
}  // namespace spherule::test
