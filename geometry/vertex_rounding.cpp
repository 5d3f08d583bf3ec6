// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/vertex_rounding.h"

#include "base/error.h"
#include "base/rounding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace spherule::internal {

double largest_coordinate(const TriangleMesh& mesh) {
  double largest = 0.0;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    for (const double x : {v.x(), v.y(), v.z()}) {
      if (std::isnan(x)) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, std::abs(x));
    }
  }
  return largest;
}

double rounding_distance(double largest, double relative) {
  constexpr double kRootOfThree = 1.7320508075688774;  // rounded up
  // Of the smallest numbers rounding changes more, and so does that of the product.
  constexpr double kSmallest = 0x1p-960;
  return kRootOfThree * std::max(largest, kSmallest) * relative * (1.0 + 0x1p-50);
}

void check_scale(double scale) {
  if (!(scale > 0.0) || !std::isfinite(scale)) {
    throw Error("scale", "must be a positive finite number, not " + std::to_string(scale));
  }
}

void apply_scale(TriangleMesh& mesh, double scale) {
  if (scale == 1.0) return;
  for (Eigen::Vector3d& v : mesh.vertices) v *= scale;
  mesh.vertex_error = add_up(mul_up(mesh.vertex_error, scale),
                             rounding_distance(largest_coordinate(mesh), 2.0 * kUnitRoundoff));
}

}  // namespace spherule::internal
