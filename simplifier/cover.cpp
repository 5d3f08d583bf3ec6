// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cover.h"

#include "simplifier/internal/clearance.h"
#include "simplifier/internal/cover_fitter.h"
#include "simplifier/internal/internal_spheres.h"
#include "simplifier/internal/thread_limit.h"
#include "simplifier/mesh_distance.h"
#include "spheretree/error.h"
#include "spheretree/triangle_mesh.h"

#include <limits>

namespace spherule {
namespace {

void check_options(const CoverOptions& options) {
  const auto usable = [](double x) { return x >= 0.0 && x <= kMaxCoordinate; };
  if (!(usable(options.max_error) && options.max_error > 0.0)) {
    throw Error("max error", "must be positive and finite");
  }
  if (!usable(options.min_radius)) throw Error("min radius", "must be finite and not negative");
  if (!usable(options.min_internal_diameter)) {
    throw Error("min internal diameter", "must be finite and not negative");
  }
  check_zones(options.zones, options.max_error, std::numeric_limits<double>::infinity());
  if (options.method == CoverMethod::kPaper &&
      tightest_error(options.zones, options.max_error) < options.max_error) {
    throw Error("zones", "the method \"paper\" knows one max error only");
  }
  if (options.effort < 0) throw Error("effort", "must not be negative");
  if (!usable(options.seconds)) throw Error("seconds", "must be finite and not negative");
}

}  // namespace

SphereCover cover(const TriangleMesh& mesh, const ExternalSpheres& external,
                  const CoverOptions& options) {
  validate(mesh, "mesh");
  check_options(options);
  const internal::ThreadLimit threads(options.threads);
  const MeshDistance distance(mesh);
  const Clearance clearance(external, distance);
  if (options.method == CoverMethod::kPaper) {
    return place_internal_spheres(mesh, clearance, options);
  }
  SphereCover result;
  internal::CoverFitter fitter(clearance, distance, options);
  result.spheres = fitter.run();
  result.lower_bound = fitter.lower_bound();
  return result;
}

}  // namespace spherule
