// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mesh_report.h"

#include "base/error.h"
#include "geometry/self_intersection.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace spherule {
namespace {

TEST(MeshReport, SolidsOfTheZooAreClosedAndFaceOutwards) {
  const double pi = std::numbers::pi;
  struct Solid {
    TriangleMesh mesh;
    double volume, tolerance;
  };
  for (const Solid& solid :
       {Solid{test::cube_mesh(2.0), 8.0, 1e-12}, Solid{test::icosphere(4), 4.0 / 3.0 * pi, 0.02},
        Solid{test::torus(1.0, 0.3, 96, 48), 2 * pi * pi * 0.09, 0.01},
        Solid{test::pipe(0.5, 0.4, 2.0, 96), 2 * pi * 0.09, 0.001},
        Solid{test::l_bracket(), 0.18, 1e-12}, Solid{test::thin_sheet(1e-4), 1e-4, 1e-12},
        Solid{test::needles(8), 2.0 / 3.0 * 2 * std::sqrt(2.0) * 1e-4, 1e-9}}) {
    const MeshReport report = mesh_report(solid.mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.boundary_edges + report.non_manifold_edges + report.misoriented_edges, 0u);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.inverted_components + report.degenerate_triangles, 0u);
    EXPECT_EQ(report.duplicate_triangles + report.self_intersections, 0u);
    EXPECT_NEAR(report.volume, solid.volume, solid.tolerance);
  }
}

TEST(MeshReport, Cube) {
  const MeshReport report = mesh_report(test::cube_mesh(2.0));
  EXPECT_EQ(report.vertices, 8u);
  EXPECT_EQ(report.triangles, 12u);
  EXPECT_DOUBLE_EQ(report.area, 24.0);
  EXPECT_EQ(report.box.min(), Eigen::Vector3d::Zero());
  EXPECT_EQ(report.box.max(), Eigen::Vector3d::Constant(2.0));
}

TEST(MeshReport, VerticesAreComparedByTheirCoordinates) {
  TriangleMesh apart;  // every triangle with corners of its own
  const TriangleMesh cube = test::cube_mesh();
  for (const Eigen::Vector3i& t : cube.triangles) {
    for (int k = 0; k < 3; ++k) {
      // Half of the zeros negative.
      const double sign = apart.vertices.size() % 2 == 0 ? 1.0 : -0.0;
      const Eigen::Vector3d v = cube.vertices[static_cast<std::size_t>(t[k])];
      apart.vertices.push_back(v.unaryExpr([=](double x) { return x == 0.0 ? 0.0 * sign : x; }));
    }
    const int n = static_cast<int>(apart.vertices.size());
    apart.triangles.emplace_back(n - 3, n - 2, n - 1);
  }
  apart.vertices.emplace_back(50, 50, 50);  // used by no triangle
  const MeshReport report = mesh_report(apart);
  EXPECT_EQ(report.vertices, 8u);
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.box.max(), Eigen::Vector3d::Ones());
}

TEST(MeshReport, OpenBox) {
  const MeshReport report = mesh_report(test::open_box());
  EXPECT_FALSE(report.closed);
  EXPECT_EQ(report.boundary_edges, 4u);
  EXPECT_EQ(report.inverted_components, 0u);
}

TEST(MeshReport, Inverted) {
  const MeshReport report = mesh_report(test::inverted(test::cube_mesh()));
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.inverted_components, 1u);
  EXPECT_DOUBLE_EQ(report.volume, -1.0);
}

TEST(MeshReport, NestedShells) {
  const MeshReport report = mesh_report(test::nested_shells(3));
  EXPECT_TRUE(report.closed);
  EXPECT_EQ(report.components, 3u);
  EXPECT_EQ(report.inverted_components, 1u);
  EXPECT_EQ(report.self_intersections, 0u);
}

TEST(MeshReport, OneTriangleTurned) {
  TriangleMesh mesh = test::cube_mesh();
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  const MeshReport report = mesh_report(mesh);
  EXPECT_FALSE(report.closed);
  EXPECT_EQ(report.misoriented_edges, 3u);
  EXPECT_EQ(report.boundary_edges, 0u);
}

TEST(MeshReport, KleinBottleHasNoBoundaryAndNoInside) {
  const MeshReport report = mesh_report(test::klein_bottle(16, 24));
  EXPECT_FALSE(report.closed);
  EXPECT_EQ(report.boundary_edges, 0u);
  EXPECT_EQ(report.non_manifold_edges, 0u);
  EXPECT_GT(report.misoriented_edges, 0u);
  EXPECT_GT(report.self_intersections, 0u);
}

