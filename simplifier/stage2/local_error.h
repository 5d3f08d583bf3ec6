// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/solid/zone_index.h"
#include "simplifier/zones.h"
#include "spheretree/rounding.h"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <vector>

namespace spherule::internal {

// E as a function of place. A sphere keeps the promise of all zones if, for each zone Z of its own
// error e, it protrudes by at most e or does not reach into Z:
//   r <= D(c) + e  or  r < dist(c, Z).
// With E elsewhere the largest such radius is D(c) + allowance(c, D(c)), where
//   allowance(c, d) = min(E, min over Z of max(e, dist(c, Z) - d)).
// It is continuous, so that the tolerances of the search can follow it.
class LocalError {
 public:
  LocalError(double max_error, std::span<const Zone> zones) : max_error_(max_error) {
    std::vector<Zone> with_error;
    std::copy_if(zones.begin(), zones.end(), std::back_inserter(with_error),
                 [](const Zone& zone) { return zone.max_error.has_value(); });
    zones_ = ZoneIndex(with_error);
  }

  // How far a sphere about `center` may protrude from S, of which the sphere of radius `clearance`
  // about it is a subset. Rounded down: a radius of at most clearance + allowance, the sum in exact
  // arithmetic, keeps the promise if it is less than the sum.
  double allowance(const Eigen::Vector3d& center, double clearance) const {
    double allowed = max_error_;
    zones_.near(center, clearance + allowed, [&](std::size_t i) {
      const double gap = sub_down(distance_lower(zones_[i].shape, center), clearance);
      allowed = std::min(allowed, std::max(*zones_[i].max_error, gap));
      return clearance + allowed;
    });
    return allowed;
  }

  // By how much lengths of a search that are shares of E shrink within `reach` of a point; 1
  // exactly where no zone is near.
  double scale(const Eigen::Vector3d& point, double reach = 0.0) const {
    return allowance(point, reach) / max_error_;
  }

 private:
  double max_error_;
  ZoneIndex zones_;
};

}  // namespace spherule::internal
