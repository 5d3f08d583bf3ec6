// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenes/work_cell.h"

#include "base/error.h"
#include "bench/checkers/workload.h"
#include "tests/support/mesh_facts.h"
#include "tests/support/shapes.h"
#include "tests/support/solids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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

// FNV-1a over the grid steps.
std::uint64_t hash(const std::vector<ArmPositions>& program) {
  std::uint64_t value = 14695981039346656037U;
  for (const ArmPositions& positions : program) {
    for (const double q : positions) {
      auto steps = static_cast<std::uint64_t>(static_cast<std::int64_t>(q * 0x1p20));
      for (int byte = 0; byte < 8; ++byte, steps >>= 8)
        value = (value ^ (steps & 255U)) * 1099511628211U;
    }
  }
  return value;
}

TEST(Program, IsTheSameEverywhere) {
  const auto [program, is_critical] = make_program(flange_from_wire());
  ASSERT_EQ(program.size(), kProgramSize);
  ASSERT_EQ(is_critical.size(), kProgramSize);
  for (const ArmPositions& positions : program) EXPECT_EQ(on_joint_grid(positions), positions);
  EXPECT_EQ(hash(program), 0xc9a7e55f6321b085U);
}

// The oracle on a part of the program; the benchmark queries it about all of it.
TEST(Program, HasTheWantedShareOfCollisions) {
  const Workload cell = make_paper_cell();
  std::vector<ArmPositions> sample;
  for (std::size_t i = 0; i < cell.program.size(); i += 7) sample.push_back(cell.program[i]);
  std::size_t collisions = 0;
  std::vector<std::size_t> by_body(cell.bodies.size(), 0);
  for (const std::uint32_t bits : Oracle(cell).touching_bodies(sample)) {
    collisions += bits != 0 ? 1 : 0;
    for (std::size_t i = 0; i < by_body.size(); ++i) by_body[i] += bits >> i & 1U;
  }
  const double share = static_cast<double>(collisions) / static_cast<double>(sample.size());
  EXPECT_GT(share, 0.11);
  EXPECT_LT(share, 0.15);
  for (const char* name : {"torch", "link_4", "link_5"}) {
    const auto body = std::find_if(cell.bodies.begin(), cell.bodies.end(),
                                   [&](const Body& b) { return b.part.name == name; });
    ASSERT_NE(body, cell.bodies.end());
    EXPECT_GT(by_body[static_cast<std::size_t>(body - cell.bodies.begin())], 0u) << name;
  }
}

// The makers of solids that the cell is built of.

struct Case {
  std::string name;
  TriangleMesh mesh;
  std::size_t triangles;
  double volume;     // of the ideal solid
  double tolerance;  // relative; chords cut corners
};

std::vector<Case> cases() {
  return {
      {"box", make_box({1.0, 2.0, 3.0}), 12, 6.0, 1e-9},
      {"cube", make_cube(2.0), 12, 8.0, 1e-9},
      {"sphere", make_sphere(2.0, 64, 32), 2 * 64 * 31, 4.0 / 3.0 * pi * 8.0, 0.01},
      {"torus", make_torus(3.0, 1.0, 64, 32), 2 * 64 * 32, 2.0 * pi * pi * 3.0, 0.01},
      {"cylinder", make_cylinder(1.0, 4.0, 64), 4 * 64 - 4, 4.0 * pi, 0.01},
      {"cone", make_cone(1.0, 3.0, 64), 2 * 64 - 2, pi, 0.01},
      {"pipe", make_pipe(40.0, 34.0, 300.0, 81), 8 * 81, pi * (400.0 - 289.0) * 300.0, 0.01},
      {"l_bracket", make_l_bracket(10.0, 4.0, 1.0), 20, 4.0 * 19.0, 1e-9},
      {"plate", make_plate_with_holes({20.0, 12.0, 2.0}, 4, 3, 1.0, 32),
       // Each face has corners - 2 + 2 holes triangles; each side of a loop has two more.
       2 * (4 + 12 * 32 - 2 + 2 * 12) + 2 * (4 + 12 * 32), 2.0 * (240.0 - 12.0 * pi / 4.0), 0.01},
  };
}

