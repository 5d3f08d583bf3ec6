// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Approximate convex decomposition: not conservative. The parts hold the whole surface of the mesh
// but not always what it encloses; where the surface is concave they stick out, unbounded by the
// concavity requested. measure_deviation() tells by how much.
//
// @code{.cpp}
// #include <spherule/bench/baseline/convex_decomposition.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto parts = spherule::decompose(tetrahedron).parts;
// assert(parts.size() == 1 && parts[0].triangles.size() == 4);
// @endcode

#include "bench/baseline/mesh_deviation.h"
#include "geometry/triangle_mesh.h"

#include <optional>
#include <vector>

namespace spherule {

// How far a mesh is taken apart.
struct ConvexDecompositionOptions {
  // Concavity at which parts are no longer joined, as HACD measures it: distance of the
  // surface of a part from its hull, in the unit of the mesh; 0: 1 % of the box diagonal.
  double max_concavity = 0.0;
  // No fewer parts than this are made of a mesh, if it has so many triangles.
  int min_parts = 1;
  // How the deviation is measured; nothing: not at all.
  std::optional<DeviationOptions> measure = DeviationOptions{};
};

// The parts, and how far they are from the mesh.
struct ConvexDecomposition {
  // Closed, convex up to rounding, facing outwards. polygon_list() (convex_hull.h) turns the
  // triangles into the faces that FCL's Convex takes, beside the vertices.
  std::vector<TriangleMesh> parts;
  double volume = 0.0;      // sum of the parts'; where they overlap it counts twice
  MeshDeviation deviation;  // of the parts together, measured; zero if not requested
};

// Shares the triangles out into parts by hierarchical clustering (Mamou and Ghorbel 2009), by HACD
// of Bullet's extras, and takes the convex hull of each (convex_hull.h) of all its triangles,
// instead of HACD's own, so that every point of the surface lies in a part. Triangles without area
// go with a neighbour. A part that is flat becomes a plate, 1e-4 of the box diagonal to either
// side. The time grows faster than the square of the triangles: decimate large meshes first.
// Equal input gives equal results. Throws Error for a mesh that validate() refuses or that has no
// triangle with an area, and for options out of range.
ConvexDecomposition decompose(const TriangleMesh& mesh,
                              const ConvexDecompositionOptions& options = {});

// All parts as one mesh, a component each.
TriangleMesh join_parts(const std::vector<TriangleMesh>& parts);

}  // namespace spherule
