// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace spherule {

// The smallest rotation that takes `from` to `to`; of vectors that are opposite to within 1.4e-6
// rad, a half turn, which is off by as much. Otherwise as Eigen's FromTwoVectors(), whose singular
// value decomposition takes seven seconds wherever it is compiled.
Eigen::Quaterniond turn_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace spherule
