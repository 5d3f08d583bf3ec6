// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What is unusual about a mesh.
//
// @code{.cpp}
// #include <spherule/geometry/mesh_report.h>
// #include <cassert>
// #include <iostream>
//
// const spherule::TriangleMesh open{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}}};
// const spherule::MeshReport report = spherule::mesh_report(open);
// assert(!report.closed && report.boundary_edges == 3);
// std::cout << describe(report) << "\n";
// @endcode

#include "geometry/triangle_mesh.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <string>

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
