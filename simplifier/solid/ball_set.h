// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/solid/ball_hierarchy.h"

#include <algorithm>
#include <vector>

namespace spherule::internal {

// A set of balls that grows, with the nearest-ball query of BallHierarchy: most of the balls are in
// a hierarchy, the last few in a list.
class BallSet {
 public:
  void add(const Sphere& ball) {
    balls_.push_back(ball);
    if (balls_.size() - settled_ < std::max<std::size_t>(16, settled_ / 8)) return;
    hierarchy_ = BallHierarchy(balls_);
    settled_ = balls_.size();
  }

  // Bounds of the least |p - c| - r, infinite for an empty set.
  NearestBall nearest(const Eigen::Vector3d& point) const {
    NearestBall best = hierarchy_.nearest(point);
    for (std::size_t i = settled_; i < balls_.size(); ++i) {
      const Sphere& s = balls_[i];
      best.lower = std::min(best.lower, sub_down(distance_lower(point, s.center), s.radius));
      const double upper = sub_up(distance_upper(point, s.center), s.radius);
      if (upper < best.upper) {
        best.upper = upper;
        best.index = static_cast<std::int32_t>(i);
      }
    }
    return best;
  }

  const std::vector<Sphere>& balls() const { return balls_; }

 private:
  std::vector<Sphere> balls_;
  BallHierarchy hierarchy_;
  std::size_t settled_ = 0;
};

}  // namespace spherule::internal
