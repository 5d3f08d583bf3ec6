// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "mesh/shells/closed_shells.h"
#include "simplifier/certificate.h"
#include "simplifier/proof/proof.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/zones.h"

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

}  // namespace spherule::internal
