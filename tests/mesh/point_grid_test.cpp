// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/weld.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule::test::point_grid_test {
namespace {

using Eigen::Vector3d;

// Places of a lattice among them, which stand on the borders of cubes, and on spheres about others.
std::vector<Vector3d> random_points(Random& random, std::size_t count, const Vector3d& shift) {
  const Eigen::AlignedBox3d box(Vector3d::Zero(), Vector3d(4.0, 2.0, 1.0));
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    Vector3d p = random.in_box(box);
    if (random.index(2) == 0) p = (p * 4.0).array().round().matrix() / 4.0;
    points.push_back(p + shift);
  }
  return points;
}

TEST(PointGrid, FindsWhatALookAtAllFinds) {
  Random random(1);
  std::size_t count = 0;
  for (const Vector3d& shift :
       {Vector3d(0.0, 0.0, 0.0), Vector3d(-1e3 - 1.0 / 3.0, 7e5, 1.0 / 3.0)}) {
    for (const std::size_t size : {0U, 1U, 7U, 300U}) {
      for (const double edge : {1e-300, 1e-9, 0.01, 0.25, 0.3, 9.0}) {
        const std::vector<Vector3d> points = random_points(random, size, shift);
        const internal::PointGrid grid(points, edge);
        for (const Vector3d& center : random_points(random, 30, shift)) {
          for (const double radius : {0.0, 0.25, 0.5, random.between(0.0, 2.0), 1e3}) {
            std::vector<std::uint32_t> expected, found;
            for (std::uint32_t i = 0; i < size; ++i) {
              if ((points[i] - center).squaredNorm() <= radius * radius) expected.push_back(i);
            }
            grid.find(center, radius, found);
            std::sort(found.begin(), found.end());
            ASSERT_EQ(found, expected) << edge << " " << radius;
            count += found.size();
          }
        }
      }
    }
  }
  EXPECT_GT(count, 10000U);
}

// Next to a place that its cube does not reach.
TEST(PointGrid, RoundingOfAPlaceLosesNoPoint) {
  const std::vector<Vector3d> points = {{0, 0, 0}, {1.0 - 0x1p-53, 0, 0}, {9, 0, 0}};
  const internal::PointGrid grid(points, 1.0);
  std::vector<std::uint32_t> found;
  grid.find({4, 0, 0}, 3.0, found);
  EXPECT_EQ(found, std::vector<std::uint32_t>{1});
}

}  // namespace
}  // namespace spherule::test::point_grid_test
