// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace spherule {

// The smallest rotation that takes `from` to `to`: Eigen's, which for opposite vectors holds a
// singular value decomposition and takes ten seconds wherever it is compiled.
Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace spherule
