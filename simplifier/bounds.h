// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Bounds of a length.
//
// @code{.cpp}
// #include <spherule/simplifier/bounds.h>
// #include <cassert>
//
// const spherule::Bounds depth{.lower = 0.1, .upper = 0.2};
// assert(depth.upper - depth.lower < 0.11);
// @endcode

namespace spherule {

// A lower and an upper bound of a length: proved in a Certificate, true up to rounding in a
// MeshDeviation (baseline/mesh_deviation.h).
struct Bounds {
  double lower = 0.0;
  double upper = 0.0;
};

}  // namespace spherule
