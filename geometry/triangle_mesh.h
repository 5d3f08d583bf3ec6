// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Triangle meshes, and what is unusual about one.
//
// @code{.cpp}
// #include <spherule/geometry/triangle_mesh.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// spherule::validate(tetrahedron, "tetrahedron");  // throws Error if it cannot be used
// assert(tetrahedron.triangles.size() == 4 && tetrahedron.vertex_error == 0.0);
// const auto [a, b, c] = corners_of(tetrahedron, tetrahedron.triangles[0]);
// assert(a.x() == 0.0 && b.y() == 1.0 && c.x() == 1.0);
// @endcode

#include "geometry/sphere.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace spherule {

// Triangles as read: a closed set of points M, with no assumption of watertightness, orientation or
// freedom from duplicates. Indices refer to `vertices`; lengths are in the unit of the model.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;

  // Bound on the distance between a vertex as stored here and as written in the file it was read
  // from (a reader that rounds to 32-bit floats, node transforms, scale); of a CAD file, on the
  // distance from its faces to the triangles. Zero for meshes made in memory. The simplifier adds
  // it to the padding, so that its promises hold for what the file describes.
  double vertex_error = 0.0;
};

// The corners of a triangle, whose indices must be in range.
inline std::array<Eigen::Vector3d, 3> corners_of(const TriangleMesh& mesh,
                                                 const Eigen::Vector3i& triangle) {
  const auto corner = [&](int k) -> const Eigen::Vector3d& {
    return mesh.vertices[static_cast<std::size_t>(triangle[k])];
  };
  return {corner(0), corner(1), corner(2)};
}

// Throws Error(subject, ...) unless the mesh can be used at all: at least one triangle, indices in
// range, coordinates finite and at most kMaxCoordinate, vertex_error finite and not negative. What
// covers, certifies, measures, writes or queries a mesh calls it, but for MeshDistance, which has
// to be given a mesh that passed.
void validate(const TriangleMesh& mesh, const std::string& subject);

}  // namespace spherule

namespace spherule::internal {

// Around the vertices that triangles use.
inline Eigen::AlignedBox3d box_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (const int v : t) box.extend(mesh.vertices[static_cast<std::size_t>(v)]);
  }
  return box;
}

// Around the spheres, up to rounding.
inline Eigen::AlignedBox3d box_of(std::span<const Sphere> spheres) {
  Eigen::AlignedBox3d box;
  for (const Sphere& s : spheres) {
    box.extend(Eigen::Vector3d(s.center - Eigen::Vector3d::Constant(s.radius)));
    box.extend(Eigen::Vector3d(s.center + Eigen::Vector3d::Constant(s.radius)));
  }
  return box;
}

}  // namespace spherule::internal

// What is unusual about a mesh.
//
// @code{.cpp}
// #include <iostream>
//
// const spherule::TriangleMesh open{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}}};
// const spherule::MeshReport report = spherule::mesh_report(open);
// assert(!report.closed && report.boundary_edges == 3);
// std::cout << describe(report) << "\n";
// @endcode

namespace spherule {

inline constexpr std::size_t kMaxSelfIntersections = 1'000'000;

// What is unusual about a mesh. Nothing here stops the simplifier: it is told to the user. Vertices
// count as one if their coordinates are equal bit for bit.
struct MeshReport {
  std::size_t vertices = 0;  // distinct ones
  std::size_t triangles = 0;
  std::size_t degenerate_triangles =
      0;  // zero area: two equal corners, or collinear to within rounding
  std::size_t duplicate_triangles = 0;  // beyond the first of each, in either orientation
  std::size_t boundary_edges = 0;       // used by one triangle
  std::size_t non_manifold_edges = 0;   // used by more than two
  std::size_t misoriented_edges = 0;    // used twice in the same direction
  std::size_t components = 0;           // connected by shared vertices
  std::size_t inverted_components = 0;  // closed, with negative volume
  // Pairs of triangles without a common vertex that intersect; 0 where the options ask for none.
  std::size_t self_intersections = 0;
  // Whether counting stopped, so that there may be more: at kMaxSelfIntersections, or where so many
  // triangles lie side by side that the pairs of them and of the boxes around several of them to
  // examine are more than 2^24 + 256 times the triangles.
  bool self_intersections_stopped = false;
  // Every triangle with three different corners is of a closed surface, whichever way triangles
  // are turned, so that the mesh has an inside: all that is not connected to infinity.
  bool closed = false;
  Eigen::AlignedBox3d box;
  double area = 0.0;
  // Of the inside of the closed surfaces, sealed hollows included. Not negative, and the same
  // whichever way triangles are turned and however often they are there; parts that intersect, or
  // a surface that intersects itself, count what they have in common more than once.
  double volume = 0.0;
};

// What is examined.
struct MeshReportOptions {
  // Pairs of intersecting triangles are by far the most work to count.
  bool self_intersections = true;
};

// Examines a mesh as a whole. Throws Error for a mesh that validate() refuses.
MeshReport mesh_report(const TriangleMesh& mesh, const MeshReportOptions& options = {});

// The report in a few lines for a person: counts, size, and a sentence for everything unusual.
std::string describe(const MeshReport& report);

}  // namespace spherule
