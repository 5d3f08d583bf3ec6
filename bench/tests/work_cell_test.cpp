// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenes/robot.h"
#include "bench/scenes/table.h"
#include "bench/scenes/torch.h"
#include "bench/scenes/workpiece.h"
#include "tests/support/mesh_facts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace spherule {
namespace {

using std::numbers::pi;

bool has_repeated_corner(const Eigen::Vector3i& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

void expect_sound(const TriangleMesh& mesh, const std::string& name) {
  EXPECT_TRUE(is_closed(mesh)) << name;
  EXPECT_GT(signed_volume(mesh), 0.0) << name;
  const auto count = static_cast<int>(mesh.vertices.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    EXPECT_TRUE((t.array() >= 0).all() && (t.array() < count).all()) << name;
  }
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    for (const double coordinate : vertex) {
      ASSERT_TRUE(std::isfinite(coordinate)) << name;
      EXPECT_EQ(static_cast<double>(static_cast<float>(coordinate)), coordinate) << name;
      EXPECT_EQ(std::nearbyint(coordinate * 0x1p22), coordinate * 0x1p22) << name;
    }
  }
}

TEST(WorkCell, HasThePapersTriangleCounts) {
  std::size_t triangles = 0;
  std::size_t of_zero_area = 0;
  for (const TriangleMesh& link : make_robot_links()) {
    triangles += link.triangles.size();
    for (const Eigen::Vector3i& t : link.triangles) of_zero_area += has_repeated_corner(t) ? 1 : 0;
  }
  EXPECT_EQ(triangles, 6825u);
  EXPECT_EQ(of_zero_area, 1u);  // an odd number of triangles cannot be closed otherwise
  EXPECT_EQ(make_torch().triangles.size(), 4318u);
  EXPECT_EQ(make_workpiece().triangles.size(), 1942u);
}

TEST(WorkCell, IsMadeOfClosedSolids) {
  const auto links = make_robot_links();
  for (std::size_t i = 0; i < links.size(); ++i)
    expect_sound(links[i], "link " + std::to_string(i));
  expect_sound(make_torch(), "torch");
  expect_sound(make_workpiece(), "workpiece");
  expect_sound(make_table(), "table");
}

// Boxes of the real robot's visual meshes, in metres.
TEST(WorkCell, LinksAreAboutAsLargeAsTheRealOnes) {
  const double real[][3] = {{0.92, 0.642, 0.22},   {0.964, 0.959, 0.711}, {0.331, 0.245, 1.111},
                            {0.702, 0.373, 0.372}, {1.249, 0.251, 0.232}, {0.190, 0.067, 0.153},
                            {0.204, 0.125, 0.125}};
  const auto links = make_robot_links();
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Eigen::Vector3d size = bounding_box(links[i]).sizes();
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(size[k], real[i][k], 0.15) << "link " << i;
  }
}

TEST(WorkCell, TheWorkpieceIsHollowThroughout) {
  const TriangleMesh mesh = make_workpiece();
  const double in_wall = 0.5 * (kPipeRadius + kPipeBoreRadius);
  EXPECT_NEAR(winding_number(mesh, {0.0, 0.0, 0.0}), 0.0, 1e-9);
  for (int pipe = 0; pipe < 3; ++pipe) {
    for (const double distance : {0.03, 0.1, 0.25}) {
      const Eigen::Vector3d center = distance * pipe_axis(pipe);
      const Eigen::Vector3d up(0.0, 0.0, in_wall);
      EXPECT_NEAR(winding_number(mesh, center), 0.0, 1e-9);
      EXPECT_NEAR(winding_number(mesh, center + up), 1.0, 1e-9);
      EXPECT_NEAR(winding_number(mesh, center + 1.2 * up), 0.0, 1e-9);
    }
  }
}

TEST(WorkCell, SeamsLieWherePipesMeet) {
  const TriangleMesh mesh = make_workpiece();
  for (int pipe = 0; pipe < 3; ++pipe) {
    for (const double angle : {0.0, 0.3, 0.8, 1.2, 0.5 * pi}) {
      const SeamPoint seam = seam_point(pipe, angle);
      for (const int of : {pipe, (pipe + 1) % 3}) {
        const Eigen::Vector3d axis = pipe_axis(of);
        EXPECT_NEAR((seam.point - seam.point.dot(axis) * axis).norm(), kPipeRadius, 1e-12);
      }
      // A millimetre off along the mean normal is outside, a millimetre deep is in the wall; chords
      // of the mesh stay within 0.03 mm of the cylinder.
      const Eigen::Vector3d normal = (seam.normal_a + seam.normal_b).normalized();
      EXPECT_NEAR(winding_number(mesh, seam.point + 0.001 * normal), 0.0, 1e-6);
      EXPECT_NEAR(winding_number(mesh, seam.point - 0.001 * normal), 1.0, 1e-6);
    }
  }
}

TEST(WorkCell, TheTorchEndsWithItsWire) {
  const TriangleMesh torch = make_torch();
  const Pose wire = flange_from_wire();
  double furthest = -1.0;
  double beside = 0.0;
  for (const Eigen::Vector3d& vertex : torch.vertices) {
    const Eigen::Vector3d in_wire = wire.inverse() * vertex;
    furthest = std::max(furthest, in_wire.z());
    if (in_wire.z() > -0.01) beside = std::max(beside, in_wire.head<2>().norm());
  }
  EXPECT_NEAR(furthest, 0.0, 1e-6);
  EXPECT_NEAR(beside, 0.0006, 1e-6);
}

}  // namespace
}  // namespace spherule
