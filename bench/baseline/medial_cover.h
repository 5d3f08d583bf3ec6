// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A stage 2 by adaptive medial axis approximation: conservative.
//
// @code{.cpp}
// #include <spherule/bench/baseline/medial_cover.h>
// #include <spherule/simplifier/simplify.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto external = spherule::place_external_spheres(
//     tetrahedron, {.min_external_diameter = 2, .max_error = 0.5});
// const auto cover = spherule::medial_cover(tetrahedron, external, {.max_error = 0.5});
// const spherule::CertifyOptions options{.external = &external, .volume = false};
// assert(spherule::certify(tetrahedron, cover.spheres, options).covered);
// @endcode

#include "geometry/triangle_mesh.h"

namespace spherule {

// Conservative: on return the union of the spheres contains S. A stage 2 method for simplify()
// (Stage2Method) in the place of cover(): the adaptive medial-axis approximation (AMAA, Bradshaw
// and O'Sullivan 2004; see medial_axis.h) of the simplified solid S, whose clearances are exact,
// instead of the mesh. Medial spheres of points on the boundary of S are merged, burst or expanded
// to few that hold samples of S; what these leave open in between, a proof over cells of S finds,
// and it becomes samples, too. Then every radius grows by the certified depth that is still
// uncovered. How far the spheres may protrude before that is steered: of some trials that protrude
// from S by at most E in the end, as proved, the one with the fewest spheres is returned; if there
// is none, the one that protrudes least, and certify() says by how much.
//
// Uses max_error, min_radius (no sphere is smaller; that may protrude further), threads and
// progress of the options. The spheres before they grew, and by how much, are in the result as with
// CoverMethod::kPaper. Deterministic on any number of threads. Throws Error as cover() does, with
// the subject "zones" where E is smaller in a zone: only one max error is known here.
SphereCover medial_cover(const TriangleMesh& mesh, const ExternalSpheres& external,
                         const CoverOptions& options);

}  // namespace spherule
