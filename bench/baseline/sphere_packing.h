// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Sphere packing of the solid as it is, as the paper compares with: not conservative.
//
// @code{.cpp}
// #include <spherule/bench/baseline/sphere_packing.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const spherule::SpherePacking packing =
//     spherule::pack_spheres(tetrahedron, {.max_error = 0.25, .closed_below = 0.5});
// assert(packing.error <= 0.25 && packing.inflated.size() == packing.spheres.size());
// @endcode

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"

#include <cstddef>
#include <cstdint>
#include <vector>

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
