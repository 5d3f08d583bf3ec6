// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace spherule {

// Robots are stored in metres; people are told millimetres.
inline constexpr double kMillimetresPerMetre = 1000.0;

}  // namespace spherule