TEST(Shapes, AreClosedAndFaceOutwards) {
  for (const Case& c : cases()) {
    EXPECT_EQ(c.mesh.triangles.size(), c.triangles) << c.name;
    EXPECT_TRUE(is_closed(c.mesh)) << c.name;
    EXPECT_NEAR(signed_volume(c.mesh) / c.volume, 1.0, c.tolerance) << c.name;
    EXPECT_EQ(component_points(c.mesh).size(), 1u) << c.name;
    for (const Eigen::Vector3d& vertex : c.mesh.vertices) EXPECT_TRUE(vertex.allFinite()) << c.name;
  }
}

double area(const Loop& outer, const std::vector<Loop>& holes) {
  Loop points = outer;
  for (const Loop& hole : holes) points.insert(points.end(), hole.begin(), hole.end());
  double twice = 0.0;
  for (const Eigen::Vector3i& t : triangulate(outer, holes)) {
    const Eigen::Vector2d a = points[static_cast<std::size_t>(t[0])];
    const Eigen::Vector2d ab = points[static_cast<std::size_t>(t[1])] - a;
    const Eigen::Vector2d ac = points[static_cast<std::size_t>(t[2])] - a;
    const double cross = ab.x() * ac.y() - ab.y() * ac.x();
    EXPECT_GT(cross, 0.0);
    twice += cross;
  }
  return 0.5 * twice;
}

// All triangles face up and their areas add up: they neither overlap nor leave a hole uncut.
TEST(Polygon, TrianglesFillTheOutlineLessItsHoles) {
  const auto disc = [](double radius, int sides) {
    return 0.5 * sides * radius * radius * std::sin(2.0 * pi / sides);
  };
  const Loop outline = belt({0.0, 0.0}, 3.0, {8.0, 1.0}, 2.0, 10);
  const double whole = area(outline, {});
  std::vector<Loop> holes = screw_holes({0.0, 0.0}, 2.0, 8, 0.3, 6);
  EXPECT_NEAR(area(outline, holes), whole - 8 * disc(0.3, 6), 1e-6);
  holes.push_back(circle({0.0, 0.0}, 1.0, 24));
  holes.push_back(circle({8.0, 1.0}, 1.5, 7, 0.3));
  EXPECT_NEAR(area(outline, holes), whole - 8 * disc(0.3, 6) - disc(1.0, 24) - disc(1.5, 7), 1e-6);
  EXPECT_NEAR(area(rectangle({1.0, 2.0}, {4.0, 6.0}, 1.0, 16), {}), 24.0 - 4.0 + pi, 0.01);
}

TEST(Polygon, WrongLoopsAreRefused) {
  const Loop square = rectangle({0.0, 0.0}, {2.0, 2.0});
  EXPECT_THROW(triangulate({square.rbegin(), square.rend()}, {}), Error);
  EXPECT_THROW(triangulate(square, {circle({5.0, 0.0}, 0.5, 8)}), Error);
}

TEST(Solids, RefiningKeepsTheSolid) {
  TriangleMesh mesh = make_l_bracket(10.0, 4.0, 1.0);
  const double volume = signed_volume(mesh);
  refine_to(mesh, 500);
  EXPECT_EQ(mesh.triangles.size(), 500u);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(signed_volume(mesh), volume, 1e-9);
  EXPECT_THROW(refine_to(mesh, 501), Error);
  EXPECT_THROW(refine_to(mesh, 498), Error);
  mesh.triangles.pop_back();
  EXPECT_THROW(refine_to(mesh, 1999), Error);
}

}  // namespace
}  // namespace spherule
