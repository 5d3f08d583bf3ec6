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

#include "bench/baseline/octree_spheres.h"
#include "geometry/triangle_mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

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

// Spheres in levels by merging medial spheres, after Hubbard: not conservative.
//
// @code{.cpp}
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto spheres = spherule::hubbard_spheres(
//     tetrahedron, {.counts = {1, 8}, .sites = 100, .cover_points = 500});
// assert(spheres.levels[0].size() == 1 && spheres.levels[1].size() <= 8);
// @endcode

namespace spherule {

// How many spheres there are to be, and of how many samples.
struct HubbardOptions {
  // Spheres of each level, the coarsest first, ascending, the first at least 1.
  std::vector<std::size_t> counts = {1, 8, 64, 512};
  // Sites of the Voronoi diagram, and points of the surface that have to be covered, spread evenly;
  // corners and points of the edges are covered too.
  std::size_t sites = 1000;
  std::size_t cover_points = 10000;
  std::uint64_t seed = 1;
  int threads = 0;  // 0: all
};

// Not conservative: every level holds all points that were sampled on the surface, and nothing is
// promised between them, nor of the inside of the solid; made_conservative() grows a level until it
// covers. After Hubbard, "Approximating polyhedra with spheres for time-critical collision
// detection" (ACM Transactions on Graphics 15, 1996): the medial axis as spheres about the Voronoi
// vertices of evenly spread points, not refined; then pairs of neighbours are merged from the
// bottom up, and each level is what is left when its count is reached, so that a sphere hangs under
// the one that it became part of. Departures: what a sphere has to hold is the points that it is
// responsible for (Hubbard: parts of the surface, about the points that formed it), and the pair
// that protrudes least is merged first (internal/sphere_reduction.h). A level has fewer spheres
// than wanted if there are no more. Deterministic for equal input on any number of threads. Throws
// Error for a mesh that validate() refuses or that has no area, and for options out of range.
SphereLevels hubbard_spheres(const TriangleMesh& mesh, const HubbardOptions& options = {});

}  // namespace spherule
