// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.h"
#include "base/rounding.h"

namespace spherule::internal {

// Edge of a cube whose circumscribed sphere, with its margins for rounding, is nowhere further than
// `max_error` from any point of the cube.
inline double edge_for_error(double max_error) {
  return max_error * (0.5773502691896257 * (1.0 - 0x1p-10));
}

inline void check_padding(double padding) {
  if (!(padding >= 0.0 && padding <= kMaxCoordinate)) {
    throw Error("padding", "must be finite and not negative");
  }
}

}  // namespace spherule::internal
