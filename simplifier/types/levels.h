// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Levels of detail: coarser covers that enclose a finer one.
//
// @code{.cpp}
// #include <spherule/simplifier/types/levels.h>
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

// Levels of detail above the cover `spheres`, for the errors given, all larger than that of the
// cover: the finest first, each made for the one before it. A level is a set cover whose rows are
// the finer spheres: a sphere about c of radius at most E + the clearance of c must hold each finer
// sphere that is its child whole. That has a solution, since a finer sphere is such a sphere
// itself. So every level covers what the cover covers, protrudes from S by at most its E (unless
// min_radius forces more, or the cover itself protrudes by more), and each of its spheres encloses
// its children in exact arithmetic, with the reserve of SphereLevel. Spheres are shrunk to what
// their children need. Uses seed, effort (at most the default where `seconds` is set), min_radius,
// threads and progress of the options. Deterministic. Throws Error for a mesh that validate()
// refuses, spheres that are not usable (external ones that stage 1 cannot have made) and errors
// that check_levels() refuses. Zones do not bind levels above the cover.
std::vector<CoverLevel> fit_levels(const TriangleMesh& mesh, const ExternalSpheres& external,
                                   std::span<const Sphere> spheres,
                                   std::span<const double> max_errors, const CoverOptions& options);

// The errors sorted, the finest first. Throws Error unless they are positive and finite and each is
// at least 1 % larger than the next finer one: below that rounding could decide.
std::vector<double> check_levels(std::span<const double> max_errors);

// The tree over the cover in which the spheres of the levels stand.
LevelTree level_tree(std::span<const Sphere> spheres, std::span<const CoverLevel> levels);

}  // namespace spherule
