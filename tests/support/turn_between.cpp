// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/turn_between.h"

#include <cmath>

namespace spherule {
namespace {

constexpr double kOpposite = -1.0 + 1e-12;  // a cosine

}  // namespace

Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized();
  const Eigen::Vector3d b = to.normalized();
  const double cosine = b.dot(a);
  Eigen::Quaterniond turn;
  if (cosine < kOpposite) {
    turn.w() = 0.0;
    turn.vec() = a.unitOrthogonal();
    return turn;
  }
  const double twice_w = std::sqrt((1.0 + cosine) * 2.0);
  turn.w() = twice_w * 0.5;
  turn.vec() = a.cross(b) * (1.0 / twice_w);
  return turn;
}

}  // namespace spherule
