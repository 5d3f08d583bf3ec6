// SPDX-License-Identifier: BSD-3-Clause
// Swept queries of random bodies against the exact motions at thousands of instants.
#include "collide/sweep.h"

#include "base/error.h"
#include "collide/collide.h"
#include "spheretree/sphere_tree.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/exact/poses.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using LongMotion = ExactMotion<long double>;

// A moving body and an oracle of its motion.
struct Body {
  SphereTree tree;
  Motion motion;
  LongMotion exact;
};

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

Body turning_body(const std::vector<Sphere>& spheres, const Pose& start, const Vector3d& axis,
                  double angle, const Vector3d& displacement = Vector3d::Zero(),
                  const Vector3d& reference = Vector3d::Zero()) {
  return {build_tree(spheres), Motion::turning(start, axis, angle, displacement, reference),
          LongMotion::turning(start, axis, angle, displacement, reference)};
}

Body body_between(const std::vector<Sphere>& spheres, const Pose& start, const Pose& end,
                  const Vector3d& reference = Vector3d::Zero()) {
  return {build_tree(spheres), Motion::between(start, end, reference),
          LongMotion::between(start, end, reference)};
}

Body still_body(const std::vector<Sphere>& spheres, const Pose& pose = {}) {
  return body_between(spheres, pose, pose);
}

// The gap of the two sets at t under the exact motions, negative where they overlap.
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

// How fast two bodies can approach each other, roughly from above.
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

SweepResult run(const Body& a, const Body& b, const SweepRequest& request = {}) {
  return sweep(a.tree, a.motion, b.tree, b.motion, request);
}

