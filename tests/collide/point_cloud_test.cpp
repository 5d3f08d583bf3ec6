// SPDX-License-Identifier: BSD-3-Clause
#include "collide/point_cloud.h"

#include "base/error.h"
#include "spheretree/check.h"
#include "tests/collide/exact_scene.h"
#include "tests/collide/scene_random.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> random_points(SceneRandom& random, int count, double size) {
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(random.point(size));
  return points;
}

// In rational numbers: |c - p| <= R - r.
bool contains_sphere(const Sphere& sphere, const Vector3d& point, double radius) {
  if ((sphere.center - point).norm() > sphere.radius * (1.0 + 1e-6)) return false;
  const Rational room = Rational(sphere.radius) - Rational(radius);
  return room >= 0 &&
         squared_distance(exact<Rational>(sphere.center), exact<Rational>(point)) <= room * room;
}

TEST(PointCloudTest, OneSphereForEveryPoint) {
  SceneRandom random(1);
  std::vector<Vector3d> points = random_points(random, 300, 2.0);
  const std::vector<Vector3d> twice = points;
  points.insert(points.end(), twice.begin(), twice.end());
  points.push_back({0.0, 0.0, 0.0});
  points.push_back({-0.0, 0.0, -0.0});
  const std::vector<Sphere> spheres = point_cloud_spheres(points, 0.25);
  ASSERT_EQ(spheres.size(), 301u);
  for (const Vector3d& point : points) {
    EXPECT_TRUE(std::any_of(spheres.begin(), spheres.end(), [&](const Sphere& sphere) {
      return sphere.center == point && sphere.radius == 0.25;
    }));
  }
}

TEST(PointCloudTest, CellsCoverTheSpheresOfTheirPoints) {
  SceneRandom random(2);
  for (int i = 0; i < effort(60, 4); ++i) {
    const double size = std::ldexp(1.0, random.whole(-30, 25));
    // Far from the origin as well, where cells are not much larger than what rounding leaves.
    const double far = random.whole(0, 1) * size * 1e6;
    const double voxel = size * std::ldexp(1.0, random.whole(-24, 2));
    const double radius = random.whole(0, 1) * size * random.uniform(0.0, 0.1);
    std::vector<Vector3d> points = random_points(random, 200, size);
    for (Vector3d& point : points) point += Vector3d(far, -far, far);
    const std::vector<Sphere> spheres = point_cloud_spheres(points, radius, {.voxel = voxel});
    ASSERT_LE(spheres.size(), points.size());
    std::vector<char> used(spheres.size(), 0);
    for (const Vector3d& point : points) {
      bool found = false;
      for (std::size_t k = 0; k < spheres.size(); ++k) {
        if (!contains_sphere(spheres[k], point, radius)) continue;
        found = true;
        used[k] = 1;
      }
      ASSERT_TRUE(found) << i;
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0);
    for (const Sphere& sphere : spheres) {
      ASSERT_LE(sphere.radius, radius + std::sqrt(0.75) * voxel + 1e-15 * (4.0 * far + 4.0 * size));
    }
    std::reverse(points.begin(), points.end());
    ASSERT_EQ(point_cloud_spheres(points, radius, {.voxel = voxel}), spheres);
  }
}

TEST(PointCloudTest, FewCellsForManyPoints) {
  SceneRandom random(3);
  const std::vector<Vector3d> points = random_points(random, 5000, 1.0);
  EXPECT_LE(point_cloud_spheres(points, 0.0, {.voxel = 0.5}).size(), 64u);
  EXPECT_EQ(point_cloud_spheres(points, 0.0, {.voxel = 1e-9}).size(), 5000u);
  EXPECT_LE(point_cloud_spheres(points, 0.0, {.voxel = 1e15}).size(), 8u);
  EXPECT_EQ(point_cloud_spheres(points, 0.0, {.voxel = 0x1p-1074}).size(), 5000u);
}

TEST(PointCloudTest, TheTreeIsOverTheSpheres) {
  SceneRandom random(4);
  const std::vector<Vector3d> points = random_points(random, 400, 1.0);
  const SphereTree tree = point_cloud_tree(points, 0.01, {.voxel = 0.1, .build = {.branching = 4}});
  EXPECT_TRUE(
      std::ranges::equal(tree.spheres(), point_cloud_spheres(points, 0.01, {.voxel = 0.1})));
  EXPECT_LE(tree.branching(), 4);
}

TEST(PointCloudTest, RefusesWhatIsNoCloud) {
  const std::vector<Vector3d> good = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  EXPECT_THROW(point_cloud_tree({}, 0.1), Error);
  for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity(), 2e15}) {
    EXPECT_THROW(point_cloud_tree(good, bad), Error);
    EXPECT_THROW(point_cloud_tree(good, 0.1, {.voxel = bad}), Error);
    if (bad == -1.0) continue;
    std::vector<Vector3d> points = good;
    points.push_back({0.0, bad, 0.0});
    try {
      point_cloud_tree(points, 0.1);
      FAIL();
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("point 2"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace spherule::test
