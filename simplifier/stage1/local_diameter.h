// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/solid/zone_index.h"
#include "simplifier/zones.h"

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// D as a function of place, as radii, and the grid steps that follow it. At a point x a sphere of
// radius rho(x) has to have room: D / 2, or d / 2 in a zone of its own d, the least of them where
// zones overlap. Zones are closed and convex, so the segment between two points of one zone
// needs no more than that zone requires.
class LocalDiameter {
 public:
  // A zone's grid step is `step` halved as often as it takes to be no longer than
  // `zone_steps[i]`.
  LocalDiameter(double diameter, double step, std::span<const Zone> zones,
                std::span<const double> zone_steps);

  // Where no zone requires less.
  double radius() const { return radius_; }
  // What a zone requires.
  double radius_of(std::uint32_t zone) const { return parts_[zone].radius; }
  // Of all places.
  double least_radius() const { return least_radius_; }

  // A radius with the number of the zone that requires it, kNoZone if none does.
  struct Needed {
    double radius;
    std::uint32_t zone;
  };
  static constexpr std::uint32_t kNoZone = 0xffffffff;

  // Never less than rho at the point (rounding may take it for a point beside a zone).
  Needed at(const Eigen::Vector3d& point) const { return needed(point, point); }
  // Never less than rho at any point of the segment: of the zones that hold both ends, the
  // least that one requires. It is at least what at() says of either end, and just that if both
  // ends need it by the same zone, or one of them by none.
  double on_segment(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    return needed(from, to).radius;
  }
  // Of all points within `reach` of the center: never more than the least rho, and never less than
  // the greatest; and how often the grid step is to be halved for them.
  struct Near {
    double least;
    double greatest;
    int halvings;
  };
  Near near(const Eigen::Vector3d& center, double reach) const;

  // Of all zones.
  int most_halvings() const { return most_halvings_; }

 private:
  struct Part {
    double radius;
    int halvings;
  };

  Needed needed(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  double radius_;
  double least_radius_;
  int most_halvings_ = 0;
  ZoneIndex zones_;
  std::vector<Part> parts_;  // as the zones
};

}  // namespace spherule::internal
