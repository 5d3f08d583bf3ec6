// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/solid/medial_ascent.h"

#include <cmath>

namespace spherule::internal {

std::vector<AscentStep> ascend(const Clearance& clearance, const Eigen::Vector3d& start,
                               const AscentOptions& options) {
  constexpr double kStoppingSlope = 0.6;
  constexpr int kMaxSteps = 200;
  ClearanceAt here = clearance(start);
  std::vector<AscentStep> path{{start, here.lower}};
  double step = options.first_step;
  for (int i = 0; i < kMaxSteps && step >= options.least_step; ++i) {
    const Eigen::Vector3d next = path.back().point + step * here.away;
    // The clearance cannot grow faster than the point moves, which gives the search a limit.
    const double limit = (here.upper + step) + 1e-9 * (std::abs(here.upper) + step);
    const ClearanceAt there = clearance(next, limit);
    if (there.lower - here.lower >= kStoppingSlope * step) {
      path.push_back({next, there.lower});
      here = there;
      step *= 2.0;
    } else {
      step *= 0.5;
    }
  }
  return path;
}

}  // namespace spherule::internal