TEST(MeshReport, ThreeFins) {
  const MeshReport report = mesh_report(test::three_fins());
  EXPECT_EQ(report.non_manifold_edges, 1u);
  EXPECT_EQ(report.boundary_edges, 6u);
  EXPECT_FALSE(report.closed);
}

TEST(MeshReport, DuplicatesCountFromTheSecondInEitherOrientation) {
  const TriangleMesh cube = test::cube_mesh();
  const MeshReport twice = mesh_report(test::with_duplicates(cube));
  EXPECT_EQ(twice.duplicate_triangles, 12u);
  EXPECT_EQ(twice.non_manifold_edges, 18u);
  EXPECT_TRUE(twice.closed);
  const MeshReport both_sides = mesh_report(test::joined(cube, test::inverted(cube)));
  EXPECT_EQ(both_sides.duplicate_triangles, 12u);
  EXPECT_TRUE(both_sides.closed);
  EXPECT_NEAR(both_sides.volume, 0.0, 1e-15);
  EXPECT_EQ(both_sides.inverted_components, 0u);
}

TEST(MeshReport, DegenerateTriangles) {
  const MeshReport report = mesh_report(test::with_degenerates(test::cube_mesh()));
  EXPECT_EQ(report.degenerate_triangles, 3u);
  // Repeated corners cancel; the collinear triangle has an open edge at its middle corner.
  EXPECT_FALSE(report.closed);
  TriangleMesh repeated = test::cube_mesh();
  repeated.triangles.emplace_back(0, 1, 1);
  repeated.triangles.emplace_back(4, 4, 4);
  EXPECT_TRUE(mesh_report(repeated).closed);
  EXPECT_EQ(mesh_report(repeated).degenerate_triangles, 2u);
  EXPECT_EQ(mesh_report(repeated).non_manifold_edges, 0u);
}

TEST(MeshReport, SelfIntersections) {
  const Eigen::Isometry3d into(Eigen::Translation3d(0.5, 0.5, 0.5));
  const TriangleMesh cube = test::cube_mesh();
  EXPECT_GT(mesh_report(test::joined(cube, test::moved(cube, into))).self_intersections, 6u);
  const Eigen::Isometry3d beside(Eigen::Translation3d(1.5, 0, 0));
  EXPECT_EQ(mesh_report(test::joined(cube, test::moved(cube, beside))).self_intersections, 0u);
  // Face against face: two and two triangles that lie in one plane, shifted to share no vertex.
  const Eigen::Isometry3d touching(Eigen::Translation3d(1.0, 0.25, 0.25));
  EXPECT_GE(mesh_report(test::joined(cube, test::moved(cube, touching))).self_intersections, 4u);
}

// Independent of the separating axes: two triangles meet exactly if an edge of one pierces the
// other (random triangles are never in one plane).
bool edge_pierces(const internal::Corners& a, const internal::Corners& b) {
  const auto volume = [](const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                         const Eigen::Vector3d& r,
                         const Eigen::Vector3d& s) { return (q - p).cross(r - p).dot(s - p); };
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d &p = a[k], &q = a[(k + 1) % 3];
    if (volume(b[0], b[1], b[2], p) * volume(b[0], b[1], b[2], q) > 0.0) continue;
    const double s = volume(p, q, b[0], b[1]), t = volume(p, q, b[1], b[2]),
                 u = volume(p, q, b[2], b[0]);
    if ((s >= 0 && t >= 0 && u >= 0) || (s <= 0 && t <= 0 && u <= 0)) return true;
  }
  return false;
}

