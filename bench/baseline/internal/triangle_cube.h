// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/rounding.h"

#include <Eigen/Geometry>

#include <array>

namespace spherule::internal {

using Triangle = std::array<Eigen::Vector3d, 3>;

// Whether `axis`, whose components are taken as exact, provably separates the closed cube about the
// origin from points whose coordinates `corners` have each been rounded once. A scalar product errs
// by less than 4 u times the sum of its terms' magnitudes, that rounding included; 8 u covers the
// rounding of the sum itself, too.
inline bool separates(const Eigen::Vector3d& axis, const Triangle& corners, double half) {
  const Eigen::Vector3d magnitude = axis.cwiseAbs();
  const double reach = half * magnitude.sum() * kRelativeUp;
  bool above = true;
  bool below = true;
  for (const Eigen::Vector3d& corner : corners) {
    const double at = axis.dot(corner);
    const double error = 8.0 * kUnitRoundoff * magnitude.dot(corner.cwiseAbs()) + kUnderflow;
    above = above && at - error > reach;
    below = below && at + error < -reach;
  }
  return above || below;
}

// False only if the closed triangle, which may be degenerate, and the closed cube of half the edge
// `half` about `center` are disjoint in exact arithmetic; true without need only within rounding of
// touching. Separating axes of Akenine-Moeller, "Fast 3D Triangle-Box Overlap Testing" (2001). An
// axis that has been rounded is another axis, and a plane across it separates just as well, so that
// only the projections need a margin.
inline bool may_intersect(const Triangle& triangle, const Eigen::Vector3d& center, double half) {
  using Eigen::Vector3d;
  const Triangle at = {triangle[0] - center, triangle[1] - center, triangle[2] - center};
  const Triangle edges = {at[1] - at[0], at[2] - at[1], at[0] - at[2]};
  for (int k = 0; k < 3; ++k) {
    if (separates(Vector3d::Unit(k), at, half)) return false;
  }
  if (separates(edges[0].cross(edges[1]), at, half)) return false;
  for (const Vector3d& edge : edges) {
    for (int k = 0; k < 3; ++k) {
      if (separates(Vector3d::Unit(k).cross(edge), at, half)) return false;
    }
  }
  return true;
}

}  // namespace spherule::internal
