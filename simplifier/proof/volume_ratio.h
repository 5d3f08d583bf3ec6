// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/triangle_mesh.h"
#include "simplifier/external_spheres.h"
#include "spheretree/sphere.h"

#include <optional>
#include <span>

namespace spherule::internal {

// Volume of the union of the spheres over the volume inside of a closed mesh, where the winding
// number is not 0: estimated, each from the exact lengths within it of fixed lines, at most 4096
// (fewer where there are many triangles), one through each cell of a grid. Neither may be empty.
// None where no line meets the one or the other: small things far apart, a mesh without volume.
std::optional<double> estimate_volume_ratio(const TriangleMesh& mesh,
                                            std::span<const Sphere> spheres);

struct EstimatedVolume {
  double volume = 0.0;
  double error = 0.0;  // standard error
};

// Volume of what stage 1 fills, S without the inside of a closed mesh: estimated from the exact
// lengths of such lines, with the standard error as their differences show it (on average it is
// rather stated too large).
EstimatedVolume estimate_filled_volume(const TriangleMesh& mesh, const ExternalSpheres& external);

}  // namespace spherule::internal