TEST(SelfIntersection, AgreesWithPiercingEdges) {
  test::Random random(17);
  const Eigen::AlignedBox3d cube(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
  int meeting = 0;
  for (int i = 0; i < 100000; ++i) {
    internal::Corners a, b;
    for (Eigen::Vector3d& v : a) v = random.in_box(cube);
    for (Eigen::Vector3d& v : b) v = random.in_box(cube);
    const bool expected = edge_pierces(a, b) || edge_pierces(b, a);
    meeting += expected;
    ASSERT_EQ(internal::triangles_meet(a, b), expected) << i;
  }
  EXPECT_GT(meeting, 10000);
}

TEST(SelfIntersection, HierarchyFindsAllPairs) {
  const TriangleMesh soup = test::soup(400, 23);
  std::size_t expected = 0;
  const auto corners = [&](std::size_t i) {
    const auto at = [&](int k) {
      return soup.vertices[static_cast<std::size_t>(soup.triangles[i][k])];
    };
    return internal::Corners{at(0), at(1), at(2)};
  };
  for (std::size_t i = 0; i < 400; ++i) {
    for (std::size_t j = i + 1; j < 400; ++j) {
      expected += internal::triangles_meet(corners(i), corners(j));
    }
  }
  EXPECT_GT(expected, 100u);
  const internal::SelfIntersections all = internal::count_self_intersections(soup, 1'000'000);
  EXPECT_EQ(all.pairs, expected);
  EXPECT_FALSE(all.stopped);
  const internal::SelfIntersections some = internal::count_self_intersections(soup, 100);
  EXPECT_EQ(some.pairs, 100u);
  EXPECT_TRUE(some.stopped);
}

// Every two triangles of a fan lie side by side, 50 million pairs here.
TEST(SelfIntersection, OfAFanIsNotLookedForAmongAllPairs) {
  TriangleMesh fan{{{0, 0, 0}, {1, 0, 0}}, {}};
  for (int i = 0; i < 10'000; ++i) {
    fan.vertices.emplace_back(1.0, i + 1.0, 0.0);
    fan.triangles.emplace_back(0, i + 1, i + 2);
  }
  MeshReport report = mesh_report(fan);
  EXPECT_EQ(report.self_intersections, 0u);
  EXPECT_TRUE(report.self_intersections_stopped);
  EXPECT_NE(describe(report).find("too many lie side by side to examine them all"),
            std::string::npos);
  report.self_intersections = 7;
  EXPECT_NE(describe(report).find("7 pairs or more of triangles"), std::string::npos);
}

TEST(Validate, NamesSubjectAndFault) {
  const auto refused = [](const TriangleMesh& mesh, const std::string& why) {
    try {
      validate(mesh, "part");
    } catch (const Error& error) {
      return error.subject() == "part" && error.reason().find(why) != std::string::npos;
    }
    return false;
  };
  for (const test::NamedMesh& entry : test::mesh_zoo()) {
    EXPECT_NO_THROW(validate(entry.mesh, "zoo")) << entry.name;
  }
  EXPECT_TRUE(refused(TriangleMesh(), "no triangles"));
  TriangleMesh mesh = test::cube_mesh();
  mesh.vertices[5].y() = std::nan("");
  EXPECT_TRUE(refused(mesh, "vertex 5 has a coordinate that is not finite"));
  mesh.vertices[5].y() = -1.1e15;
  EXPECT_TRUE(refused(mesh, "beyond 1e15"));
  mesh = test::cube_mesh();
  mesh.triangles[3][1] = 8;
  EXPECT_TRUE(refused(mesh, "triangle 3"));
  mesh.triangles[3][1] = -1;
  EXPECT_TRUE(refused(mesh, "triangle 3"));
  for (const double bad : {-1.0, std::nan(""), HUGE_VAL}) {
    mesh = test::cube_mesh();
    mesh.vertex_error = bad;
    EXPECT_TRUE(refused(mesh, "vertex error"));
  }
}

TEST(Describe, MentionsEverythingUnusual) {
  const std::string cube = describe(mesh_report(test::cube_mesh()));
  EXPECT_NE(cube.find("12 triangles, 8 vertices, one piece"), std::string::npos) << cube;
  EXPECT_NE(cube.find("volume 1"), std::string::npos);
  EXPECT_EQ(std::count(cube.begin(), cube.end(), '\n'), 1);
  const std::string open = describe(mesh_report(test::open_box()));
  EXPECT_NE(open.find("not closed"), std::string::npos);
  EXPECT_NE(open.find("4 edges with a triangle on one side only"), std::string::npos);
  EXPECT_EQ(open.find("volume"), open.find("volume, only"));
  const std::string worst = describe(mesh_report(test::with_degenerates(test::with_duplicates(
      test::joined(test::inverted(test::cube_mesh()), test::klein_bottle(8, 8))))));
  for (const char* word : {"without area", "there before", "more than two", "intersect without"}) {
    EXPECT_NE(worst.find(word), std::string::npos) << word << " in " << worst;
  }
}

}  // namespace
}  // namespace spherule
