// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/pose.h"

#include "base/error.h"
#include "base/rounding.h"
#include "tests/support/exact/spheres.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

using Point = Vector<Real>;

Point point(const Vector3d& v) {
  return exact<Real>(v);
}

double distance(const Point& a, const Point& b) {
  return static_cast<double>(sqrt(squared_distance(a, b)));
}

Quaterniond random_quaternion(Random& random) {
  return {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1),
          random.between(-1, 1)};
}

// Random ones, half turns, tiny turns, and components of very different size.
std::vector<Quaterniond> quaternions(std::size_t count) {
  Random random(17);
  std::vector<Quaterniond> result = {{1, 0, 0, 0},
                                     {0, 1, 0, 0},
                                     {0, 0, -3, 0},
                                     {0, 0, 0, 1e-300},
                                     {1, 1, 1, 1},
                                     {1e200, -1e200, 0, 1e200},
                                     {1e-200, 2e-200, -3e-200, 4e-200},
                                     {1e200, 1e-200, 1, 0},
                                     {0x1p-1074, 0x1p-1074, 0, 0},
                                     {1e308, 1e308, 1e308, 1e308}};
  for (std::size_t i = 0; i < count; ++i) {
    Quaterniond q = random_quaternion(random);
    for (int k = 0; k < 4; ++k) {
      if (i % 3 == 1) q.coeffs()[k] *= std::pow(10.0, random.between(-18.0, 0.0));
    }
    const double scale = i % 4 == 0 ? std::pow(10.0, random.between(-290.0, 290.0)) : 1.0;
    q.coeffs() *= scale;
    result.push_back(q);
  }
  return result;
}

TEST(Pose, MatrixEntriesAreWithinTheStatedError) {
  double worst = 0.0;
  for (const Quaterniond& q : quaternions(20000)) {
    const Pose pose(q, Vector3d::Zero());
    for (int column = 0; column < 3; ++column) {
      const Point exact = transform(pose, point(Vector3d::Unit(column)));
      for (int row = 0; row < 3; ++row) {
        const Real difference =
            Real(pose.matrix()(row, column)) - exact[static_cast<std::size_t>(row)];
        worst = std::max(worst, std::abs(static_cast<double>(difference)));
      }
    }
  }
  EXPECT_LE(worst, kRotationEntryError);
  EXPECT_GE(worst, 0.05 * kRotationEntryError);  // the bound is not idle
}

// Only quaternions far from unit length are scaled on the way, and that shows in no bit.
TEST(Pose, PowersOfTwoChangeNoBitOfTheMatrix) {
  Random random(4);
  for (int i = 0; i < 20000; ++i) {
    Quaterniond q = random_quaternion(random);
    for (int k = 0; k < 4; ++k) {
      if (random.between(0, 1) < 0.1) q.coeffs()[k] *= random.between(0, 1) < 0.5 ? 0.0 : 0x1p-300;
    }
    if (!(q.coeffs().cwiseAbs().maxCoeff() > 0.0)) continue;
    const Matrix3d matrix = Pose(q, Vector3d::Zero()).matrix();
    for (const double factor : {0x1p-600, 0x1p-35, 0x1p-29, 0x1p-3, 0x1p29, 0x1p35, 0x1p900}) {
      const Quaterniond scaled(Eigen::Vector4d(factor * q.coeffs()));
      ASSERT_EQ(Pose(scaled, Vector3d::Zero()).matrix(), matrix) << q.coeffs().transpose();
    }
  }
}

TEST(Pose, MapsPointsWithinTheStatedError) {
  Random random(23);
  for (const Quaterniond& q : quaternions(5000)) {
    const double scale = std::pow(10.0, random.between(-9.0, 9.0));
    const Pose pose(q, scale * random.point(1.0));
    const Vector3d p = std::pow(10.0, random.between(-3.0, 3.0)) * scale * random.point(1.0);
    const double error = distance(point(pose * p), transform(pose, point(p)));
    ASSERT_LE(error, 40.0 * kUnitRoundoff * (p.norm() + pose.translation().norm()));
  }
}

