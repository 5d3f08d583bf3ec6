// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>

namespace spherule::internal {

// An edge is sharp if the faces beside it form an angle of less than this, 150 degrees.
inline constexpr double kSharpAngle = 150.0 * (std::numbers::pi / 180.0);
inline constexpr double kCosineOfHalfSharp = 0.2588190451025207;

}  // namespace spherule::internal
