// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace spherule {

// How long every edge took, in nanoseconds: the least of several times.
class Times {
 public:
  void add(double ns) { each_.push_back(ns); }
  // Of an edge that is known, or the next one.
  void take(std::size_t edge, double ns);
  void add(const Times& other);

  double total() const;
  double mean_us() const;
  double median_us() const;
  // How many times as long they took as others, for the same edges: in all, and the median.
  double over(const Times& others) const { return total() / others.total(); }
  double median_over(const Times& others) const;

 private:
  std::vector<double> each_;
};

}  // namespace spherule
