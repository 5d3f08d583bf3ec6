// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace spherule::internal {

// The unit roundoff of single precision.
inline constexpr double kFloatRoundoff = 0x1p-24;

// The nearest number of single precision. A function that is not inlined: where g++ 12 vectorises
// the way there and back (at -O2, two numbers at once), it leaves it out.
// PackedTree.EverySphereHasRoomForTheInflatedSpheresBelow shows it.
double in_single_precision(double x);

// A number in single precision, not below the one given.
float rounded_up_to_single(double x);

}  // namespace spherule::internal
