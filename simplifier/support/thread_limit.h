// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

namespace spherule::internal {

// While it lives, parallel loops use at most `threads` threads; 0 leaves the limit as it is.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();

 private:
  struct Control;
  std::unique_ptr<const Control> control_;
};

}  // namespace spherule::internal
