// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// How far a mesh is from another one that it stands for.
//
// @code{.cpp}
// #include <spherule/bench/baseline/mesh_deviation.h>
// #include <cassert>
//
// const spherule::TriangleMesh whole{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
//                                    {{0, 1, 2}, {0, 2, 3}}};
// const spherule::TriangleMesh half{whole.vertices, {{0, 1, 2}}};
// const spherule::MeshDeviation deviation = spherule::measure_deviation(whole, half);
// assert(deviation.loss.lower > 0.7 && deviation.excess.upper < 0.01);
// @endcode

#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"

#include <cstddef>

namespace spherule {

// How closely a deviation is measured.
struct DeviationOptions {
  // How far apart lower and upper bound may be at the end, as a share of the box diagonal of both
  // meshes; from 1e-6 to 1.
  double tolerance = 1e-3;
  // Pieces of surface to examine in either direction before the bounds are left farther apart.
  std::size_t most_pieces = 100'000;
};

// How far a mesh that stands for another one, the original, is from it. The solid of a closed mesh
// (MeshReport::closed) is its surface and every point with a winding number other than zero; that
// of an open one is its surface alone. Lengths in the unit of the meshes.
struct MeshDeviation {
  // One-sided Hausdorff distance from the surface of the original to the solid of the other. Where
  // it is zero nothing of the surface is lost; else what touches the original may pass the other at
  // up to this distance: a missed collision.
  Bounds loss;
  // One-sided Hausdorff distance from the surface of the other to the solid of the original: how
  // far the other sticks out, so from how far it may report a collision that is none.
  Bounds excess;
};

// Measures both. Distances to a solid change by no more than one moves, so the surface is cut into
// triangles until no piece can hold a point farther than the farthest found by more than the
// tolerance (Guthe, Borodin and Klein 2005 do the same over surfaces). The bounds are of the exact
// distances up to rounding of some 1e-14 of the extent: a measurement, no proof. Several parts that
// overlap may be given as one mesh, if each is closed and faces outwards. Throws Error for a mesh
// that validate() refuses and for options out of range.
MeshDeviation measure_deviation(const TriangleMesh& original, const TriangleMesh& other,
                                const DeviationOptions& options = {});

}  // namespace spherule
