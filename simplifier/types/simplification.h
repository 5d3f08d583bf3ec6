// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What simplify() and its stages take and return: first stage 1, the spheres outside of a mesh that
// define its simplified solid S, then stage 2, levels, options, the certificate, and all of it
// together. Terms: docs/guarantee.md.
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
#include "spheretree/sphere_tree.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
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
  // Adds such zones along sharp concave edges of the mesh.
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

// Levels of detail: coarser covers that enclose a finer one.
//
// @code{.cpp}
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

// The options of simplify(), and what is derived from them.
//
// @code{.cpp}
// #include <vector>
//
// const std::vector<spherule::Sphere> tool{{{0, 0, 0}, 5}, {{0, 0, 40}, 8}};
// const spherule::SimplifyOptions options{.max_error = 1,
//                                         .min_external_diameter = spherule::tool_diameter(tool)};
// assert(spherule::external_options(options).min_external_diameter == 10);
// @endcode

// A stage 2 method from outside of this library, in the place of cover(). It covers S as well as it
// can; what it achieved, the certificate says.
struct Stage2Method {
  // Stands in option_record() as the method: not empty, and none of method_names().
  std::string name;
  std::function<SphereCover(const TriangleMesh&, const ExternalSpheres&, const CoverOptions&)> run =
      {};
};

// The options of simplify().
struct SimplifyOptions {
  // E: how far the result may protrude from the simplified solid; 0 chooses 1 % of the box
  // diagonal.
  double max_error = 0.0;
  // The E of each level of detail to fit above the cover (CoverLevel), in any order. None may be
  // below `max_error`, which is added where it is not among them; where `max_error` is 0, it
  // becomes the least of them.
  std::vector<double> levels = {};
  // D: diameter of the smallest object to be checked against the model; 0 chooses 4 E, or more
  // where a part is so large that the grid of stage 1 would have too many cells (up to a tenth of
  // the box diagonal; `Simplification::options` has the one that was used).
  double min_external_diameter = 0.0;
  // The closing slack aimed at, as a share of D: ways in that are wider than D (1 + tightness) are
  // not filled (ExternalOptions::tightness). What is proved: ExternalSpheres::closing_slack.
  double tightness = ExternalOptions{}.tightness;
  // t: grow M by this much (chord error of the tessellation, calibration).
  double padding = 0.0;
  // No sphere of the result is smaller than this radius.
  double min_radius = 0.0;
  // Where E and D are smaller.
  std::vector<Zone> zones = {};
  // D is smaller along sharp concave edges too.
  bool keep_concave_edges = false;
  CoverMethod method = CoverMethod::kCover;
  // Where it is set, it is run instead of `method`, with the CoverOptions that cover() would get.
  std::optional<Stage2Method> stage2_method = {};
  ExternalPlacement external = ExternalPlacement::kReachable;
  std::size_t external_limit = 100000;  // attempts of the random placement
  double min_internal_diameter = 0.0;   // of the paper's loop; 0 chooses E / 2
  std::uint64_t seed = 1;
  int effort = CoverOptions{}.effort;  // of the covering search
  double seconds = 0.0;                // and its limit in time; 0: none
  bool lower_bound = false;            // CoverOptions::lower_bound
  bool history = false;                // of the paper's loop
  int threads = 0;                     // 0: all; the result does not depend on it
  Progress progress = {};
  std::function<void(std::size_t)> on_proved = {};  // CoverOptions::on_proved, of the cover of E
  std::stop_token stop = {};                        // CoverOptions::stop, of the levels, too
};

// A lower and an upper bound of a length, proved in a Certificate.
struct Bounds {
  double lower = 0.0;
  double upper = 0.0;
};

