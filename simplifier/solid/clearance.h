// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.h"
#include "base/rounding.h"
#include "geometry/sphere.h"
#include "simplifier/solid/nearest_cells.h"
#include "simplifier/types/simplification.h"

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>

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

// Throws Error for external spheres that stage 1 cannot have made: those that nobody filled in,
// whose box holds nothing, and numbers that are not finite or far too large. That they are of the
// mesh beside them is not known here.
inline void check_external(const ExternalSpheres& external) {
  // Coordinates, padding and diameters of as much as is allowed add up to less.
  constexpr double kLargest = 8.0 * kMaxCoordinate;
  const auto fits = [](double number) { return std::abs(number) <= kLargest; };
  for (int axis = 0; axis < 3; ++axis) {
    const double low = external.box.min()[axis];
    const double high = external.box.max()[axis];
    if (!fits(low) || !fits(high) || low > high) {
      throw Error("external spheres", "their box is empty or not finite");
    }
  }
  if (!(external.padding >= 0.0 && fits(external.padding))) {
    throw Error("external spheres", "their padding is negative or not finite");
  }
  for (std::size_t i = 0; i < external.spheres.size(); ++i) {
    const Sphere& sphere = external.spheres[i];
    if (!fits(sphere.center.x()) || !fits(sphere.center.y()) || !fits(sphere.center.z()) ||
        !(sphere.radius >= 0.0 && fits(sphere.radius))) {
      throw Error("external spheres", "sphere " + std::to_string(i) +
                                          " is not finite, too large, or of negative radius");
    }
  }
}

}  // namespace spherule::internal
