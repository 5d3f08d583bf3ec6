// SPDX-License-Identifier: BSD-3-Clause
#include "adapters/fcl/collide.h"
#include "base/error.h"

#include <string>

namespace spherule::fcl_api {

CoveredPart cover_part(const TriangleMesh& mesh, const ModelOptions& options) {
  const Simplification simplification = simplify(mesh, options.fit);
  const std::string broken = broken_promises(simplification);
  if (!broken.empty()) throw Error("cover", broken);
  CoveredPart part{.spheres = std::make_shared<const SphereTree>(sphere_tree(simplification)),
                   .certificate = simplification.certificate};
  if (options.confirm_on_triangles) {
    part.mesh = std::make_shared<const CoveredMesh>(mesh, part.spheres);
  }
  return part;
}

}  // namespace spherule::fcl_api
