// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

// See parallel_for.h. The number of threads is not limited: the results do not depend on it.
namespace tbb {

class global_control {
 public:
  enum parameter { max_allowed_parallelism };
  global_control(parameter, std::size_t) {}
  static std::size_t active_value(parameter) { return 4; }
};

}  // namespace tbb
