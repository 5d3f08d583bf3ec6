// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The options of simplify(), and what is derived from them. Terms: docs/guarantee.md.
//
// @code{.cpp}
// #include <spherule/simplifier/types/simplify_options.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<spherule::Sphere> tool{{{0, 0, 0}, 5}, {{0, 0, 40}, 8}};
// const spherule::SimplifyOptions options{.max_error = 1,
//                                         .min_external_diameter = spherule::tool_diameter(tool)};
// assert(spherule::external_options(options).min_external_diameter == 10);
// @endcode

#include "base/progress.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/types/cover.h"
#include "simplifier/types/external_spheres.h"
#include "simplifier/types/zones.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

namespace spherule {

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
  // The E of each level of detail to fit above the cover (levels.h), in any order. None may be
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
  // D is smaller along sharp concave edges too (concave_edges.h).
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

}  // namespace spherule
