// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace spherule::internal {

// Whether a gap along an axis, in units of its length, is more than a pad. False for axes of which
// the square is not far above the 2^-1075 that a product may lose to underflow: they prove nothing.
inline bool separates(const Eigen::Vector3d& axis, double gap, double pad) {
  constexpr double kShortestAxis = 0x1p-600;
  const double square = axis.squaredNorm();
  return gap > 0.0 && square >= kShortestAxis && gap * gap > square * (pad * pad);
}

}  // namespace spherule::internal
