// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage1/local_diameter.h"

#include <algorithm>
#include <cmath>

namespace spherule::internal {

using Eigen::Vector3d;

LocalDiameter::LocalDiameter(double diameter, double step, std::span<const Zone> zones,
                             std::span<const double> zone_steps)
    : radius_(diameter / 2.0), least_radius_(radius_), zones_(zones) {
  for (std::size_t i = 0; i < zones.size(); ++i) {
    Part part{zones[i].min_external_diameter.value_or(diameter) / 2.0, 0};
    // So many are refused by whoever makes the grid.
    constexpr int kMostHalvings = 64;
    while (part.halvings < kMostHalvings && std::ldexp(step, -part.halvings) > zone_steps[i]) {
      ++part.halvings;
    }
    most_halvings_ = std::max(most_halvings_, part.halvings);
    least_radius_ = std::min(least_radius_, part.radius);
    parts_.push_back(part);
  }
}

LocalDiameter::Needed LocalDiameter::needed(const Vector3d& from, const Vector3d& to) const {
  Needed least{radius_, kNoZone};
  zones_.holding(from, to, [&](std::size_t i) {
    if (parts_[i].radius < least.radius && certainly_contains(zones_[i].shape, from) &&
        (from == to || certainly_contains(zones_[i].shape, to))) {
      least = {parts_[i].radius, static_cast<std::uint32_t>(i)};
    }
  });
  return least;
}

LocalDiameter::Near LocalDiameter::near(const Vector3d& center, double reach) const {
  Near result{radius_, radius_, 0};
  zones_.near(center, reach, [&](std::size_t i) {
    const ZoneShape& shape = zones_[i].shape;
    // A zone that would change nothing need not be examined.
    if (parts_[i].radius >= result.greatest && parts_[i].halvings <= result.halvings &&
        parts_[i].radius >= result.least) {
      return reach;
    }
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
