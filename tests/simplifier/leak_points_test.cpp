// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "simplifier/leaks.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

// The distance to the union of the spheres, sphere by sphere.
long double gap(const Vector3d& point, const std::vector<Sphere>& spheres) {
  long double least = std::numeric_limits<long double>::infinity();
  for (const Sphere& sphere : spheres) {
    long double squared = 0.0L;
    for (int axis = 0; axis < 3; ++axis) {
      const long double d = static_cast<long double>(point[axis]) - sphere.center[axis];
      squared += d * d;
    }
    least = std::min(least, std::sqrt(squared) - sphere.radius);
  }
  return least;
}

// The distance to the surface of the unit cube.
double from_cube(const Vector3d& p) {
  const Vector3d inside = p.cwiseMin(Vector3d::Ones() - p);
  const Vector3d outside = (-inside).cwiseMax(0.0);
  return inside.minCoeff() >= 0.0 ? inside.minCoeff() : outside.norm();
}

TEST(LeakPointsTest, AreLeaksOfTheSurfaceAndMissNone) {
  Random random(20);
  const Eigen::AlignedBox3d room(Vector3d::Constant(-0.2), Vector3d::Constant(1.2));
  const LeakPointOptions options{.spacing = 0.02, .separation = 0.04, .max_count = 10000};
  const double diagonal = std::sqrt(3.0);
  std::size_t leaks_seen = 0;
  for (int round = 0; round < effort(12, 3); ++round) {
    std::vector<Sphere> spheres;
    for (int i = 0; i < 12; ++i) spheres.push_back({random.in_box(room), random.between(0.1, 0.6)});
    const auto leaks = leak_points(cube_mesh(), spheres, options);
    leaks_seen += leaks.size();
    for (std::size_t i = 0; i < leaks.size(); ++i) {
      EXPECT_LT(from_cube(leaks[i].point), 1e-15);
      EXPECT_GT(leaks[i].depth, 0.0);
      EXPECT_GE(gap(leaks[i].point, spheres), static_cast<long double>(leaks[i].depth));
      EXPECT_NEAR(static_cast<double>(gap(leaks[i].point, spheres)), leaks[i].depth, 1e-14);
      if (i > 0) {
        EXPECT_GE(leaks[i - 1].depth, leaks[i].depth);
      }
      for (std::size_t k = 0; k < i; ++k) {
        EXPECT_GT((leaks[i].point - leaks[k].point).norm(), options.separation * diagonal);
      }
    }
    // Every point of the surface that is deeper than the samples are apart has a leak nearby.
    const double reach = (options.separation + options.spacing) * diagonal;
    for (int sample = 0; sample < effort(500, 100); ++sample) {
      Vector3d p = random.in_box({Vector3d::Zero(), Vector3d::Ones()});
      p[static_cast<int>(random.index(3))] = random.index(2) == 0 ? 0.0 : 1.0;
      if (gap(p, spheres) < options.spacing * diagonal) continue;
      EXPECT_TRUE(std::any_of(leaks.begin(), leaks.end(), [&](const LeakPoint& leak) {
        return (leak.point - p).norm() <= reach;
      }));
    }
  }
  EXPECT_GT(leaks_seen, 100u);
}

TEST(LeakPointsTest, CornersAreFound) {
  const auto leaks = leak_points(cube_mesh(), std::vector<Sphere>{{Vector3d::Constant(0.5), 0.8}});
  ASSERT_GE(leaks.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(leaks[i].depth, std::sqrt(0.75) - 0.8, 1e-14);
  }
  EXPECT_EQ(leak_points(cube_mesh(), std::vector<Sphere>{{Vector3d::Constant(0.5), 0.8}},
                        {.max_count = 3})
                .size(),
            3u);
}

TEST(LeakPointsTest, NoneWhereAllIsCovered) {
  EXPECT_TRUE(
      leak_points(cube_mesh(), std::vector<Sphere>{{Vector3d::Constant(0.5), 0.9}}).empty());
  EXPECT_TRUE(leak_points(cube_mesh(), {}).empty());
}

TEST(LeakPointsTest, RefusesBadInput) {
  const std::vector<Sphere> sphere{{Vector3d::Zero(), 1.0}};
  EXPECT_THROW(leak_points({}, sphere), Error);
  EXPECT_THROW(leak_points(cube_mesh(), std::vector<Sphere>{{Vector3d::Zero(), -1.0}}), Error);
  for (const double share : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(leak_points(cube_mesh(), sphere, {.spacing = share}), Error);
    EXPECT_THROW(leak_points(cube_mesh(), sphere, {.separation = share}), Error);
  }
}

// Far from the origin the samples that are requested are closer than coordinates are to each other.
TEST(LeakPoints, PiecesThatRoundingCannotHalveAreNotHalved) {
  TriangleMesh mesh = cube_mesh();
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex.x() += 9e14;
  EXPECT_FALSE(leak_points(mesh, std::vector<Sphere>{{{5, 0, 0}, 0.3}}).empty());
}

}  // namespace
}  // namespace spherule::test
