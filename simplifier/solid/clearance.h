// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/external_spheres.h"
#include "simplifier/solid/nearest_cells.h"
#include "spheretree/sphere.h"

#include <Eigen/Geometry>

#include <limits>
#include <memory>

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
  // The external sphere that is nearest; null where that is a face of the box, or all clearances
  // are beyond the limit. As long-lived as the Clearance and its copies.
  const Sphere* contact = nullptr;
};

// Safe to share between threads.
class Clearance {
 public:
  explicit Clearance(const ExternalSpheres& external);

  // With a limit, clearances beyond it are not told apart (`lower` is then at most the limit),
  // which makes the search faster.
  ClearanceAt operator()(const Eigen::Vector3d& point,
                         double limit = std::numeric_limits<double>::infinity()) const;

  // Whether the clearance is at least `least`, in plain double: for searches, never for a proof.
  bool is_at_least(const Eigen::Vector3d& point, double least) const;

  const Eigen::AlignedBox3d& box() const { return box_; }
  // Radius of the smallest external sphere; infinite if there is none.
  double least_external() const { return least_external_; }

 private:
  // Of the external spheres; copies share them.
  std::shared_ptr<const NearestCells> cells_;
  Eigen::AlignedBox3d box_;
  double least_external_;
};

}  // namespace spherule::internal
