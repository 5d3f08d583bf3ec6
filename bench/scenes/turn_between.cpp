// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenes/turn_between.h"

namespace spherule {

Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace spherule
