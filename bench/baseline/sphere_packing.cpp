// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "bench/baseline/sphere_methods.h"
#include "simplifier/stage2/cover_moves.h"

#include <utility>

namespace spherule {

SpherePacking pack_spheres(const TriangleMesh& mesh, const SpherePackingOptions& options) {
  internal::check_max_error(options.max_error);
  if (!(options.closed_below >= 0.0 && options.closed_below <= kMaxCoordinate)) {
    throw Error("closed below", "must be finite and not negative");
  }
  ExternalOptions external;
  external.min_external_diameter =
      options.closed_below > 0.0 ? options.closed_below : options.max_error / 2.0;
  // Finer than this only the slack of closing would be smaller (ExternalOptions::grid_step).
  external.grid_step = external.min_external_diameter / 4.0;
  external.tightness = ExternalOptions::kNoTightness;
  external.padding = options.padding;
  external.threads = options.threads;
  external.progress = options.progress;
  SpherePacking result;
  result.solid = place_external_spheres(mesh, external);
  CoverOptions loop;
  loop.method = CoverMethod::kPaper;
  loop.max_error = options.max_error;
  loop.min_internal_diameter = options.seed_diameter;
  loop.seed = options.seed;
  loop.history = options.history;
  loop.threads = options.threads;
  loop.progress = options.progress;
  SphereCover packed = cover(mesh, result.solid, loop);
  result.spheres = std::move(packed.spheres_before_inflation);
  result.inflated = std::move(packed.spheres);
  result.error = packed.inflation;
  result.history = std::move(packed.history);
  result.seeds_rejected = packed.seeds_rejected;
  return result;
}

}  // namespace spherule
