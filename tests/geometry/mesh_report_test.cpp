// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "geometry/self_intersection.h"
#include "geometry/triangle_mesh.h"
#include "tests/support/exact/shapes.h"
#include "tests/support/random_scene.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace spherule::test {
namespace {

TEST(MeshReport, SolidsOfTheZooAreClosedAndFaceOutwards) {
  const double pi = std::numbers::pi;
  struct Solid {
    TriangleMesh mesh;
    double volume, tolerance;
  };
  for (const Solid& solid :
       {Solid{cube_mesh(2.0), 8.0, 1e-12}, Solid{icosphere(4), 4.0 / 3.0 * pi, 0.02},
        Solid{torus(1.0, 0.3, 96, 48), 2 * pi * pi * 0.09, 0.01},
        Solid{pipe(0.5, 0.4, 2.0, 96), 2 * pi * 0.09, 0.001}, Solid{l_bracket(), 0.18, 1e-12},
        Solid{thin_sheet(1e-4), 1e-4, 1e-12},
        Solid{needles(8), 2.0 / 3.0 * 2 * std::sqrt(2.0) * 1e-4, 1e-9}}) {
    const MeshReport report = mesh_report(solid.mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.boundary_edges + report.non_manifold_edges + report.misoriented_edges, 0u);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.inverted_components + report.degenerate_triangles, 0u);
    EXPECT_EQ(report.duplicate_triangles + report.self_intersections, 0u);
    EXPECT_NEAR(report.volume, solid.volume, solid.tolerance);
  }
}

TEST(MeshReport, CountsWhatIsUnusual) {
  TriangleMesh turned = cube_mesh();
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  struct Case {
    const char* name;
    TriangleMesh mesh;
    bool closed;
    std::size_t boundary, non_manifold, misoriented, components, inverted;
    double area;
  };
  for (const Case& expected : {Case{"cube", cube_mesh(2.0), true, 0, 0, 0, 1, 0, 24.0},
                               Case{"open box", open_box(), false, 4, 0, 0, 1, 0, 5.0},
                               Case{"inverted", inverted(cube_mesh()), true, 0, 0, 0, 1, 1, 6.0},
                               Case{"shells", nested_shells(3), true, 0, 0, 0, 3, 1,
                                    6.0 * (1.0 + 121.0 / 225.0 + 49.0 / 225.0)},
                               Case{"one triangle turned", turned, true, 0, 0, 3, 1, 0, 6.0}}) {
    SCOPED_TRACE(expected.name);
    const MeshReport report = mesh_report(expected.mesh);
    EXPECT_EQ(report.closed, expected.closed);
    EXPECT_EQ(report.boundary_edges, expected.boundary);
    EXPECT_EQ(report.non_manifold_edges, expected.non_manifold);
    EXPECT_EQ(report.misoriented_edges, expected.misoriented);
    EXPECT_EQ(report.components, expected.components);
    EXPECT_EQ(report.inverted_components, expected.inverted);
    EXPECT_NEAR(report.area, expected.area, 1e-12);
    EXPECT_EQ(report.self_intersections, 0u);
  }
  const MeshReport fins = mesh_report(three_fins());
  EXPECT_FALSE(fins.closed);
  EXPECT_EQ(fins.non_manifold_edges, 1u);
  EXPECT_EQ(fins.boundary_edges, 6u);
  const MeshReport plane = mesh_report(projective_plane());
  EXPECT_FALSE(plane.closed);
  EXPECT_EQ(plane.boundary_edges + plane.non_manifold_edges, 0u);
  EXPECT_GT(plane.misoriented_edges, 0u);
}

