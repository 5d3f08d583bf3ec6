// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace spherule::internal {

// What the methods that work with medial spheres query about a solid, in plain double: it serves
// searches, never a proof. Safe to share between threads.
class SolidProbe {
 public:
  virtual ~SolidProbe() = default;

  // Distance to the boundary, negative outside of the solid. A sphere of radius r about the point
  // protrudes from the solid by at most r minus this.
  virtual double clearance(const Eigen::Vector3d& point) const = 0;

  // The point of the boundary that is nearest to one inside.
  virtual Eigen::Vector3d nearest_boundary(const Eigen::Vector3d& point) const = 0;
};

}  // namespace spherule::internal
