// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/baseline/internal/solid_probe.h"
#include "geometry/mesh_distance.h"
#include "simplifier/solid/clearance.h"

namespace spherule::internal {

// The simplified solid S: its boundary is made of external spheres and faces of the box. Clearances
// inside are lower bounds; outside, the distance to a point of S found beyond the contact, or else
// to the mesh.
class SimplifiedProbe final : public SolidProbe {
 public:
  // Both must stay while this lives.
  SimplifiedProbe(const Clearance& clearance, const MeshDistance& distance)
      : clearance_(clearance), distance_(distance) {}

  double clearance(const Eigen::Vector3d& point) const override;
  Eigen::Vector3d nearest_boundary(const Eigen::Vector3d& point) const override;

 private:
  const Clearance& clearance_;
  const MeshDistance& distance_;
};

}  // namespace spherule::internal
