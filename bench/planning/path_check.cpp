// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/path_check.h"

#include <algorithm>
#include <cmath>

namespace spherule {

PathCheck check_path(const std::vector<Configuration>& path, const ContactTest& in_contact,
                     double step) {
  PathCheck result;
  const auto test = [&](const Configuration& at) {
    ++result.configurations;
    result.contacts += in_contact(at) ? 1 : 0;
  };
  if (!path.empty()) test(path.front());
  Configuration at;
  for (std::size_t i = 1; i < path.size(); ++i) {
    double most = 0.0;
    for (std::size_t k = 0; k < path[i].size(); ++k) {
      most = std::max(most, std::abs(path[i][k] - path[i - 1][k]));
    }
    const auto steps = std::max(1, static_cast<int>(std::ceil(most / step)));
    at.resize(path[i].size());
    for (int s = 1; s <= steps; ++s) {
      const double t = static_cast<double>(s) / steps;
      for (std::size_t k = 0; k < at.size(); ++k) {
        at[k] = (1.0 - t) * path[i - 1][k] + t * path[i][k];
      }
      test(at);
    }
  }
  return result;
}

}  // namespace spherule
