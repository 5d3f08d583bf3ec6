// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Makes spheres of any origin cover.
//
// @code{.cpp}
// #include <spherule/simplifier/repair.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto external = spherule::place_external_spheres(
//     tetrahedron, {.min_external_diameter = 2, .max_error = 0.5});
// const std::vector<spherule::Sphere> leaky{{{0.25, 0.25, 0.25}, 0.5}};
// const spherule::RepairOptions options{.max_error = 0.5, .effort = 0};
// const auto repair = spherule::repair(tetrahedron, external, leaky, options);
// assert(repair.spheres[0].center == leaky[0].center && repair.spheres[0].radius >= 0.5);
// assert(repair.spheres.size() == 1 + repair.added);
// @endcode

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/types/simplification.h"
#include "simplifier/types/zones.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule {

// How far a repair may go.
struct RepairOptions {
  // E: how far a sphere that is grown or added may protrude from S. The natural choice is the E
  // that the spheres were made for. 0 chooses the median of how far they protrude as they are, so
  // that a few that stand out far do not license the others to, and at least 1 % of the mesh's box
  // diagonal.
  double max_error = 0.0;
  // Where it may protrude by less (zones.h); a sphere that breaks a zone as it is stays as it is.
  std::vector<Zone> zones = {};
  std::uint64_t seed = 1;
  int effort = CoverOptions{}.effort;  // of the search for few spheres to add
  int threads = 0;                     // 0: all
  Progress progress = {};
};

// The spheres, repaired, and what that took.
struct Repair {
  // The spheres of the input in their order, none moved and none smaller than it was; then those
  // added.
  std::vector<Sphere> spheres;
  std::size_t inflated = 0;
  std::size_t added = 0;
  double max_error = 0.0;  // E, as used
  // How far the spheres protrude from S at most, before and after; what is more than E after is so
  // of spheres that did not grow.
  double protrusion_before = 0.0;
  double protrusion_after = 0.0;
  double largest_inflation = 0.0;  // of a radius
  double total_inflation = 0.0;    // of all radii
};

// Turns any spheres into ones that cover S. A sphere (c, r) may grow as long as it protrudes from S
// by at most max_error: to max_error + the clearance of c where c is in S; elsewhere to max_error -
// the distance of c from M; and in no zone by more than is allowed there. A sphere that protrudes
// further as it is stays as it is: what is grown or added protrudes by at most max_error, and the
// whole by no more than the larger of that and the protrusion before. The aim is, first, as few
// added spheres as possible, then as small a sum of growths as possible, and it is reached
// approximately:
//  1. what no sphere can reach by growing is covered by added spheres, few by the search of
//     cover();
//  2. beside these, spheres grow only as far as the points need it that were found open: each
//     goes to the sphere that has to grow least for it, and what others cover then is given back.
//     That is repeated until nothing is found open.
// Spheres are not moved. On return S is proved to be covered, in the same way as by cover().
// Spheres that cover S come back unchanged; without spheres this is a cover. Deterministic for
// equal input on any number of threads. Throws Error for a mesh that validate() refuses, spheres
// that are not usable (external ones that stage 1 cannot have made), options out of range, and for
// a max_error too small for the rounding of the coordinates.
Repair repair(const TriangleMesh& mesh, const ExternalSpheres& external,
              std::span<const Sphere> spheres, const RepairOptions& options);

}  // namespace spherule
