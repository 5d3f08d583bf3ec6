// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/clearance.h"

#include "spheretree/rounding.h"

#include <limits>

namespace spherule {

using Eigen::Vector3d;

Clearance::Clearance(const ExternalSpheres& external) : balls_(external.balls), box_(external.box) {
  centers_.reserve(external.balls.size());
  for (const Sphere& s : external.balls) centers_.push_back(s.center);
}

// A face of the box is an external ball of infinite radius; its gap is a single difference.
ClearanceAt Clearance::operator()(const Vector3d& point, double tolerance, double limit) const {
  ClearanceAt result;
  double nearest = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = point[axis] - box_.min()[axis];
    const double high = box_.max()[axis] - point[axis];
    if (low < nearest) {
      nearest = low;
      result.away = Vector3d::Unit(axis);
    }
    if (high < nearest) {
      nearest = high;
      result.away = -Vector3d::Unit(axis);
    }
  }
  // The difference of two doubles is rounded to zero only if they are equal.
  result.lower = nearest == 0.0 ? 0.0 : next_down(nearest);
  result.upper = nearest == 0.0 ? 0.0 : next_up(nearest);
  const internal::NearestBall ball = balls_.nearest(point, std::min(nearest, limit), tolerance);
  if (ball.index < 0) {
    if (!balls_.empty()) result.lower = std::min(result.lower, ball.lower);
    return result;
  }
  result.lower = std::min(result.lower, ball.lower);
  result.upper = std::min(result.upper, ball.upper);
  const Vector3d d = point - centers_[static_cast<std::size_t>(ball.index)];
  const double norm = d.norm();
  if (norm > 0.0) result.away = d / norm;
  return result;
}

}  // namespace spherule
