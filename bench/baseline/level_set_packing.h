// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Sphere packing by OpenVDB: not conservative.
//
// @code{.cpp}
// #include <spherule/bench/baseline/level_set_packing.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto spheres = spherule::level_set_packing(tetrahedron, {.step = 0.05, .max_spheres = 10});
// assert(spheres.size() == 10);
// @endcode

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"

#include <cstddef>
#include <vector>

namespace spherule {

// How finely and how far the solid is filled.
struct LevelSetPackingOptions {
  // Edge of a voxel of the level set, in the unit of the mesh. Positive.
  double step = 0.0;
  // No sphere is smaller; 0 chooses half a step, below which the level set tells nothing.
  double min_radius = 0.0;
  std::size_t max_spheres = 10000;
  // Points of the inside that are examined as centres.
  std::size_t candidates = 20000;
  int threads = 0;  // 0: all
};

// Not conservative; made_conservative() grows the spheres until they cover. Sphere packing as
// OpenVDB's fillWithSpheres has it, beside the paper's own: the mesh becomes a level set (signed
// distances in voxels near the surface, in 32-bit floats), and the largest sphere that fits inside
// of it about one of many random points is taken, overlapping allowed, until no candidate is left
// outside of the spheres with a sphere of the least radius about it. The spheres lie in the solid
// up to a step. What is inside of an open mesh OpenVDB guesses; there may be no sphere then.
// Equal input gives equal results. Throws Error for a mesh that validate() refuses, for options out
// of range, and for a step below 1/4096 of the box diagonal.
std::vector<Sphere> level_set_packing(const TriangleMesh& mesh,
                                      const LevelSetPackingOptions& options);

}  // namespace spherule
