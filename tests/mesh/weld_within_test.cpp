// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "geometry/mesh_report.h"
#include "io/mesh_io.h"
#include "io/placement.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

// Every triangle with vertices of its own, each moved by up to `crack`.
TriangleMesh cracked(const TriangleMesh& mesh, double crack, unsigned seed) {
  Random random(seed);
  TriangleMesh result;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto first = static_cast<int>(result.vertices.size());
    for (const int v : t) {
      result.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)] +
                                crack * random.unit() * random.direction());
    }
    result.triangles.emplace_back(first, first + 1, first + 2);
  }
  return result;
}

double greatest_move(const TriangleMesh& a, const TriangleMesh& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const Vector3d& p = a.vertices[static_cast<std::size_t>(a.triangles[i][k])];
      const Vector3d& q = b.vertices[static_cast<std::size_t>(b.triangles[i][k])];
      most = std::max(most, (p - q).norm());
    }
  }
  return most;
}

TEST(WeldWithin, ShutsCracksAndMovesNoCornerFurtherThanItSays) {
  for (const char* name : {"icosphere", "torus"}) {
    SCOPED_TRACE(name);
    const TriangleMesh whole =
        name == std::string("torus") ? torus(1.0, 0.3, 24, 12) : icosphere(3);
    constexpr double kCrack = 1e-5;
    const TriangleMesh broken = cracked(whole, kCrack, 5);
    ASSERT_FALSE(mesh_report(broken).closed);
    const double tolerance = 2.0 * kCrack;
    const TriangleMesh shut = internal::weld_within(broken, tolerance);
    EXPECT_TRUE(mesh_report(shut).closed);
    EXPECT_EQ(shut.vertices.size(), whole.vertices.size());
    ASSERT_EQ(shut.triangles.size(), broken.triangles.size());
    EXPECT_LE(greatest_move(broken, shut), tolerance);
    EXPECT_GE(shut.vertex_error, tolerance);
    EXPECT_LE(shut.vertex_error, 1.001 * tolerance);
  }
}

// A chain of vertices, each within reach of the next, is not drawn together to its end.
TEST(WeldWithin, AChainIsNotDrawnTogether) {
  TriangleMesh fan;
  for (int i = 0; i < 40; ++i) {
    const auto first = static_cast<int>(fan.vertices.size());
    fan.vertices.insert(fan.vertices.end(), {Vector3d(0.6 * i, 0.0, 0.0), Vector3d(0.0, 50.0, 0.0),
                                             Vector3d(0.0, 0.0, 50.0)});
    fan.triangles.emplace_back(first, first + 1, first + 2);
  }
  const TriangleMesh welded = internal::weld_within(fan, 1.0);
  ASSERT_EQ(welded.triangles.size(), fan.triangles.size());
  EXPECT_LE(greatest_move(fan, welded), 1.0);
  EXPECT_EQ(welded.vertices.size(), 20U + 2U);
}

TEST(WeldWithin, KeepsTrianglesThatLoseTheirArea) {
  const TriangleMesh mesh = icosphere(1);
  const TriangleMesh point = internal::weld_within(mesh, 10.0);
  EXPECT_EQ(point.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(point.vertices.size(), 1U);
}

// No cracks are so fine that the search for them would run out of whole numbers.
TEST(WeldWithin, AVeryFineToleranceDoesNothing) {
  const TriangleMesh mesh = icosphere(2);
  EXPECT_EQ(internal::weld_within(mesh, 1e-300).vertices.size(), mesh.vertices.size());
  EXPECT_EQ(internal::weld_within(mesh, 0.0).vertex_error, mesh.vertex_error);
}

TEST(WeldWithin, IsAnOptionOfReading) {
  const TempDir folder;
  const std::filesystem::path file = folder.path() / "cracked.stl";
  write_stl(cracked(icosphere(2), 1e-4, 9), file);
  EXPECT_FALSE(mesh_report(read_mesh(file)).closed);
  const TriangleMesh shut = read_mesh(file, {.scale = 1000.0, .weld = 0.3});
  EXPECT_TRUE(mesh_report(shut).closed);
  EXPECT_GE(shut.vertex_error, 0.3);
  for (const double bad : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(read_mesh(file, {.weld = bad}), Error);
  }
}

}  // namespace
}  // namespace spherule::test
