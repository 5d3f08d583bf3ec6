// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Convex hull: conservative (proved, with outward rounding).
//
// @code{.cpp}
// #include <spherule/bench/baseline/convex_hull.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const spherule::ConvexHull hull = spherule::convex_hull(tetrahedron, {.padding = 0.01});
// assert(hull.mesh.triangles.size() == 4 && hull.expansion > 0.01);
// @endcode

#include "geometry/triangle_mesh.h"

#include <Eigen/Core>

#include <span>
#include <string>
#include <vector>

namespace spherule {

// Points whose extent across some plane is at most this share of their extent are flat: their hull
// has no inside that rounding leaves intact.
inline constexpr double kFlatShare = 1e-9;

// What the hull is to hold beside the mesh.
struct ConvexHullOptions {
  // Every sphere of this radius about a vertex of the mesh is inside too (the mesh's vertex_error
  // is added). It moves flat and long hulls more at their far ends than across; for larger
  // distances grow the mesh itself.
  double padding = 0.0;
  // How far a vertex may be moved, as a share of the extent of the vertices (and ten paddings), for
  // the proof to succeed: triangles that are long and thin require more than others.
  double max_expansion = 1e-6;
};

// The hull, and how far it is from convex.
struct ConvexHull {
  // Closed, each edge used once in either direction, facing outwards; convex up to `expansion`: no
  // vertex is farther than that beyond the plane of a triangle.
  TriangleMesh mesh;
  // Farthest that a vertex stands from the vertex of the input that it was made of.
  double expansion = 0.0;
};

// Convex hull of the vertices that triangles use, by qhull (Barber, Dobkin and Huhdanpaa 1996).
// Guarantee: the solid of the result (its surface and what it encloses) contains every vertex, so
// also all of the original and all that it encloses. qhull rounds, hence no answer of it is
// trusted: its vertices are moved away from a point c inside, by the same share each, until every
// input vertex lies strictly within the plane of every triangle by more than the rounding of the
// test, and c too. A path from c to an input vertex then intersects no triangle, so that both are
// inside. The share is some 1e-15, more for long and flat hulls.
//
// Throws Error for a mesh that validate() refuses; for a padding that is negative or not finite;
// for vertices that coincide, or lie on a line or a plane up to kFlatShare of their extent; for an
// extent below 1e-60; if no hull can be proved within max_expansion, or that is not above zero.
ConvexHull convex_hull(const TriangleMesh& mesh, const ConvexHullOptions& options = {});

// The convex hull of points, as that of the vertices of a mesh; errors name `subject`.
ConvexHull convex_hull(std::span<const Eigen::Vector3d> points, const ConvexHullOptions& options,
                       const std::string& subject);

// 0 to 3: whether points coincide, lie on a line, in a plane, or neither, up to kFlatShare of their
// extent (as seen along their principal axes).
int affine_dimension(std::span<const Eigen::Vector3d> points);

// The triangles as a list of polygons, each its number of corners and then these: the form in which
// FCL's Convex takes faces.
std::vector<int> polygon_list(const TriangleMesh& mesh);

}  // namespace spherule
