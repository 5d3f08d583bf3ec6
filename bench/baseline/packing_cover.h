// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A stage 2 by sphere packing, the largest sphere first: conservative.
//
// @code{.cpp}
// #include <spherule/bench/baseline/packing_cover.h>
// #include <spherule/simplifier/simplify.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto external = spherule::place_external_spheres(
//     tetrahedron, {.min_external_diameter = 2, .max_error = 0.5});
// const auto cover = spherule::packing_cover(tetrahedron, external, {.max_error = 0.5});
// const spherule::CertifyOptions options{.external = &external, .volume = false};
// assert(spherule::certify(tetrahedron, cover.spheres, options).covered);
// @endcode

#include "geometry/triangle_mesh.h"

namespace spherule {

// Conservative: on return the union of the spheres contains S and protrudes from it by at most E,
// unless min_radius forces more, or external spheres close S by a hair and no point of S is found
// there (certify() says how far). A stage 2 method for simplify() (Stage2Method) in the place of
// cover(): sphere packing with the largest sphere first, overlapping allowed. Candidates are the
// spheres inscribed in S that grow from points spread over it and its boundary. The next sphere is
// the largest whose point is still further than 0.97 E from the spheres and whose centre none of
// them holds; where only spheres with centres held are left, the largest of these. Points that the
// proof then finds further than that from the spheres get spheres of their own, the furthest first;
// so, when no point of S is, as proved by subdivision, every radius grows by the certified error
// that remains. The difference to the paper's loop (CoverMethod::kPaper) is the order, by size and
// not by distance.
//
// Uses max_error, min_internal_diameter (at which spheres are seeded), min_radius (no sphere is
// smaller), threads and progress of the options. The packing itself, inside of S, and the inflation
// are in the result as with CoverMethod::kPaper, in the order in which spheres were placed.
// Deterministic on any number of threads. Throws Error as cover() does, with the subject "zones"
// where E is smaller in a zone: only one max error is known here.
SphereCover packing_cover(const TriangleMesh& mesh, const ExternalSpheres& external,
                          const CoverOptions& options);

}  // namespace spherule
