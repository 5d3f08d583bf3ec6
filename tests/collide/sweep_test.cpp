// SPDX-License-Identifier: BSD-3-Clause
// Swept queries of random bodies against brute force with thousands of steps.

#include "collide/sweep.h"

#include "base/error.h"
#include "tests/collide/swept_bodies.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

TEST(Sweep, IsTrueAtThousandsOfInstants) {
  SceneRandom random(1);
  int counts[3] = {};
  int proved_near = 0;
  for (int i = 0; i < effort(200, 25); ++i) {
    const double size = std::ldexp(1.0, random.whole(-20, 20));
    const Body a = random_body(random, size);
    const Body b = random_body(random, size);
    const SweepResult result = run(a, b);
    const double least = expect_true(a, b, result, 3000);
    ++counts[static_cast<int>(result.verdict)];
    // What has room for the resolution must be proved. The steps may have missed a little.
    const double room = fastest(a, b) * (0.5e-4 + 0.5 / 3000) * 1.01;
    if (least > room) {
      ASSERT_EQ(result.verdict, Verdict::kFree) << i << " " << least / room;
      proved_near += least < 0.1 * size;
    }
    if (least < 0.0) {
      ASSERT_NE(result.verdict, Verdict::kFree);
    }
    expect_same(result, run(b, a));
  }
  EXPECT_GT(counts[static_cast<int>(Verdict::kFree)], effort(30, 3));
  EXPECT_GT(counts[static_cast<int>(Verdict::kCollision)], effort(50, 6));
  EXPECT_GT(proved_near, effort(2, 0));
}

// Motions that are shifted to pass at a chosen gap, on either side of nothing.
TEST(Sweep, IsTrueNextToContact) {
  SceneRandom random(2);
  int free = 0;
  int not_free = 0;
  for (int i = 0; i < effort(60, 8); ++i) {
    const std::vector<Sphere> spheres = random_spheres(random, 6, 1.0, 0.3);
    const Pose start = random.pose(1.0);
    const Vector3d axis = random.point(1.0);
    const double angle = random.uniform(-7.0, 7.0);
    const Vector3d way = random.point(2.0);
    const Body mover = turning_body(spheres, start, axis, angle, way);
    // A sphere whose surface the mover passes at `gap`: its radius is the least distance of its
    // centre, found by steps and then narrowed down.
    const Vector3d center = random.point(4.0);
    const auto distance = [&](double t) { return gap_at(mover, still_body({{center, 0.0}}), t); };
    double best = 0.0;
    for (int k = 1; k <= 500; ++k) best = distance(k / 500.0) < distance(best) ? k / 500.0 : best;
    for (double step = 1e-3; step > 1e-10; step *= 0.5) {
      for (const double t : {best - step, best + step}) {
        if (t >= 0.0 && t <= 1.0 && distance(t) < distance(best)) best = t;
      }
    }
    const double room = distance(best);
    if (room <= 0.01) continue;
    for (const double gap : {1e-2, 3e-3, 1e-3, 1e-5, 1e-9, 0.0, -1e-9, -1e-6, -1e-4}) {
      const Body obstacle = still_body({{center, room - gap}});
      const SweepResult result = run(mover, obstacle);
      if (gap <= 0.0) {
        ASSERT_NE(result.verdict, Verdict::kFree) << gap;
        ASSERT_LE(result.free_until, best + 1e-6);
        ++not_free;
      }
      if (gap >= 3e-3) {
        ASSERT_EQ(result.verdict, Verdict::kFree) << gap;
        ++free;
      }
      if (gap <= -1e-6) {
        // The first fraction not proved is near the first contact.
        double first = 0.0;
        while (first < 1.0 && distance(first) > room - gap) first += 1e-4;
        ASSERT_LE(result.free_until, first);
        ASSERT_TRUE(first == 0.0 || gap_at(mover, obstacle, result.free_until) > 0.0);
        ASSERT_LT(gap_at(mover, obstacle, result.free_until), fastest(mover, obstacle) * 2e-4);
      }
    }
    expect_true(mover, still_body({{center, room - 1e-3}}),
                run(mover, still_body({{center, room - 1e-3}})), 2000);
  }
  EXPECT_GT(free, effort(50, 6));
  EXPECT_GT(not_free, effort(100, 12));
}

