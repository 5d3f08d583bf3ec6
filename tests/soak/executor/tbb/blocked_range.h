// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

// See parallel_for.h.
namespace tbb {

template <class Index>
class blocked_range {
 public:
  blocked_range(Index begin, Index end, std::size_t grainsize = 1)
      : begin_(begin), end_(end), grainsize_(grainsize) {}
  Index begin() const { return begin_; }
  Index end() const { return end_; }
  std::size_t grainsize() const { return grainsize_; }
  bool is_divisible() const { return grainsize_ < static_cast<std::size_t>(end_ - begin_); }

 private:
  Index begin_, end_;
  std::size_t grainsize_;
};

}  // namespace tbb
