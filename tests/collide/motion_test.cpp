// SPDX-License-Identifier: BSD-3-Clause
// Poses along motions against 100 digits.
#include "collide/motion/motion.h"

#include "base/error.h"
#include "tests/support/exact/poses.h"
#include "tests/support/exact/spheres.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

namespace spherule::test {
namespace {

using Exact = ExactMotion<Real>;

struct Pair {
  Motion motion;
  Exact exact;
};

Pair random_turning(Random& random, double size) {
  const Pose start = random.pose(size);
  const Eigen::Vector3d axis = random.point(1.0) * std::ldexp(1.0, random.whole(-600, 600));
  const double angle = std::ldexp(random.between(-1.0, 1.0), random.whole(-60, 20));
  const Eigen::Vector3d displacement = random.point(size);
  const Eigen::Vector3d reference =
      random.whole(0, 1) ? random.point(size) : Eigen::Vector3d::Zero();
  return {Motion::turning(start, axis, angle, displacement, reference),
          Exact::turning(start, axis, angle, displacement, reference)};
}

Pair random_between(Random& random, double size) {
  const Pose start = random.pose(size);
  Pose end = random.pose(size);
  if (random.whole(0, 1)) {
    // Nearly the same rotation, or exactly.
    const double angle = random.whole(0, 3) ? std::ldexp(1.0, random.whole(-70, -1)) : 0.0;
    const Eigen::Quaterniond turn(1.0, angle, 0.5 * angle, -angle);
    end = Pose(turn * start.rotation(), random.point(size));
  }
  const Eigen::Vector3d reference =
      random.whole(0, 1) ? random.point(size) : Eigen::Vector3d::Zero();
  return {Motion::between(start, end, reference), Exact::between(start, end, reference)};
}

Real error_at(const Pair& pair, double t, const Eigen::Vector3d& p) {
  return sqrt(squared_distance(pair.exact.at(Real(t), p),
                               transform(pair.motion.pose_at(t), exact<Real>(p))));
}

template <class Make>
void expect_bounded(Make make, std::uint64_t seed, double tightest, bool in_place = false) {
  Random random(seed);
  Real largest = 0;
  for (int i = 0; i < 1500; ++i) {
    const double size = std::ldexp(1.0, random.whole(-30, 30));
    const Pair pair = make(random, in_place ? 0.0 : size);
    for (const double t : {random.between(0.0, 1.0), 0.0, 1.0, 1e-9}) {
      const Eigen::Vector3d p = random.point(size);
      const double bound = pair.motion.pose_error(p.norm() * (1.0 + 1e-15));
      const Real error = error_at(pair, t, p);
      ASSERT_LE(error, bound) << i << " " << t;
      if (error / bound > largest) largest = error / bound;
    }
  }
  EXPECT_GT(largest, tightest) << "the bound is far too wide";
}

TEST(Motion, PosesOfATurnAreWithinTheBound) {
  expect_bounded(random_turning, 1, 0.1);
}

TEST(Motion, PosesBetweenTwoPosesAreWithinTheBound) {
  expect_bounded(random_between, 2, 0.02);
}

// Where only the rotation errs.
TEST(Motion, RotationsAreWithinTheBound) {
  expect_bounded(random_turning, 4, 0.02, true);
  expect_bounded(random_between, 5, 0.01, true);
}

TEST(Motion, MeetsTheGivenPosesExactly) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Pose start = random.pose(1.0);
    const Pose end = random.pose(1.0);
    const Motion motion = Motion::between(start, end, random.point(1.0));
    for (const auto& [t, pose] : {std::pair(0.0, start), std::pair(1.0, end)}) {
      EXPECT_EQ(motion.pose_at(t).rotation().coeffs(), pose.rotation().coeffs());
      EXPECT_EQ(motion.pose_at(t).translation(), pose.translation());
    }
    EXPECT_LE(motion.angle(), 3.15);
  }
}

TEST(Motion, StandsStillExactly) {
  const Motion motion = Motion::still(Pose::from_translation({1e14, 1.0, -3.0}));
  EXPECT_EQ(motion.pose_error(1e3), 0.0);
  EXPECT_EQ(motion.pose_at(0.3).translation(), Eigen::Vector3d(1e14, 1.0, -3.0));
}

TEST(Motion, RefusesWhatCannotBeUsed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  for (const double bad : {nan, inf, -inf, 2e15}) {
    const Eigen::Vector3d point(0.0, bad, 0.0);
    EXPECT_THROW(Motion::turning(Pose(), axis, bad), Error);
    EXPECT_THROW(Motion::turning(Pose(), axis, 1.0, point), Error);
    EXPECT_THROW(Motion::turning(Pose(), axis, 1.0, zero, point), Error);
    EXPECT_THROW(Motion::between(Pose(), Pose(), point), Error);
    EXPECT_THROW(Motion::still(Pose()).pose_at(bad), Error);
  }
  EXPECT_THROW(Motion::turning(Pose(), {nan, 0.0, 1.0}, 1.0), Error);
  EXPECT_THROW(Motion::turning(Pose(), {inf, 0.0, 1.0}, 1.0), Error);
  EXPECT_THROW(Motion::turning(Pose(), zero, 1.0), Error);
  EXPECT_THROW(Motion::turning(Pose(), axis, 2e6), Error);
  EXPECT_THROW(Motion::still(Pose()).pose_at(-1e-300), Error);
  const Pose far = Pose::from_translation({9e14, 0.0, 0.0});
  EXPECT_THROW(Motion::turning(far, axis, 1.0, {9e14, 0.0, 0.0}), Error);
  EXPECT_THROW(Motion::between(far, Pose(), {9e14, 0.0, 0.0}), Error);
}

}  // namespace
}  // namespace spherule::test