TEST(Sweep, KeepsAClearance) {
  SceneRandom random(7);
  int free = 0;
  int contacts = 0;
  for (int i = 0; i < 200; ++i) {
    const Body a = random_body(random, 1.0);
    const Body b = random_body(random, 1.0);
    const SweepRequest request = {.clearance = random.uniform(0.0, 0.5)};
    const SweepResult result = run(a, b, request);
    expect_true(a, b, result, 500, request);
    free += result.verdict == Verdict::kFree;
    contacts += result.verdict == Verdict::kCollision;
    ASSERT_TRUE(result.verdict != Verdict::kFree || run(a, b).verdict == Verdict::kFree);
  }
  EXPECT_GT(free, 20);
  EXPECT_GT(contacts, 50);
}

TEST(Sweep, DoesNotDependOnTheShapeOfTheTrees) {
  SceneRandom random(8);
  for (int i = 0; i < 60; ++i) {
    const std::vector<Sphere> spheres = random_spheres(random, 100, 1.0, 0.08);
    const Pose start = random.pose(1.0);
    const Vector3d axis = random.point(1.0);
    const Vector3d way = random.point(4.0);
    const Body still = still_body(random_spheres(random, 100, 1.0, 0.08), random.pose(3.0));
    const auto with = [&](int branching) {
      return run(turning_body(spheres, start, axis, 2.0, way, Vector3d::Zero(), branching), still);
    };
    const SweepResult binary = with(2);
    expect_same(binary, with(5));
    expect_same(binary, with(16));
  }
}

TEST(Sweep, LimitsLeaveItUnknownAndTrue) {
  SceneRandom random(9);
  int unknown = 0;
  for (int i = 0; i < 60; ++i) {
    const Body a = random_body(random, 1.0);
    const Body b = random_body(random, 1.0);
    const SweepResult full = run(a, b);
    for (std::uint64_t budget = 0; budget < 2000; budget = budget * 2 + 1) {
      const SweepRequest request = {.max_node_tests = budget};
      const SweepResult result = run(a, b, request);
      ASSERT_LE(result.cost.node_tests, budget);
      ASSERT_LE(result.free_until, full.free_until);
      expect_true(a, b, result, 50, request);
      if (result.verdict == Verdict::kUnknown) {
        ++unknown;
      } else {
        ASSERT_EQ(result.verdict, full.verdict);
      }
      if (budget == 0) {
        ASSERT_EQ(result.verdict, Verdict::kUnknown);
        ASSERT_EQ(result.free_until, 0.0);
      }
    }
    const SweepResult no_time = run(a, b, {.max_time = std::chrono::nanoseconds(0)});
    ASSERT_EQ(no_time.verdict, Verdict::kUnknown);
    ASSERT_EQ(no_time.cost.node_tests, 0u);
    expect_same(full, run(a, b, {.max_time = std::chrono::hours(1)}));
  }
  EXPECT_GT(unknown, 100);
}

TEST(Sweep, RefusesWhatCannotBeUsed) {
  const Body sphere = still_body({{Vector3d::Zero(), 1.0}});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -1e-9, 2e15}) {
    EXPECT_THROW(run(sphere, sphere, {.clearance = bad}), Error);
    EXPECT_THROW(run(sphere, sphere, {.resolution = bad}), Error);
  }
  EXPECT_THROW(run(sphere, sphere, {.resolution = 0.0}), Error);
  EXPECT_THROW(run(sphere, sphere, {.resolution = 1e-13}), Error);
}

}  // namespace
}  // namespace spherule::test
