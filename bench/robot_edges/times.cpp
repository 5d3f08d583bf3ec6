// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/times.h"

#include "bench/clock.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace spherule {
namespace {

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return quantile(values, 0.5);
}

}  // namespace

void Times::take(std::size_t edge, double ns) {
  if (edge == each_.size()) each_.push_back(ns);
  each_[edge] = std::min(each_[edge], ns);
}

void Times::add(const Times& other) {
  each_.insert(each_.end(), other.each_.begin(), other.each_.end());
}

double Times::total() const {
  return std::accumulate(each_.begin(), each_.end(), 0.0);
}

double Times::mean_us() const {
  return 1e-3 * total() / static_cast<double>(each_.size());
}

double Times::median_us() const {
  return 1e-3 * median_of(each_);
}

double Times::median_over(const Times& others) const {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < each_.size(); ++i) ratios.push_back(each_[i] / others.each_[i]);
  return median_of(std::move(ratios));
}

}  // namespace spherule
