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

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"

#include <cstddef>
#include <cstdint>
#include <vector>

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

// Sphere packing of the solid as it is, as the paper compares with: not conservative.
//
// @code{.cpp}
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const spherule::SpherePacking packing =
//     spherule::pack_spheres(tetrahedron, {.max_error = 0.25, .closed_below = 0.5});
// assert(packing.error <= 0.25 && packing.inflated.size() == packing.spheres.size());
// @endcode

namespace spherule {

// How densely the solid is packed.
struct SpherePackingOptions {
  // E: spheres are added until no point of the solid is further than this from them, in the unit of
  // the mesh. Positive.
  double max_error = 0.0;
  // Diameter at which a sphere is seeded (the paper's min_internal_size); 0 chooses E / 2.
  double seed_diameter = 0.0;
  // Ways into the solid that are narrower than this (or a little wider, by solid.closing_slack) are
  // taken for closed; 0 chooses E / 2.
  double closed_below = 0.0;
  double padding = 0.0;  // t: of the mesh; its vertex_error is added
  bool history = false;  // record the history (costs some time)
  std::uint64_t seed = 1;
  int threads = 0;  // 0: all
  Progress progress = {};
};

// The packing, and what is proved of it.
struct SpherePacking {
  std::vector<Sphere> spheres;   // inside of `solid`
  std::vector<Sphere> inflated;  // every radius larger by `error`: these contain `solid`
  double error = 0.0;            // proved, at most E
  std::vector<CoverHistoryEntry> history;
  ExternalSpheres solid;           // what was packed
  std::size_t seeds_rejected = 0;  // seeds that had to be moved before a sphere fitted
};

// Not conservative; `inflated` is. The generic sphere packing of the paper's comparisons: greedy,
// overlapping allowed, inside the solid as it is ("placing several spheres inside the bounds of a
// CAD model", section III; "static sphere packing that allows overlapping"). A sphere is grown at
// the point of the solid that is furthest from the spheres so far, until none is further than E;
// that is the second loop of Algorithm 1 (cover() with CoverMethod::kPaper), which the paper uses
// for both. The difference is what is filled. The bounding sphere simplification fills S, of which
// ways in narrower than min_ext_size are closed; the packing fills the mesh's own inside, S for a
// size next to nothing (`closed_below`). Without any external sphere S would be the box of the
// mesh, which is no packing of it.
//
// `solid` contains |M|, and is larger by a skin: in concave corners as thick as the first such
// spheres leave it, less than `closed_below`; elsewhere much thinner. A sphere may leave |M| by as
// much. History as of cover(). Deterministic on any number of threads. Throws Error as
// place_external_spheres() and cover() do.
SpherePacking pack_spheres(const TriangleMesh& mesh, const SpherePackingOptions& options);

}  // namespace spherule
