// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Levels of detail: coarser covers that enclose a finer one.
//
// @code{.cpp}
// #include <spherule/simplifier/simplify.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto external = spherule::place_external_spheres(
//     tetrahedron, {.min_external_diameter = 2, .max_error = 0.5});
// const spherule::CoverOptions options{.max_error = 0.5, .effort = 0};
// const auto spheres = spherule::cover(tetrahedron, external, options).spheres;
// const auto levels =
//     spherule::fit_levels(tetrahedron, external, spheres, std::vector{1.0}, options);
// assert(levels[0].spheres.spheres.size() < spheres.size() && levels[0].protrusion <= 1.0);
// assert(spherule::level_tree(spheres, levels).tree.spheres().size() == spheres.size());
// @endcode

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/types/cover.h"
#include "simplifier/types/external_spheres.h"
#include "spheretree/level_tree.h"

#include <cstddef>
#include <span>
#include <vector>

namespace spherule {

// A coarser cover that was fitted to the solid and encloses a finer one.
struct CoverLevel {
  double max_error = 0.0;  // E of this level
  // The spheres of this level, and for every sphere of the next finer level (of the cover itself
  // below the first level) the sphere that encloses it.
  SphereLevel spheres;
  // Proved upper bound of the protrusion over S.
  double protrusion = 0.0;
  // For comparison, the same bound for plain clustering: for cut() of build_tree() over the cover,
  // with at most as many spheres as this level has, clustering_count of them.
  double clustering_protrusion = 0.0;
  std::size_t clustering_count = 0;
};

}  // namespace spherule
