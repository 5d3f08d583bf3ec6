// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/triangle_mesh.h"
#include "simplifier/cover.h"
#include "simplifier/external_spheres.h"
#include "simplifier/zones.h"
#include "spheretree/sphere.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule {

// How far a repair may go.
struct RepairOptions {
  // E: how far a ball that is grown or added may protrude from S. The natural choice is the E that
  // the balls were made for. 0 chooses the median of how far they protrude as they are, so that a
  // few that stand out far do not license the others to, and at least 1 % of the mesh's box
  // diagonal.
  double max_error = 0.0;
  // Where it may protrude by less (zones.h); a ball that breaks a zone as it is stays as it is.
  std::vector<Zone> zones = {};
  std::uint64_t seed = 1;
  int effort = CoverOptions{}.effort;  // of the search for few balls to add
  int threads = 0;                     // 0: all
  Progress progress = {};
};

// The spheres, repaired, and what that took.
struct Repair {
  // The balls of the input in their order, none moved and none smaller than it was; then those
  // added.
  std::vector<Sphere> spheres;
  std::size_t inflated = 0;
  std::size_t added = 0;
  double max_error = 0.0;  // E, as used
  // How far the balls protrude from S at most, before and after; what is more than E after is so of
  // balls that did not grow.
  double protrusion_before = 0.0;
  double protrusion_after = 0.0;
  double largest_inflation = 0.0;  // of a radius
  double total_inflation = 0.0;    // of all radii
};

// Turns any balls into ones that cover S. A ball (c, r) may grow as long as it protrudes from S by
// at most max_error: to max_error + the clearance of c where c is in S; elsewhere to max_error -
// the distance of c from M; and in no zone by more than is allowed there. A ball that protrudes
// further as it is stays as it is: what is grown or added protrudes by at most max_error, and the
// whole by no more than the larger of that and the protrusion before. The aim is, first, as few
// added balls as possible, then as small a sum of growths as possible, and it is reached
// approximately:
//  1. what no ball can reach by growing is covered by added balls, few by the search of cover();
//  2. beside these, balls grow only as far as the points need it that were found open: each goes to
//     the ball that has to grow least for it, and what others cover then is given back. That is
//     repeated until nothing is found open.
// Balls are not moved. On return S is proved to be covered, in the same way as by cover(). Balls
// that cover S come back unchanged; without balls this is a cover. Deterministic for equal input on
// any number of threads. Throws Error for a mesh that validate() refuses, balls that are not
// usable, options out of range, and for a max_error too small for the rounding of the coordinates.
Repair repair(const TriangleMesh& mesh, const ExternalSpheres& external,
              std::span<const Sphere> spheres, const RepairOptions& options);

}  // namespace spherule
