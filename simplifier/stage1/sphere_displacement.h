// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_distance.h"
#include "spheretree/rounding.h"
#include "spheretree/sphere.h"

#include <algorithm>

namespace spherule::internal {

// Whether a sphere of radius rho can provably be displaced along the segment between the centres of
// two spheres that are free of the mesh grown by the padding: by bisection, up to 2^8 pieces. On a
// piece of length g between clearances c1 and c2 the clearance is at least (c1 + c2 - g) / 2. It
// fails only where the clearance comes below rho + (length of the displacement) / 2^8 somewhere.
class SphereDisplacement {
 public:
  // Of a bound of a distance that is passed to MeshDistance as a limit: usually more than all
  // roundings. Where it is not, the limit is returned as the lower bound: true, but less room.
  static constexpr double kLimitUp = 1.0 + 1e-5;

  SphereDisplacement(const MeshDistance& distance, double padding)
      : distance_(distance), padding_(padding) {}

  static constexpr int kMostBisections = 8;
  bool is_free(const Sphere& a, const Sphere& b, double rho,
               int bisections = kMostBisections) const {
    const double gap = distance_upper(a.center, b.center);
    if (sub_down(add_down(a.radius, b.radius), gap) >= 2.0 * rho * kRelativeUp) return true;
    if (bisections == 0) return false;
    Sphere middle{(a.center + b.center) / 2.0, 0.0};
    // Usually the surface is no further from there.
    const double limit = (std::min(a.radius, b.radius) + padding_ + 0.5 * gap) * kLimitUp;
    middle.radius = sub_down(distance_(middle.center, limit).lower, padding_);
    return middle.radius >= rho && is_free(a, middle, rho, bisections - 1) &&
           is_free(middle, b, rho, bisections - 1);
  }

 private:
  const MeshDistance& distance_;
  double padding_;
};

}  // namespace spherule::internal
