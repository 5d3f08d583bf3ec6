// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "simplifier/baseline/internal/solid_probe.h"
#include "simplifier/solid/clearance.h"

namespace spherule::internal {

// The simplified solid S: its boundary is made of external spheres and faces of the box. Clearances
// inside are lower bounds, within `tolerance`; outside, the distance to a point of S found beyond
// the contact, or else to the mesh.
class SimplifiedProbe final : public SolidProbe {
 public:
  // Both must stay while this lives.
  SimplifiedProbe(const Clearance& clearance, const MeshDistance& distance, double tolerance)
      : clearance_(clearance), distance_(distance), tolerance_(tolerance) {}

  double clearance(const Eigen::Vector3d& point) const override;
  Eigen::Vector3d nearest_boundary(const Eigen::Vector3d& point) const override;

 private:
  const Clearance& clearance_;
  const MeshDistance& distance_;
  double tolerance_;
};

}  // namespace spherule::internal
