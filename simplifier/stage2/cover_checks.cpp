// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/cover_checks.h"

#include "simplifier/solid/solid_query.h"
#include "simplifier/zones.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <limits>

namespace spherule::internal {
namespace {

constexpr std::size_t kMaxSpheres = 2'000'000;

}  // namespace

void check_max_error(double max_error) {
  if (!(max_error > 0.0 && max_error <= kMaxCoordinate)) {
    throw Error("max error", "must be positive and at most 1e15");
  }
}

void check_options(const CoverOptions& options) {
  const auto usable = [](double x) { return x >= 0.0 && x <= kMaxCoordinate; };
  check_max_error(options.max_error);
  if (!usable(options.min_radius)) throw Error("min radius", "must be a number from 0 to 1e15");
  if (!usable(options.min_internal_diameter)) {
    throw Error("min internal diameter", "must be a number from 0 to 1e15");
  }
  check_zones(options.zones, options.max_error, std::numeric_limits<double>::infinity());
  if (options.effort < 0) throw Error("effort", "must not be negative");
  if (!usable(options.seconds)) throw Error("seconds", "must be a number from 0 to 1e15");
}

void refuse_error_zones(const CoverOptions& options, const std::string& method) {
  if (tightest_error(options.zones, options.max_error) < options.max_error) {
    throw Error("zones", "the method \"" + method + "\" knows one max error only");
  }
}

void check_resolved(const Clearance& clearance, double max_error, double share) {
  if (share * max_error < least_reach(clearance.box())) {
    throw Error("max error", "too small for coordinates of this size");
  }
}

void check_count(std::size_t spheres) {
  if (spheres > kMaxSpheres) {
    throw Error("max error", "too small for this model: more than two million spheres");
  }
}

}  // namespace spherule::internal
