// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/rounding.h"

#include <Eigen/Geometry>

#include <cmath>

namespace spherule::internal {

// The same rotation, rounded to nearest, with a quaternion of unit length, so that chains can be
// composed without renormalising. Returned as it is where it is unit already. Not zero, finite.
inline Eigen::Quaterniond unit_rotation(const Eigen::Quaterniond& q) {
  if (std::abs(q.coeffs().squaredNorm() - 1.0) <= 8.0 * kUnitRoundoff) return q;
  const double scale = q.coeffs().cwiseAbs().maxCoeff();
  return Eigen::Quaterniond(Eigen::Vector4d((q.coeffs() / scale).normalized()));
}

}  // namespace spherule::internal