TEST(Pose, CompositionAndInverseAreAccurate) {
  Random random(29);
  const std::vector<Quaterniond> rotations = quaternions(5000);
  for (std::size_t i = 1; i < rotations.size(); ++i) {
    const Pose a(rotations[i], random.point(10.0));
    const Pose b(rotations[i - 1], random.point(0.1));
    const Vector3d p = random.point(1.0);
    const double size = p.norm() + a.translation().norm() + b.translation().norm();
    const Point ab = transform(a, transform(b, point(p)));
    ASSERT_LE(distance(transform(a * b, point(p)), ab), 80.0 * kUnitRoundoff * size) << i;
    const Point back = transform(a.inverse(), transform(a, point(p)));
    ASSERT_LE(distance(back, point(p)), 80.0 * kUnitRoundoff * size) << i;
  }
}

TEST(Pose, LongChainsStayUnit) {
  Random random(31);
  Pose pose;
  const Pose step(random_quaternion(random), Vector3d::Zero());
  for (int i = 0; i < 100000; ++i) pose = pose * step;
  EXPECT_NEAR(pose.rotation().norm(), 1.0, 1e-15);
}

TEST(Pose, FromIsometryTakesTheNearestRotation) {
  Random random(37);
  for (int i = 0; i < 2000; ++i) {
    const Pose pose(random_quaternion(random).normalized(), random.point(5.0));
    EXPECT_LT((Pose::from_isometry(pose.isometry()).matrix() - pose.matrix()).norm(), 4e-15);
    EXPECT_EQ(Pose::from_isometry(pose.isometry()).translation(), pose.translation());
    // A symmetric stretch does not change the polar factor, which is the nearest rotation.
    Matrix3d stretch = Matrix3d::Identity();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column <= row; ++column) {
        const double value = random.between(-1e-7, 1e-7);
        stretch(row, column) += value;
        if (row != column) stretch(column, row) += value;
      }
    }
    Isometry3d stretched = pose.isometry();
    stretched.linear() = pose.matrix() * stretch;
    EXPECT_LT((Pose::from_isometry(stretched).matrix() - pose.matrix()).norm(), 1e-14);
  }
  EXPECT_EQ(Pose::from_isometry(Isometry3d::Identity()).matrix(), Matrix3d::Identity());
}

TEST(Pose, RefusesWhatIsNoRigidMotion) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Vector3d zero = Vector3d::Zero();
  for (const double bad : {nan, infinity, -infinity}) {
    for (int k = 0; k < 4; ++k) {
      Quaterniond q(1, 2, 3, 4);
      q.coeffs()[k] = bad;
      EXPECT_THROW(Pose(q, zero), Error);
    }
    EXPECT_THROW(Pose::from_translation({0, bad, 0}), Error);
  }
  EXPECT_THROW(Pose(Quaterniond(0, 0, 0, 0), zero), Error);
  EXPECT_THROW(Pose(Quaterniond(-0.0, 0, -0.0, 0), zero), Error);
  EXPECT_THROW(Pose::from_translation({0, 0, 1.1e15}), Error);
  EXPECT_NO_THROW(Pose::from_translation({0, 0, -1e15}));
  const Pose far = Pose::from_translation({6e14, 0, 0});
  EXPECT_THROW(far * far, Error);

  const auto linear = [](const Matrix3d& m) {
    Isometry3d result = Isometry3d::Identity();
    result.linear() = m;
    return result;
  };
  const Matrix3d identity = Matrix3d::Identity();
  Matrix3d sheared = identity;
  sheared(0, 1) = 1e-5;
  Matrix3d not_a_number = identity;
  not_a_number(2, 0) = nan;
  for (const Matrix3d& bad : {Matrix3d(-identity), Matrix3d(2.0 * identity), sheared, not_a_number,
                              Matrix3d(Matrix3d::Zero()), Matrix3d(1e200 * identity),
                              Matrix3d(Vector3d(1, 1, -1).asDiagonal())}) {
    EXPECT_THROW(Pose::from_isometry(linear(bad)), Error);
  }
}

}  // namespace
}  // namespace spherule::test