// What is proved about spheres, of any origin, and a mesh.
//
// @code{.cpp}
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto external = spherule::place_external_spheres(
//     tetrahedron, {.min_external_diameter = 2, .max_error = 0.5});
// const std::vector<spherule::Sphere> large{{{0.25, 0.25, 0.25}, 1}};
// const std::vector<spherule::Sphere> small{{{0.25, 0.25, 0.25}, 0.5}};
// const spherule::CertifyOptions options{.external = &external, .volume = false};
// assert(spherule::certify(tetrahedron, large, options).covered);
// const spherule::Certificate leaky = spherule::certify(tetrahedron, small, options);
// assert(!leaky.covered && leaky.surface_depth.lower > 0.3);  // the corners are out
// @endcode

// What spheres are certified against, and how closely.
struct CertifyOptions {
  // The simplified solid to certify against, of this mesh: that it holds M grown by its padding is
  // proved by stage 1, which made it, and not again. Without it |M| itself is certified: what a
  // sphere of 1/128 of the box diagonal cannot reach from outside counts as inside (on a grid: gaps
  // of up to 1/54 may), so that spheres that leave such a gap of M open are not proved to cover.
  const ExternalSpheres* external = nullptr;
  // With `external`: zones in which the protrusion is bounded apart.
  std::span<const Zone> zones = {};
  // Without `external`: padding t, to which the mesh's vertex_error is added. With it, the padding
  // is the one of stage 1.
  double padding = 0.0;
  // Smallest piece of surface and cell of space that is examined, as a share of the box diagonal. A
  // piece of this size that no single sphere contains is reported as a leak with its depth. Never
  // below 2^-40 of the largest coordinate, where halves of a piece are mostly rounding.
  double resolution = 1.0 / 4096.0;
  // Protrusion over |M| is searched to within this share of the box diagonal; 0 leaves it out.
  double protrusion_tolerance = 1.0 / 512.0;
  bool volume = true;  // estimate the volume ratio
  int threads = 0;     // 0: all
  Progress progress = {};
};

// What is proved about a set of spheres, with outward rounding, on the numbers as given.
struct Certificate {
  // G1: M grown by the padding and S (without external spheres: |M|) are subsets of the union of
  // the spheres. True only if proved; false may also mean that the proof did not reach the bottom,
  // then the depth bounds tell how much remains.
  bool covered = false;
  // Uncovered depth, the largest distance from a point of the set to the union of the spheres;
  // lower is witnessed by a point, upper proved. Of the surface M as stored, and of the solid,
  // which holds M grown by the padding.
  Bounds surface_depth;
  Bounds solid_depth;
  // The larger of the two.
  Bounds uncovered_depth;
  // The point that witnesses uncovered_depth.lower, if that is positive.
  Eigen::Vector3d deepest_leak = Eigen::Vector3d::Zero();
  // G2: proved upper bound of the protrusion of the spheres over S; absent without external
  // spheres.
  std::optional<double> protrusion_over_simplified_max;
  // Proved upper bound of the protrusion over S of the points of the spheres that lie in a zone,
  // for every zone requested: the greatest bound of a sphere that may reach into it, 0 if none
  // does.
  std::vector<double> protrusion_in_zones;
  // Proved bounds of the protrusion over |M|; absent if not requested.
  std::optional<Bounds> protrusion_over_mesh;
  // Volume of the union of the spheres over that of the solid mesh, estimated. Absent unless it is
  // requested, the mesh is closed and there are spheres, and where the estimate finds nothing of
  // the one or the other: small things far apart, a mesh without volume.
  std::optional<double> volume_ratio;
  // With external spheres and a closed mesh: volume of what stage 1 fills, S without |M|;
  // estimated, and the standard error of that.
  std::optional<double> filled_volume;
  std::optional<double> filled_volume_error;
  // Of the external spheres, where one is proved.
  std::optional<double> closing_slack;
  std::size_t sphere_count = 0;
  std::size_t pieces = 0;  // surface pieces examined
  std::size_t cells = 0;   // cells of space examined
};

// Wall-clock seconds of the parts.
struct SimplifyTimes {
  double external = 0.0;
  double cover = 0.0;
  double levels = 0.0;
  double certify = 0.0;
};

// What simplify() returns.
struct Simplification {
  ExternalSpheres external;
  SphereCover cover;
  std::vector<CoverLevel> levels;  // coarser than the cover, the finest first
  Certificate certificate;
  SimplifyOptions options;  // as used, the defaults filled in
  // D was to be chosen, and is more than 4 E (SimplifyOptions::min_external_diameter).
  bool larger_diameter = false;
  // A stop was requested before the searches were done: what is proved holds, but there may be more
  // spheres than a whole search leaves.
  bool interrupted = false;
  SimplifyTimes times;
};

// S, as stage 1 of simplify() makes it.
struct SimplifiedSolid {
  ExternalSpheres external;
  SimplifyOptions options;  // as used, the defaults filled in
  // D was to be chosen, and is more than 4 E (SimplifyOptions::min_external_diameter).
  bool larger_diameter = false;
};

}  // namespace spherule
