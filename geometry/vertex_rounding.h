// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

// How far the vertices of a mesh have been moved by rounding.

namespace spherule::internal {

// Largest absolute coordinate of the vertices; infinite if one is not a number.
double largest_coordinate(const TriangleMesh& mesh);

// Bound on the distance by which a point moves when each coordinate, of magnitude up to `largest`,
// changes by `relative` of it: sqrt(3) largest relative, rounded up. A coordinate below 2^-960 may
// change by `relative` 2^-960.
double rounding_distance(double largest, double relative);

// Throws Error unless the factor is positive and finite.
void check_scale(double scale);

// Multiplies the vertices and `vertex_error`, to which the rounding is added.
void apply_scale(TriangleMesh& mesh, double scale);

}  // namespace spherule::internal
