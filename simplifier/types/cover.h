// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Stage 2: covers the simplified solid with few spheres.
//
// @code{.cpp}
// #include <spherule/simplifier/simplify.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto external = spherule::place_external_spheres(
//     tetrahedron, {.min_external_diameter = 2, .max_error = 0.5});
// const spherule::SphereCover cover =
//     spherule::cover(tetrahedron, external, {.max_error = 0.5, .effort = 0});
// const spherule::CertifyOptions options{.external = &external, .volume = false};
// assert(spherule::certify(tetrahedron, cover.spheres, options).covered);
// @endcode

#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/types/external_spheres.h"
#include "simplifier/types/zones.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <vector>

namespace spherule {

// How S is covered.
enum class CoverMethod {
  kCover,  // few spheres, two-sided guarantee (default)
  kPaper   // the paper's Algorithm 1, second loop
};

// How the second stage covers, and how long it may search. What says "kCover:" or "kPaper:" counts
// for that method; another one leaves it unused, without an error, so that methods can be compared
// on equal options. Only zones, which are a promise, are refused by a method that does not keep it.
// fit_levels() says what it uses.
struct CoverOptions {
  CoverMethod method = CoverMethod::kCover;
  // E: how far the spheres may protrude from S. Positive.
  double max_error = 0.0;
  // kCover: zones of an E of their own. Every point of the union of the spheres that lies in such a
  // zone is at most its `max_error` from S. Other methods throw Error for one that is below E.
  std::vector<Zone> zones = {};
  // No sphere of the result is smaller than this radius (a tool made of such spheres passes stage 1
  // of what it intersects unchanged). Protrusion may exceed E where it forces a larger sphere.
  double min_radius = 0.0;
  // kPaper, and a Stage2Method that packs: diameter at which a sphere is seeded (the paper's
  // min_internal_size); 0 chooses E / 2.
  double min_internal_diameter = 0.0;
  std::uint64_t seed = 1;
  // kCover: rounds at most of searching for fewer spheres than the first proved answer; 0: none.
  // A solid that takes more than some 8,000 spheres is covered in blocks (docs/covering.md), each
  // with so many rounds. The search ends sooner where, by what it saved of late, a tenth more
  // rounds would save less than 1 % of the spheres, above 60 rounds less than 60 % / effort; and
  // where a quarter of the rounds that are allowed, but 40 at least and 400 at most, have saved
  // nothing since cells last became finer.
  int effort = 60;
  // kCover: no new round begins after so many seconds, either; 0 sets no limit. The result then
  // depends on the machine.
  double seconds = 0.0;
  // kCover: prove a lower bound of the count, too (SphereCover::lower_bound), after the search:
  // that takes tens of times as long as the first answer. Not with a min_radius, which lets spheres
  // protrude, and not where S is covered in blocks.
  bool lower_bound = false;
  // kPaper: record the history (costs some time).
  bool history = false;
  int threads = 0;  // 0: all
  Progress progress = {};
  // kCover: called with the count whenever fewer spheres are proved to cover S, the first answer
  // included, from one thread at a time; where S is covered in blocks, when some of these are done.
  std::function<void(std::size_t)> on_proved = {};
  // kCover: once a stop is requested, the search ends with the fewest spheres proved so far, after
  // the first answer (of all blocks) at the earliest. The result then depends on when that was.
  std::stop_token stop = {};
};

// One step of the paper's loop, for its figures 6 to 8. "Before" and "after" refer to inflating
// every sphere by the error that remains at that step.
struct CoverHistoryEntry {
  std::size_t sphere_count = 0;
  // Greatest distance from a point of S to the spheres (section II.B): proved bounds, before
  // inflation.
  double max_error_lower = 0.0;
  double max_error_upper = 0.0;
  // Greatest distance from a point of the mesh surface to the spheres (figure 6), over samples.
  double surface_error_before = 0.0;
  double surface_error_after = 0.0;
  // Share of the solid mesh that is covered (figure 7), and volume of the spheres outside of the
  // solid mesh over the volume of the solid mesh (figure 8), over samples.
  double coverage_before = 0.0;
  double coverage_after = 0.0;
  double excess_before = 0.0;
  double excess_after = 0.0;
};

// Stage 2's result.
struct SphereCover {
  std::vector<Sphere> spheres;
  // No cover of S that protrudes by at most E has fewer spheres, as proved; 0: not known
  // (CoverOptions::lower_bound).
  std::size_t lower_bound = 0;
  // kPaper, and a Stage2Method that inflates: the spheres before that, and the certified error.
  std::vector<Sphere> spheres_before_inflation;
  double inflation = 0.0;
  std::vector<CoverHistoryEntry> history;
  // kPaper, and a Stage2Method that packs: seeds that had to be moved before a sphere fitted.
  std::size_t seeds_rejected = 0;
};

}  // namespace spherule
