// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cover.h"

#include "mesh/mesh_distance.h"
#include "mesh/triangle_mesh.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/stage2/cover_checks.h"
#include "simplifier/stage2/cover_fitter.h"
#include "simplifier/stage2/internal_spheres.h"
#include "simplifier/support/thread_limit.h"

namespace spherule {

SphereCover cover(const TriangleMesh& mesh, const ExternalSpheres& external,
                  const CoverOptions& options) {
  validate(mesh, "mesh");
  internal::check_options(options);
  if (options.method == CoverMethod::kPaper) internal::refuse_error_zones(options, "paper");
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
