// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cover.h"

#include "simplifier/clearance.h"
#include "simplifier/internal_spheres.h"

namespace spherule {

SphereCover cover(const TriangleMesh& mesh, const ExternalSpheres& external,
                  const CoverOptions& options) {
  return place_internal_spheres(mesh, Clearance(external), options);
}

}  // namespace spherule
