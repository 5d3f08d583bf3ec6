// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/global_control.h>

#include <cstddef>

namespace spherule::internal {

// While it lives, parallel loops use at most `threads` threads; 0 leaves the limit as it is.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads)
      : control_(tbb::global_control::max_allowed_parallelism,
                 threads > 0 ? static_cast<std::size_t>(threads)
                             : tbb::global_control::active_value(
                                   tbb::global_control::max_allowed_parallelism)) {}

 private:
  tbb::global_control control_;
};

}  // namespace spherule::internal
