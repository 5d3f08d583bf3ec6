// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/medial_ascent.h"

namespace spherule::internal {

std::vector<Eigen::Vector3d> ascend(const Clearance& clearance, const Eigen::Vector3d& start,
                                    const AscentOptions& options) {
  constexpr double kStoppingSlope = 0.6;
  constexpr int kMaxSteps = 200;
  std::vector<Eigen::Vector3d> path{start};
  ClearanceAt here = clearance(start, options.tolerance);
  double step = options.first_step;
  for (int i = 0; i < kMaxSteps && step >= options.least_step; ++i) {
    const Eigen::Vector3d next = path.back() + step * here.away;
    const ClearanceAt there = clearance(next, options.tolerance);
    if (there.lower - here.lower >= kStoppingSlope * step) {
      path.push_back(next);
      here = there;
      step *= 2.0;
    } else {
      step *= 0.5;
    }
  }
  return path;
}

}  // namespace spherule::internal