TEST(MeshReport, VerticesAreComparedByTheirCoordinates) {
  TriangleMesh apart;  // every triangle with corners of its own
  const TriangleMesh cube = cube_mesh();
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

TEST(MeshReport, DuplicatesCountFromTheSecondInEitherOrientation) {
  const TriangleMesh cube = cube_mesh();
  const MeshReport twice = mesh_report(with_duplicates(cube));
  EXPECT_EQ(twice.duplicate_triangles, 12u);
  EXPECT_EQ(twice.non_manifold_edges, 18u);
  EXPECT_TRUE(twice.closed);
  const MeshReport both_sides = mesh_report(joined(cube, inverted(cube)));
  EXPECT_EQ(both_sides.duplicate_triangles, 12u);
  EXPECT_TRUE(both_sides.closed);
  EXPECT_NEAR(twice.volume, 1.0, 1e-15);
  EXPECT_NEAR(both_sides.volume, 1.0, 1e-15);
  EXPECT_EQ(both_sides.inverted_components, 0u);
}

// The inside is all that is shut in, whichever way triangles are turned.
TEST(MeshReport, TheVolumeDoesNotDependOnHowTrianglesAreTurned) {
  const TriangleMesh cube = cube_mesh();
  const TriangleMesh within =
      box_mesh(Eigen::Vector3d::Constant(0.25), Eigen::Vector3d::Ones() * 0.5);
  const TriangleMesh upon = box_mesh({0.25, 0.25, 1.0}, {0.5, 0.5, 1.5});
  const TriangleMesh beside = box_mesh({1, 0, 0}, {2, 1, 1});
  struct Case {
    const char* name;
    TriangleMesh mesh;
    double volume;
  };
  for (const Case& c :
       {Case{"one", cube, 1.0}, Case{"a hollow", joined(cube, inverted(within)), 1.0},
        Case{"a body within", joined(cube, within), 1.0},
        Case{"one upon the other", joined(cube, upon), 1.0 + 1.0 / 32.0},
        Case{"apart", joined(cube, moved(cube, Eigen::Isometry3d(Eigen::Translation3d(3, 0, 0)))),
             2.0},
        Case{"with a face in common", joined(cube, beside), 2.0}}) {
    SCOPED_TRACE(c.name);
    Random random(5);
    for (int round = 0; round < 8; ++round) {
      TriangleMesh mesh = round % 2 == 0 ? c.mesh : joined(c.mesh, inverted(c.mesh));
      for (Eigen::Vector3i& t : mesh.triangles) {
        if (round > 1 && random.unit() < 0.5) std::swap(t[0], t[1]);
      }
      const MeshReport report = mesh_report(mesh);
      EXPECT_TRUE(report.closed) << round;
      EXPECT_NEAR(report.volume, c.volume, 1e-12) << round;
    }
  }
  // Sheets have no inside, on however many sides they are drawn.
  const TriangleMesh open = open_box();
  EXPECT_FALSE(mesh_report(joined(open, inverted(open))).closed);
  EXPECT_EQ(mesh_report(joined(open, inverted(open))).volume, 0.0);
}

TEST(MeshReport, DegenerateTriangles) {
  const MeshReport report = mesh_report(with_degenerates(cube_mesh()));
  EXPECT_EQ(report.degenerate_triangles, 3u);
  // Repeated corners cancel; the collinear triangle has an open edge at its middle corner.
  EXPECT_FALSE(report.closed);
  TriangleMesh repeated = cube_mesh();
  repeated.triangles.emplace_back(0, 1, 1);
  repeated.triangles.emplace_back(4, 4, 4);
  EXPECT_TRUE(mesh_report(repeated).closed);
  EXPECT_EQ(mesh_report(repeated).degenerate_triangles, 2u);
  EXPECT_EQ(mesh_report(repeated).non_manifold_edges, 0u);
}

TEST(MeshReport, SelfIntersections) {
  const Eigen::Isometry3d into(Eigen::Translation3d(0.5, 0.5, 0.5));
  const TriangleMesh cube = cube_mesh();
  EXPECT_GT(mesh_report(joined(cube, moved(cube, into))).self_intersections, 6u);
  const Eigen::Isometry3d beside(Eigen::Translation3d(1.5, 0, 0));
  EXPECT_EQ(mesh_report(joined(cube, moved(cube, beside))).self_intersections, 0u);
  // Face against face: two and two triangles that lie in one plane, shifted to share no vertex.
  const Eigen::Isometry3d touching(Eigen::Translation3d(1.0, 0.25, 0.25));
  EXPECT_GE(mesh_report(joined(cube, moved(cube, touching))).self_intersections, 4u);
}

// Independent of the separating axes: two triangles meet exactly if an edge of one pierces the
// other (random triangles are never in one plane).
bool edge_pierces(const internal::Corners& a, const internal::Corners& b) {
  const ExactTriangle<double> p = placed<double>(Pose(), a), q = placed<double>(Pose(), b);
  for (std::size_t k = 0; k < 3; ++k) {
    if (pierces(p[k], p[(k + 1) % 3], q)) return true;
  }
  return false;
}

TEST(SelfIntersection, AgreesWithPiercingEdges) {
  Random random(17);
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
  const TriangleMesh mesh = soup(400, 23);
  std::size_t expected = 0;
  for (std::size_t i = 0; i < 400; ++i) {
    for (std::size_t j = i + 1; j < 400; ++j) {
      expected += internal::triangles_meet(corners_of(mesh, i), corners_of(mesh, j));
    }
  }
  EXPECT_GT(expected, 100u);
  const internal::SelfIntersections all = internal::count_self_intersections(mesh, 1'000'000);
  EXPECT_EQ(all.pairs, expected);
  EXPECT_FALSE(all.stopped);
  const internal::SelfIntersections some = internal::count_self_intersections(mesh, 100);
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
  const auto error = [](auto change) {
    TriangleMesh mesh = cube_mesh();
    change(mesh);
    return error_of([&] { validate(mesh, "part"); });
  };
  for (const NamedMesh& entry : mesh_zoo()) {
    EXPECT_NO_THROW(validate(entry.mesh, "zoo")) << entry.name;
  }
  EXPECT_EQ(error([](TriangleMesh& mesh) { mesh.vertices[1].y() = 1e15; }), "");
  EXPECT_EQ(error([](TriangleMesh& mesh) { mesh.triangles.clear(); }),
            "part: there are no triangles");
  for (const double bad : {std::nan(""), HUGE_VAL, 1.1e15, -1.1e15}) {
    const std::string text = error([&](TriangleMesh& mesh) { mesh.vertices[5].y() = bad; });
    EXPECT_TRUE(text.starts_with("part: vertex 5 has a coordinate ")) << text;
    EXPECT_NE(text.find(std::isfinite(bad) ? "beyond 1e15" : "not finite"), std::string::npos);
  }
  for (const int bad : {-1, 8}) {
    const std::string text = error([&](TriangleMesh& mesh) { mesh.triangles[3][1] = bad; });
    EXPECT_NE(text.find("triangle 3"), std::string::npos) << text;
  }
  for (const double bad : {-1.0, std::nan(""), HUGE_VAL}) {
    const std::string text = error([&](TriangleMesh& mesh) { mesh.vertex_error = bad; });
    EXPECT_NE(text.find("vertex error"), std::string::npos) << text;
  }
}

TEST(Describe, MentionsEverythingUnusual) {
  const std::string cube = describe(mesh_report(cube_mesh()));
  EXPECT_NE(cube.find("12 triangles, 8 vertices, one piece"), std::string::npos) << cube;
  EXPECT_NE(cube.find("volume 1"), std::string::npos);
  EXPECT_EQ(std::count(cube.begin(), cube.end(), '\n'), 1);
  const std::string open = describe(mesh_report(open_box()));
  EXPECT_NE(open.find("not closed"), std::string::npos);
  EXPECT_NE(open.find("4 edges with a triangle on one side only"), std::string::npos);
  EXPECT_EQ(open.find("volume"), open.find("volume, only"));
  const std::string worst = describe(mesh_report(
      with_degenerates(with_duplicates(joined(inverted(cube_mesh()), projective_plane())))));
  for (const char* word : {"without area", "there before", "more than two", "intersect without"}) {
    EXPECT_NE(worst.find(word), std::string::npos) << word << " in " << worst;
  }
}

}  // namespace
}  // namespace spherule::test
