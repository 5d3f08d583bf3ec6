// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/mesh_distance.h"
#include "geometry/shells.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/proof/proof.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/types/simplification.h"
#include "simplifier/types/zones.h"

#include <optional>
#include <span>
#include <vector>

namespace spherule::internal {

// Upper bounds of the protrusion over S, sphere by sphere: one with its centre in S, of clearance
// d, protrudes by at most r - d; one with its centre outside of S by at most r + the distance to a
// point of S (of the mesh, or met on the way away from the contact).
std::vector<double> protrusions_over_solid(const Clearance& clearance, const MeshDistance& distance,
                                           std::span<const Sphere> spheres);
// The greatest of them, of all spheres or of those that may reach into the zone; not below 0.
double greatest(std::span<const double> protrusions);
double greatest_in(const Zone& zone, std::span<const Sphere> spheres,
                   std::span<const double> protrusions);

// Bounds of the protrusion over |M|, the largest distance from a point of the spheres to |M|. The
// sphere that may protrude most, by its centre and radius, gives both to begin with, and they meet
// up to rounding where its furthest point is over a flat place. Where they are further apart than
// `tolerance` (or 2 % of their value), cells are searched best-first until they are not. The upper
// bound is proved: it counts a point as inside only where a closed shell says so, and measures from
// the surface elsewhere, so open meshes, and hollows that several parts seal together, can make it
// too large. The lower bound is witnessed by points outside of S; where the upper one is too large,
// the two bracket what is inside and cannot be proved to be so.
Bounds protrusion_over_mesh(const MeshDistance& distance, const ClosedShells& shells,
                            const Clearance& clearance, const SpheresToProve& spheres,
                            double tolerance);

// Volume of the union of the spheres over the volume inside of a closed mesh, of which `roles` are:
// estimated, each from the exact lengths within it of fixed lines, at most 4096 (fewer where there
// are many triangles), one through each cell of a grid. Neither may be empty.
// None where no line meets the one or the other: small things far apart, a mesh without volume.
std::optional<double> estimate_volume_ratio(const TriangleMesh& mesh,
                                            const std::vector<TriangleRole>& roles,
                                            std::span<const Sphere> spheres);

struct EstimatedVolume {
  double volume = 0.0;
  double error = 0.0;  // standard error
};

// Volume of what stage 1 fills, S without the inside of a closed mesh: estimated from the exact
// lengths of such lines, with the standard error as their differences show it (on average it is
// rather stated too large).
EstimatedVolume estimate_filled_volume(const TriangleMesh& mesh,
                                       const std::vector<TriangleRole>& roles,
                                       const ExternalSpheres& external);

}  // namespace spherule::internal