// Holds a result against `steps` instants and some about `meeting`; returns the least gap there.
double expect_true(const Body& a, const Body& b, const SweepResult& result, int steps,
                   const SweepRequest& request = {}, double meeting = 0.0) {
  double least = std::numeric_limits<double>::infinity();
  const bool free = result.verdict == Verdict::kFree;
  EXPECT_TRUE(!free || result.free_until == 1.0);
  EXPECT_GE(result.free_until, 0.0);
  const auto sample = [&](double t, bool is_rounded) {
    const double gap = gap_at(a, b, t);
    least = std::min(least, gap);
    if (free || (result.free_until > 0.0 && t <= result.free_until)) {
      EXPECT_GT(gap, request.clearance) << "called free at " << t;
      EXPECT_TRUE(!is_rounded || !touch_at(a, b, t, request.clearance)) << t;
    }
  };
  for (int i = 0; i <= steps; ++i) sample(static_cast<double>(i) / steps, i % 16 == 0);
  for (int i = 3; i < 60; i += 3) {
    sample(std::min(1.0, meeting + std::ldexp(1.0, -i)), false);
    sample(std::max(0.0, meeting - std::ldexp(1.0, -i)), true);
  }
  if (result.free_until > 0.0) sample(result.free_until, true);
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

// A body whose motion is shifted by that.
using Mover = std::function<Body(const Vector3d&)>;

// Static, from pose to pose, or turning (twice as often as each), within some `size`.
Mover random_mover(Random& random, double size) {
  const int count = random.whole(1, 12);
  const std::vector<Sphere> spheres = random_spheres(random, count, size, 0.3 * size);
  const Pose start = random.pose(1.5 * size);
  const Vector3d reference = random.whole(0, 1) ? random.point(size) : Vector3d::Zero();
  const auto shifted = [](const Pose& pose, const Vector3d& shift) {
    return Pose(pose.rotation(), pose.translation() + shift);
  };
  switch (random.whole(0, 3)) {
    case 0:
      return [=](const Vector3d& shift) { return still_body(spheres, shifted(start, shift)); };
    case 1:
      return [=, end = random.pose(1.5 * size)](const Vector3d& shift) {
        return body_between(spheres, shifted(start, shift), shifted(end, shift), reference);
      };
    default:
      break;
  }
  const Vector3d axis = random.point(1.0);
  const double angle = random.between(-1.0, 1.0) * std::ldexp(64.0, -random.whole(0, 15));
  const Vector3d way = random.point(random.whole(0, 1) ? 3.0 * size : 0.0);
  return [=](const Vector3d& shift) {
    return turning_body(spheres, shifted(start, shift), axis, angle, way, reference);
  };
}

Body random_body(Random& random, double size) {
  return random_mover(random, size)(Vector3d::Zero());
}

// By how much a has to be shifted, in some direction, for the least gap at `t` to be `gap`.
Vector3d shift_to_gap(Random& random, const Body& a, const Body& b, double t, double gap) {
  const auto centers_a = centers_at(a, t), centers_b = centers_at(b, t);
  const auto vector = [](const Vector<long double>& v) {
    return Eigen::Matrix<long double, 3, 1>(v[0], v[1], v[2]);
  };
  const auto direction = random.direction().cast<long double>().eval();
  // First on to a sphere of b, then out of all that are in the way.
  const auto aim = vector(difference(centers_b[0], centers_a[0]));
  std::optional<long double> farthest;
  for (std::size_t i = 0; i < centers_a.size(); ++i) {
    for (std::size_t j = 0; j < centers_b.size(); ++j) {
      const auto from = (vector(difference(centers_a[i], centers_b[j])) + aim).eval();
      const long double reach =
          static_cast<long double>(a.tree.spheres()[i].radius) + b.tree.spheres()[j].radius + gap;
      const long double passed = from.dot(direction) / direction.squaredNorm();
      const long double square = reach * reach - (from - passed * direction).squaredNorm();
      if (reach < 0.0L || square < 0.0L) continue;
      const long double way = std::sqrt(square / direction.squaredNorm()) - passed;
      farthest = std::max(farthest.value_or(way), way);
    }
  }
  return (aim + farthest.value_or(0.0L) * direction).cast<double>();
}

// Anywhere, and shifted so that they come within a clearance and a small gap at some instant.
TEST(Sweep, IsTrueAtThousandsOfInstants) {
  Random random(seeded(1));
  int counts[3] = {}, proved_near = 0;
  for (int i = 0; i < scaled(300, 40); ++i) {
    const double size = std::ldexp(1.0, random.whole(-20, 20));
    const Mover mover = random_mover(random, size);
    const Body b = random_body(random, size);
    Body a = mover(Vector3d::Zero());
    SweepRequest request;
    if (random.chance(0.3)) request.clearance = random.between(0.0, 0.5) * size;
    if (random.chance(0.3)) request.resolution = random.magnitude(1e-7, 0.1);
    const double meeting = random.chance(0.1) ? random.whole(0, 1) : random.unit();
    const bool is_near = random.chance(0.6);
    if (is_near) {
      const double gap = request.clearance + random.small_gap() * size;
      a = mover(shift_to_gap(random, a, b, meeting, gap));
    }
    const SweepResult result = run(a, b, request);
    const double least = expect_true(a, b, result, 2000, request, meeting) - request.clearance;
    ASSERT_FALSE(HasFailure()) << i;
    ++counts[static_cast<int>(result.verdict)];
    // What has room for the resolution must be proved. The steps may have missed a little.
    const double rounding = 1e-11 * size;
    const double room = fastest(a, b) * (0.5 * request.resolution + 0.5 / 2000) * 1.01 + rounding;
    if (least > room) {
      ASSERT_EQ(result.verdict, Verdict::kFree) << i << " " << least / room;
      proved_near += least < 0.1 * size;
    }
    if (least < 0.0) {
      ASSERT_NE(result.verdict, Verdict::kFree);
    }
    if (result.free_until > 0.0 && result.free_until < 1.0) {
      ASSERT_LT(gap_at(a, b, result.free_until) - request.clearance,
                fastest(a, b) * 2.0 * request.resolution + rounding);
    }
    expect_same(result, run(b, a, request));
    a.tree = build_tree(a.tree.spheres(), {.branching = random.whole(2, 16)});
    expect_same(result, run(a, b, request));
  }
  EXPECT_GT(counts[static_cast<int>(Verdict::kFree)], effort(30, 3));
  EXPECT_GT(counts[static_cast<int>(Verdict::kCollision)], effort(80, 8));
  EXPECT_GT(proved_near, effort(2, 0));
}

TEST(Sweep, LimitsLeaveItUnknownAndTrue) {
  Random random(9);
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

// Motions made to deceive: thin walls, long rods, many turns, instants of contact.

constexpr double kPi = std::numbers::pi;

TEST(Sweep, NothingTunnelsThroughAThinWall) {
  std::vector<Sphere> wall;
  for (int y = -8; y <= 8; ++y) {
    for (int z = -8; z <= 8; ++z) wall.push_back({{0.0, 1e-3 * y, 1e-3 * z}, 7.2e-4});
  }
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    // Through a point of the wall, very fast, at any time, turning or not.
    const Vector3d target(0.0, random.between(-7e-3, 7e-3), random.between(-7e-3, 7e-3));
    const double length = std::ldexp(1.0, random.whole(-3, 17));
    Vector3d way = random.point(1.0);
    way.x() += way.x() < 0.0 ? -0.5 : 0.5;
    way = way.normalized() * length;
    const double when = random.between(0.01, 0.99);
    const Body bullet =
        turning_body({{Vector3d::Zero(), 1e-5}}, Pose::from_translation(target - when * way),
                     random.point(1.0), random.between(-50.0, 50.0), way);
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
  Random random(5);
  for (int i = 0; i < effort(150, 20); ++i) {
    // A sphere passes another whose surface it touches at exactly one instant; the numbers are
    // exact.
    const double when = random.between(0.0, 1.0);
    const double speed = std::ldexp(1.0, random.whole(-10, 10));
    const Vector3d way(speed, 0.0, 0.0);
    const Pose start = Pose::from_translation({-speed * when, 2.0, 0.0});
    const Body passing = turning_body({{Vector3d::Zero(), 1.0}}, start, random.point(1.0),
                                      random.between(-9.0, 9.0), way);
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
  Random random(7);
  int apart_by_rounding = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector3d place(std::ldexp(random.whole(1, 1000), 12), 0.0, 0.0);
    const Vector3d beside(2.0 - 0x1.8p-30, 0.0, 0.0);  // an overlap of 2^-31; the sum is exact
    const Vector3d way = random.point(1e8);
    const Vector3d axis = random.point(1.0);
    const double angle = random.whole(0, 1) ? random.between(-3.0, 3.0) : 0.0;
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
  Random random(6);
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
