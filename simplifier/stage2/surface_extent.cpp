// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/surface_extent.h"

namespace spherule::internal {
namespace {

constexpr double kSlack = 0.2;  // of E: the sphere may protrude by so much
constexpr double kFactor = 1.4;

}  // namespace

bool touched_by(const Clearance& clearance, const Eigen::Vector3d& point, const ClearanceAt& at,
                double inside, double max_error) {
  const double way = inside - at.lower;
  if (way <= 0.0) return true;
  return clearance.is_at_least(point + way * at.away, inside - kSlack * max_error);
}

double cap_width_at(const Clearance& clearance, const Eigen::Vector3d& point, const ClearanceAt& at,
                    double max_error) {
  double width = max_error;
  while (width * kFactor <= kWidestCap * max_error &&
         touched_by(clearance, point, at, inside_radius(width * kFactor, max_error), max_error)) {
    width *= kFactor;
  }
  return width;
}

}  // namespace spherule::internal
