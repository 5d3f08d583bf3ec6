// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cover.h"

#include "mesh/mesh_distance.h"
#include "mesh/triangle_mesh.h"
#include "simplifier/internal/stages.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/solid/usable_external.h"
#include "simplifier/stage2/cover_blocks.h"
#include "simplifier/stage2/cover_checks.h"
#include "simplifier/stage2/cover_fitter.h"
#include "simplifier/stage2/paper/internal_spheres.h"
#include "simplifier/support/stopwatch.h"
#include "simplifier/support/thread_limit.h"
#include "spheretree/rounding_mode.h"

#include <cstddef>
#include <optional>
#include <utility>

namespace spherule {

SphereCover cover(const TriangleMesh& mesh, const ExternalSpheres& external,
                  const CoverOptions& options) {
  validate(mesh, "mesh");
  internal::check_external(external);
  internal::check_options(options);
  const internal::ThreadLimit threads(options.threads);
  const MeshDistance distance(mesh);
  return internal::cover(mesh, distance, internal::Clearance(external), options);
}

SphereCover internal::cover(const TriangleMesh& mesh, const MeshDistance& distance,
                            const internal::Clearance& clearance, const CoverOptions& options,
                            std::size_t most_cells) {
  require_rounding_to_nearest();
  check_options(options);
  const ThreadLimit threads(options.threads);
  if (options.method == CoverMethod::kPaper) {
    refuse_error_zones(options, "paper");
    return internal::place_internal_spheres(mesh, distance, clearance, options);
  }
  SphereCover result;
  const Stopwatch watch;
  std::optional<CoverFitter> fitter(std::in_place, clearance, distance, options);
  if (fitter->divided().size() > most_cells) {
    CoverBlocks blocks(clearance, distance, options, fitter->divided().boxes(), watch);
    fitter.reset();
    result.spheres = blocks.run();
    return result;
  }
  result.spheres = fitter->run().spheres;
  result.lower_bound = fitter->lower_bound();
  return result;
}

}  // namespace spherule
