// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/local_diameter.h"

#include <algorithm>
#include <cmath>

namespace spherule::internal {

using Eigen::Vector3d;

LocalDiameter::LocalDiameter(double diameter, double step, std::span<const Zone> zones,
                             std::span<const double> zone_steps)
    : radius_(diameter / 2.0), zones_(zones) {
  for (std::size_t i = 0; i < zones.size(); ++i) {
    Part part{zones[i].min_external_diameter.value_or(diameter) / 2.0, 0};
    // So many are refused by whoever makes the grid.
    constexpr int kMostHalvings = 64;
    while (part.halvings < kMostHalvings && std::ldexp(step, -part.halvings) > zone_steps[i]) {
      ++part.halvings;
    }
    most_halvings_ = std::max(most_halvings_, part.halvings);
    parts_.push_back(part);
  }
}

double LocalDiameter::at(const Vector3d& point) const {
  return on_way(point, point);
}

double LocalDiameter::on_way(const Vector3d& from, const Vector3d& to) const {
  double needed = radius_;
  zones_.near(from, 0.0, [&](std::size_t i) {
    if (parts_[i].radius < needed && certainly_contains(zones_[i].shape, from) &&
        certainly_contains(zones_[i].shape, to)) {
      needed = parts_[i].radius;
    }
    return 0.0;
  });
  return needed;
}

LocalDiameter::Near LocalDiameter::near(const Vector3d& center, double reach) const {
  Near result{radius_, radius_, 0};
  zones_.near(center, reach, [&](std::size_t i) {
    const ZoneShape& shape = zones_[i].shape;
    if (distance_lower(shape, center) > reach) return reach;
    result.least = std::min(result.least, parts_[i].radius);
    result.halvings = std::max(result.halvings, parts_[i].halvings);
    if (parts_[i].radius < result.greatest && certainly_contains(shape, center, reach)) {
      result.greatest = parts_[i].radius;
    }
    return reach;
  });
  return result;
}

}  // namespace spherule::internal
