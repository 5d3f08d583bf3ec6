// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/path_check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace spherule {

PathCheck check_path(const std::vector<ArmPositions>& path, Checker& checker, double step) {
  std::vector<ArmPositions> fine;
  if (!path.empty()) fine.push_back(path.front());
  for (std::size_t i = 1; i < path.size(); ++i) {
    double most = 0.0;
    for (std::size_t k = 0; k < kJoints; ++k) {
      most = std::max(most, std::abs(path[i][k] - path[i - 1][k]));
    }
    const auto steps = std::max(1, static_cast<int>(std::ceil(most / step)));
    for (int s = 1; s <= steps; ++s) {
      const double t = static_cast<double>(s) / steps;
      fine.emplace_back();
      for (std::size_t k = 0; k < kJoints; ++k) {
        fine.back()[k] = (1.0 - t) * path[i - 1][k] + t * path[i][k];
      }
    }
  }
  std::vector<std::uint8_t> verdicts(fine.size());
  checker.check(fine, verdicts);
  return {fine.size(), static_cast<std::size_t>(std::count(verdicts.begin(), verdicts.end(), 1))};
}

}  // namespace spherule
