// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/decimation.h"

#include "base/error.h"
#include "geometry/mesh_report.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace spherule::test {
namespace {

bool holds(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  return std::find(mesh.vertices.begin(), mesh.vertices.end(), point) != mesh.vertices.end();
}

TEST(Decimation, ReachesTheTargetWithVerticesOfTheOriginal) {
  const TriangleMesh mesh = torus(1.0, 0.3, 40, 20);
  const Decimation half = decimate(mesh, {.target_triangles = mesh.triangles.size() / 2});
  EXPECT_LE(half.mesh.triangles.size(), mesh.triangles.size() / 2);
  EXPECT_GE(half.mesh.triangles.size(), mesh.triangles.size() / 2 - 4);
  for (const Eigen::Vector3d& v : half.mesh.vertices) EXPECT_TRUE(holds(mesh, v));
  EXPECT_GT(half.estimated_error, 0.0);
  EXPECT_GT(half.deviation.loss.lower, 0.0);  // a bulge was cut off: not conservative
  EXPECT_LE(half.deviation.loss.upper, 0.05);
  EXPECT_LE(half.deviation.excess.upper, 0.05);
  const double ratio = mesh_report(half.mesh, {}).volume / mesh_report(mesh, {}).volume;
  EXPECT_NEAR(ratio, 1.0, 0.03);
}

TEST(Decimation, ClosedMeshesStayClosed) {
  int closed = 0;
  for (const NamedMesh& named : mesh_zoo()) {
    if (!mesh_report(named.mesh, {.self_intersections = false}).closed) continue;
    // Of few triangles nothing may be left, which is an Error.
    if (named.mesh.triangles.size() < 100) continue;
    for (const std::size_t divisor : {2U, 5U, 20U}) {
      SCOPED_TRACE(testing::Message() << named.name << " / " << divisor);
      DecimationOptions options;
      options.target_triangles = std::max<std::size_t>(4, named.mesh.triangles.size() / divisor);
      options.measure.reset();
      const Decimation result = decimate(named.mesh, options);
      EXPECT_TRUE(mesh_report(result.mesh, {.self_intersections = false}).closed);
      ++closed;
    }
  }
  EXPECT_GT(closed, 8);
}

TEST(Decimation, WhatIsFlatCostsNothingAndIsMeasuredAsSuch) {
  // A box of many coplanar triangles comes down to few without any loss.
  TriangleMesh fine = cube_mesh();
  for (int round = 0; round < 3; ++round) {
    TriangleMesh next;
    for (const Eigen::Vector3i& t : fine.triangles) {
      const auto corner = [&](int k) { return fine.vertices[static_cast<std::size_t>(t[k])]; };
      const Eigen::Vector3d a = corner(0), b = corner(1), c = corner(2);
      const Eigen::Vector3d ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
      for (const auto& piece : {std::array{a, ab, ca}, std::array{b, bc, ab}, std::array{c, ca, bc},
                                std::array{ab, bc, ca}}) {
        Eigen::Vector3i triangle;
        for (int k = 0; k < 3; ++k) {
          const auto found = std::find(next.vertices.begin(), next.vertices.end(),
                                       piece[static_cast<std::size_t>(k)]);
          triangle[k] = static_cast<int>(found - next.vertices.begin());
          if (found == next.vertices.end()) {
            next.vertices.push_back(piece[static_cast<std::size_t>(k)]);
          }
        }
        next.triangles.push_back(triangle);
      }
    }
    fine = next;
  }
  const Decimation result = decimate(fine, {.max_error = 1e-4});
  EXPECT_LE(result.mesh.triangles.size(), 60U);
  EXPECT_LE(result.estimated_error, 1e-4);
  EXPECT_LE(result.deviation.loss.lower, 1e-12);
  EXPECT_LE(result.deviation.loss.upper, 2e-3);
  EXPECT_NEAR(mesh_report(result.mesh, {}).volume, 1.0, 1e-12);
}

TEST(Decimation, ASmallerErrorKeepsMoreTriangles) {
  std::size_t before = 0;
  for (const double error : {0.1, 0.01, 0.001, 0.0}) {
    const Decimation result = decimate(icosphere(3), {.max_error = error, .measure = std::nullopt});
    EXPECT_LE(result.estimated_error, error * 1.0001);
    EXPECT_GE(result.mesh.triangles.size(), before);
    before = result.mesh.triangles.size();
  }
  EXPECT_GE(before, 1000U);
}

TEST(Decimation, BadInputIsRefused) {
  EXPECT_THROW(decimate(TriangleMesh{}, {}), Error);
  EXPECT_THROW(decimate(cube_mesh(), {.target_triangles = 0}), Error);
  EXPECT_THROW(decimate(cube_mesh(), {.max_error = -1.0}), Error);
  EXPECT_THROW(decimate(cube_mesh(), {.max_error = std::nan("")}), Error);
  TriangleMesh point;
  point.vertices.assign(3, Eigen::Vector3d::Ones());
  point.triangles.emplace_back(0, 1, 2);
  EXPECT_THROW(decimate(point, {}), Error);
}

}  // namespace
}  // namespace spherule::test
