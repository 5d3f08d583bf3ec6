// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Stage 1: the spheres outside of a mesh that define its simplified solid S.
//
// @code{.cpp}
// #include <spherule/simplifier/simplify.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto external = spherule::place_external_spheres(
//     tetrahedron, {.min_external_diameter = 2, .max_error = 0.5});
// assert(!external.spheres.empty() && external.closing_slack <= 0.03 * 2);
// for (const spherule::Sphere& sphere : external.spheres) {
//   assert(sphere.radius >= 1.0 && !certainly_contains(sphere, {0.1, 0.1, 0.1}));
// }
// @endcode

#include "base/progress.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/types/zones.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule {

// How external spheres are placed.
enum class ExternalPlacement {
  kReachable,  // deterministic flood from outside (default)
  kRandom,     // the paper's Algorithm 1
  kNone        // no external sphere: S is the box of M
};

// What the first stage simplifies away.
struct ExternalOptions {
  ExternalPlacement placement = ExternalPlacement::kReachable;
  // D, the diameter of the smallest object to be checked against the model (the paper's
  // min_ext_size).
  double min_external_diameter = 0.0;
  // t: everything holds for M grown by this much.
  double padding = 0.0;
  // Grid step of the flood; 0 chooses sqrt(0.08 * max_error * D / 2), at most D / 8, which leaves
  // spikes of about 0.02 E between the spheres along a flat wall. Without `max_error` it is D / 16.
  // Where the grid would have more than kManyCells (or `max_cells`), the step that is chosen is up
  // to 2.5 times as large, but no more than D / 8: the spikes, which belong to S, are then up to E
  // / 8 high. ExternalSpheres::grid_step is the one that was used.
  double grid_step = 0.0;
  static constexpr std::size_t kManyCells = std::size_t{1} << 24;
  // Cells of the grid at most, 24 bytes each (44 while borders of zones are followed); from 1 to
  // kMostCells.
  static constexpr std::size_t kMostCells = std::size_t{1} << 27;
  std::size_t max_cells = kMostCells;
  // E: chooses the grid step and, with `keep_concave_edges`, the zones (0: those of E = D / 4).
  // Unless it is 0, no zone may have a larger `max_error`.
  double max_error = 0.0;
  // Reachable placement only: the grid is made finer, where that matters, until `closing_slack` is
  // proved to be at most this share of D; above 0 and at most kNoTightness, which leaves the grid
  // as it is. The time grows with what comes close to D in width, not with the whole surface.
  double tightness = 0.03;
  static constexpr double kNoTightness = 10.0;
  // Reachable placement only: zones of a D of their own. What is reachable then: a place to which a
  // sphere can be moved from outside that may change its size on the way, and at every point x of
  // the way of its centre has a radius of rho(x) at least: d / 2 where x lies in a zone of its own
  // d (the least of them), D / 2 elsewhere. Zones also make the grid finer, by halvings of its
  // step, as their d and max error require.
  std::vector<Zone> zones = {};
  // Adds such zones along sharp concave edges of the mesh (concave_edges.h).
  bool keep_concave_edges = false;
  // Random placement: number of attempts (the paper's "limit") and seed.
  std::size_t limit = 100000;
  std::uint64_t seed = 1;
  int threads = 0;  // 0: all
  Progress progress = {};
};

// Stage 1's result. It defines the simplified solid S exactly: the closed box minus the union of
// the open spheres. Every sphere is disjoint from M grown by `padding`, of diameter at least D, and
// was reached from outside the box by a sphere of diameter D without touching M (in zones: of the
// diameter that suffices there, see ExternalOptions::zones); hence M and |M| are subsets of S,
// whatever spheres were kept. Spheres that do not reach into the box by more than rounding (1e-12
// of its coordinates and their radius) are left out: a box has none.
struct ExternalSpheres {
  std::vector<Sphere> spheres;
  Eigen::AlignedBox3d box;             // of M grown by the padding, rounded outwards
  double min_external_diameter = 0.0;  // D
  double padding = 0.0;                // t, the mesh's vertex_error included
  double grid_step = 0.0;              // of the flood; 0 for the other placements
  std::size_t nodes_examined = 0;      // cells of the grid, or attempts of the random placement
  // Proved: every place to which a sphere of diameter D + closing_slack can be moved from outside
  // lies, as its centre, outside of `box` (or inside, by no more than the rounding below), or in a
  // sphere of `spheres` that was reached. So a gap may be wider than D by no more than that and
  // have been closed. It is the centre that is proved to be out of S, not all of the sphere of
  // diameter D + closing_slack about it: S may reach into its rim. External spheres are added where
  // it does, close to concave edges, corners and ends of passages, so that in samples on three
  // models S reaches into it by a third of a grid step at most (bench/README.md); that is no proof.
  // For the d of a zone the same share of d holds. At most `tightness` of D, unless memory ends
  // first, or with zones the search along their borders does. 0 for the other placements, of which
  // nothing is proved.
  double closing_slack = 0.0;
  // What keep_concave_edges added.
  std::vector<Zone> concave_edges;
};

}  // namespace spherule
