// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cover.h"

#include "simplifier/internal/clearance.h"
#include "simplifier/internal/cover_checks.h"
#include "simplifier/internal/cover_fitter.h"
#include "simplifier/internal/internal_spheres.h"
#include "simplifier/internal/stages.h"
#include "simplifier/internal/thread_limit.h"
#include "simplifier/mesh_distance.h"
#include "spheretree/triangle_mesh.h"

namespace spherule {

SphereCover cover(const TriangleMesh& mesh, const ExternalSpheres& external,
                  const CoverOptions& options) {
  validate(mesh, "mesh");
  internal::check_options(options);
  const internal::ThreadLimit threads(options.threads);
  const MeshDistance distance(mesh);
  return internal::cover(mesh, distance, Clearance(external, distance), options);
}

SphereCover internal::cover(const TriangleMesh& mesh, const MeshDistance& distance,
                            const Clearance& clearance, const CoverOptions& options) {
  check_options(options);
  const ThreadLimit threads(options.threads);
  if (options.method == CoverMethod::kPaper) {
    refuse_error_zones(options, "paper");
    return place_internal_spheres(mesh, distance, clearance, options);
  }
  SphereCover result;
  CoverFitter fitter(clearance, distance, options);
  result.spheres = fitter.run();
  result.lower_bound = fitter.lower_bound();
  return result;
}

}  // namespace spherule
