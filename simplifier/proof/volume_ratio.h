// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/triangle_mesh.h"
#include "spheretree/sphere.h"

#include <span>

namespace spherule::internal {

// Volume of the union of the balls over the volume inside of a closed mesh, where the winding
// number is not 0: estimated, each from the exact lengths within it of fixed lines, at most 4096
// (fewer where there are many triangles), one through each cell of a grid. Neither may be empty.
double estimate_volume_ratio(const TriangleMesh& mesh, std::span<const Sphere> balls);

}  // namespace spherule::internal
