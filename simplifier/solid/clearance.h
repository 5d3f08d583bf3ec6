// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "simplifier/external_spheres.h"
#include "simplifier/solid/sphere_hierarchy.h"

#include <Eigen/Geometry>

#include <limits>
#include <vector>

namespace spherule::internal {

// Clearance of a point to the outside of S: the least gap to an external sphere or to a face of the
// box. Not negative exactly for the points of S, where it is the distance to the outside of S.
struct ClearanceAt {
  // Bounds of the exact value.
  double lower = 0.0;
  double upper = 0.0;
  // Unit direction away from the nearest contact: moving there raises the clearance at rate 1 until
  // another contact takes over.
  Eigen::Vector3d away = Eigen::Vector3d::UnitX();
};

// Safe to share between threads.
class Clearance {
 public:
  explicit Clearance(const ExternalSpheres& external);
  // The same answers, within the tolerance: `distance`, to the mesh that the external spheres
  // touch, makes them faster.
  Clearance(const ExternalSpheres& external, const MeshDistance& distance);

  // With a tolerance the bounds may be that far apart; with a limit, clearances beyond it are not
  // told apart (`lower` is then at most the limit). Both make the search much faster.
  ClearanceAt operator()(const Eigen::Vector3d& point, double tolerance = 0.0,
                         double limit = std::numeric_limits<double>::infinity()) const;

  const Eigen::AlignedBox3d& box() const { return box_; }
  // Radius of the smallest external sphere; infinite if there is none.
  double least_external() const { return least_external_; }

 private:
  Clearance(const ExternalSpheres& external, SphereHierarchy spheres);

  std::vector<Eigen::Vector3d> centers_;
  SphereHierarchy spheres_;
  Eigen::AlignedBox3d box_;
  double least_external_;
};

}  // namespace spherule::internal
