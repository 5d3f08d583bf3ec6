// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "simplifier/leaks.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

double area_of(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    area += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  return area;
}

// A sphere about the middle of the unit cube covers a disc of each face.
TEST(LeakSurfaceTest, IsTheCubeWithoutADiscOfEachFace) {
  for (const double radius : {0.52, 0.6, 0.7}) {
    const LeakSurface leaks =
        leak_surface(cube_mesh(), std::vector<Sphere>{{Vector3d::Constant(0.5), radius}});
    const double disc = std::numbers::pi * (radius * radius - 0.25);
    EXPECT_NEAR(area_of(leaks.mesh), 6.0 * (1.0 - disc), 1e-3) << radius;
    ASSERT_EQ(leaks.depths.size(), leaks.mesh.vertices.size());
    for (std::size_t i = 0; i < leaks.depths.size(); ++i) {
      const Vector3d& point = leaks.mesh.vertices[i];
      // On a face, as deep as it is told; what is interpolated is not far off.
      EXPECT_LT(std::min(point.minCoeff(), 1.0 - point.maxCoeff()), 1e-12);
      const double depth = (point - Vector3d::Constant(0.5)).norm() - radius;
      EXPECT_NEAR(leaks.depths[i], depth, leaks.depths[i] > 0.0 ? 1e-12 : 1e-4);
    }
    for (const Eigen::Vector3i& t : leaks.mesh.triangles) {
      const auto corner = [&](int k) {
        return leaks.mesh.vertices[static_cast<std::size_t>(t[k])];
      };
      const Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
      const Vector3d middle = (corner(0) + corner(1) + corner(2)) / 3.0;
      EXPECT_GE(normal.dot(middle - Vector3d::Constant(0.5)), 0.0);
    }
  }
}

TEST(LeakSurfaceTest, NoneWhereAllIsCoveredOrNothingIs) {
  const std::vector<Sphere> covering{{Vector3d::Constant(0.5), 0.9}};
  EXPECT_TRUE(leak_surface(cube_mesh(), covering).mesh.triangles.empty());
  EXPECT_TRUE(leak_surface(cube_mesh(), {}).mesh.triangles.empty());
}

TEST(LeakSurfaceTest, RefusesBadInput) {
  const std::vector<Sphere> sphere{{Vector3d::Zero(), 1.0}};
  EXPECT_THROW(leak_surface({}, sphere), Error);
  for (const double share : {0.0, -1.0, std::nan("")}) {
    EXPECT_THROW(leak_surface(cube_mesh(), sphere, {.spacing = share}), Error);
  }
}

}  // namespace
}  // namespace spherule::test
