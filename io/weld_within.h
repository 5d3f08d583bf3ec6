// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/triangle_mesh.h"

namespace spherule::internal {

// The mesh with vertices that are no further apart than `tolerance` made one, so that cracks which
// rounding has left are shut. In the order of the vertices, each that no other stands for yet
// stands for itself and for those near to it that follow; so none moves by more than the tolerance,
// which is added to `vertex_error`, and no point of a triangle does. Triangles that lose their area
// stay.
TriangleMesh weld_within(const TriangleMesh& mesh, double tolerance);

}  // namespace spherule::internal
