// SPDX-License-Identifier: BSD-3-Clause
// Corners of hulls, against support functions: the hull of all points lies within a radius of that
// of the corners exactly if no direction has a point that is further than that before all corners.

#include "robot/pairs/link_pieces.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace spherule::test::hull_corners_test {
namespace {

using Eigen::Vector3d;
using internal::hull_corners;
using internal::HullCorners;

long double most_along(const std::vector<Vector3d>& points, const Vector3d& direction) {
  const Eigen::Matrix<long double, 3, 1> n = direction.cast<long double>();
  long double most = -std::numeric_limits<long double>::infinity();
  for (const Vector3d& point : points) most = std::max(most, n.dot(point.cast<long double>()));
  return most / n.norm();
}

Vector3d direction(Random& random) {
  Vector3d result;
  do {
    result = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
  } while (result.norm() < 0.1);
  return result.normalized();
}

std::vector<Vector3d> points_of(int count, const std::function<Vector3d()>& point) {
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(point());
  return points;
}

TEST(HullCorners, HoldAllPointsUpToTheirRadius) {
  Random random(83);
  const auto sphere = [&] { return direction(random); };
  const auto inside = [&] { return Vector3d(random.between(0, 1) * direction(random)); };
  const auto rod = [&] {
    const double angle = random.between(0.0, 6.3);
    return Vector3d(0.05 * std::cos(angle), 0.05 * std::sin(angle), random.whole(0, 40) / 20.0);
  };
  const auto plate = [&] { return Vector3d(random.between(0, 1), random.between(0, 1), 0.25); };
  const auto line = [&] { return Vector3d(random.between(0, 1), 0.5, 0.25); };
  const auto far = [&] { return Vector3d(direction(random) + Vector3d(1e6, -2e6, 3e6)); };
  const std::vector<std::function<Vector3d()>> families{sphere, inside, rod, plate, line, far};
  for (const auto& family : families) {
    const std::vector<Vector3d> points = points_of(effort(3000, 400), family);
    for (const double tolerance : {0.1, 0.003}) {
      const HullCorners found = hull_corners(points, tolerance);
      EXPECT_LE(found.radius, tolerance + 1e-7);
      EXPECT_LT(found.corners.size(), points.size());
      for (const Vector3d& corner : found.corners) {
        ASSERT_NE(std::find(points.begin(), points.end(), corner), points.end());
      }
      for (int i = 0; i < effort(2000, 200); ++i) {
        const Vector3d n = i % 2 == 0 ? direction(random)
                                      : points[static_cast<std::size_t>(
                                            random.whole(0, static_cast<int>(points.size()) - 1))] -
                                            points.front() + 1e-3 * direction(random);
        ASSERT_LE(most_along(points, n), most_along(found.corners, n) + found.radius);
      }
    }
  }
}

TEST(HullCorners, AreFew) {
  Random random(84);
  const std::vector<Vector3d> sphere = points_of(5000, [&] { return direction(random); });
  EXPECT_LT(hull_corners(sphere, 0.01).corners.size(), 700U);
  EXPECT_LT(hull_corners(sphere, 0.1).corners.size(), 100U);
}

TEST(HullCorners, OfFewPointsAreAll) {
  Random random(85);
  const std::vector<Vector3d> points = points_of(50, [&] { return direction(random); });
  const HullCorners found = hull_corners(points, 0.5);
  EXPECT_EQ(found.corners, points);
  EXPECT_EQ(found.radius, 0.0);
}

}  // namespace
}  // namespace spherule::test::hull_corners_test
