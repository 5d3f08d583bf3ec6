// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "simplifier/cover.h"
#include "simplifier/solid/clearance.h"

namespace spherule::internal {

// Stage 2 as the paper has it (Algorithm 1, second loop): a sphere is seeded at the point of S that
// is furthest from the spheres so far, grown and moved until it touches the outside in two or more
// places that stop it, until no point of S is further from the spheres than allowed; then every
// radius is inflated by the certified error that remains, so that the spheres cover S.
//
// Departures from the listing: the loop runs while the error is *greater* than the limit; the
// furthest point is found by subdivision with proved bounds, not on samples; a seed of
// min_internal_diameter that collides is moved away from the contact instead of being dropped,
// since the next round would try the same one again; and where the grown sphere slides so far from
// a sharp tip that the tip stays further than half the limit, the last position on its way that
// does not is taken.
SphereCover place_internal_spheres(const TriangleMesh& mesh, const MeshDistance& distance,
                                   const Clearance& clearance, const CoverOptions& options);

}  // namespace spherule::internal
