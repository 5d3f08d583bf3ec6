// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/solid/sphere_hierarchy.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace spherule::internal {

// A set of spheres that grows, with the nearest-sphere query of SphereHierarchy: most of the
// spheres are in a hierarchy, the last few in a list.
class SphereSet {
 public:
  void add(const Sphere& sphere) {
    spheres_.push_back(sphere);
    if (spheres_.size() - settled_ < std::max<std::size_t>(16, settled_ / 8)) return;
    hierarchy_ = SphereHierarchy(spheres_);
    settled_ = spheres_.size();
  }

  // Bounds of the least |p - c| - r, infinite for an empty set.
  NearestSphere nearest(const Eigen::Vector3d& point) const {
    NearestSphere best = hierarchy_.nearest(point);
    for (std::size_t i = settled_; i < spheres_.size(); ++i) {
      const Sphere& s = spheres_[i];
      best.lower = std::min(best.lower, sub_down(distance_lower(point, s.center), s.radius));
      const double upper = sub_up(distance_upper(point, s.center), s.radius);
      if (upper < best.upper) {
        best.upper = upper;
        best.index = static_cast<std::int32_t>(i);
      }
    }
    return best;
  }

  const std::vector<Sphere>& spheres() const { return spheres_; }

 private:
  std::vector<Sphere> spheres_;
  SphereHierarchy hierarchy_;
  std::size_t settled_ = 0;
};

}  // namespace spherule::internal
