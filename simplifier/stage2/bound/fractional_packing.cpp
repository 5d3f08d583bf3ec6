// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/bound/fractional_packing.h"

#include "simplifier/support/parallel.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spherule::internal {
namespace {

using Values = std::vector<double>;

constexpr int kPeriod = 60;  // steps between restarts
constexpr double kLargestBalance = 10.0;

// For each list the sum of the values that it names.
Values sums(const std::vector<FractionalPacking::Set>& lists, const Values& values) {
  Values result(lists.size());
  parallel_for(0, lists.size(), [&](std::size_t i) {
    double sum = 0.0;
    for (const std::uint32_t k : lists[i]) sum += values[k];
    result[i] = sum;
  });
  return result;
}

// Of the change, in the metric of the steps.
double change(const std::vector<FractionalPacking::Set>& lists, const Values& a, const Values& b) {
  double squared = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    squared += static_cast<double>(lists[i].size()) * (a[i] - b[i]) * (a[i] - b[i]);
  }
  return std::sqrt(squared);
}

}  // namespace

FractionalPacking::FractionalPacking(std::size_t points)
    : sets_of_(points), now_{Values(points, 0.0), {}} {}

void FractionalPacking::add(std::vector<Set> sets) {
  for (Set& set : sets) {
    if (set.empty()) continue;
    for (const std::uint32_t p : set) {
      sets_of_[p].push_back(static_cast<std::uint32_t>(points_of_.size()));
    }
    points_of_.push_back(std::move(set));
  }
  now_.cover.resize(points_of_.size(), 0.0);
}

Values FractionalPacking::loads(const Values& weights) const {
  return sums(points_of_, weights);
}

Values FractionalPacking::covered_by(const Values& cover) const {
  return sums(sets_of_, cover);
}

void FractionalPacking::step(Values& extrapolated) {
  const Values load = loads(now_.weights);
  parallel_for(0, load.size(), [&](std::size_t s) {
    const double size = balance_ * static_cast<double>(points_of_[s].size());
    const double next = std::max(0.0, now_.cover[s] - (1.0 - load[s]) / size);
    extrapolated[s] = 2.0 * next - now_.cover[s];
    now_.cover[s] = next;
  });
  const Values covered = covered_by(extrapolated);
  parallel_for(0, covered.size(), [&](std::size_t p) {
    if (sets_of_[p].empty()) return;
    const double size = balance_ / static_cast<double>(sets_of_[p].size());
    now_.weights[p] = std::max(0.0, now_.weights[p] + size * (1.0 - covered[p]));
  });
}

void FractionalPacking::restart(Iterate& mean, int steps) {
  const auto take = [steps](Values& now, Values& sum) {
    for (std::size_t i = 0; i < now.size(); ++i) now[i] = sum[i] / steps;
    std::fill(sum.begin(), sum.end(), 0.0);
  };
  take(now_.weights, mean.weights);
  take(now_.cover, mean.cover);
  const double up = change(sets_of_, now_.weights, last_.weights);
  const double down = change(points_of_, now_.cover, last_.cover);
  if (up > 0.0 && down > 0.0) {
    balance_ = std::clamp(std::sqrt(balance_ * up / down), 1.0 / kLargestBalance, kLargestBalance);
  }
  last_ = now_;
}

void FractionalPacking::solve(int steps, const std::stop_token& stop) {
  last_ = now_;
  Iterate sum{Values(now_.weights.size(), 0.0), Values(now_.cover.size(), 0.0)};
  Values extrapolated(now_.cover.size());
  int since = 0;
  for (int i = 0; i < steps && !stop.stop_requested(); ++i) {
    step(extrapolated);
    for (std::size_t p = 0; p < now_.weights.size(); ++p) sum.weights[p] += now_.weights[p];
    for (std::size_t s = 0; s < now_.cover.size(); ++s) sum.cover[s] += now_.cover[s];
    if (++since == kPeriod) {
      restart(sum, since);
      since = 0;
    }
  }
}

// Each is divided by the load of the heaviest set that holds the point: twice, as this raises what
// is then too light.
Values FractionalPacking::weights() const {
  Values weights = now_.weights;
  for (int i = 0; i < 2; ++i) {
    const Values load = loads(weights);
    parallel_for(0, weights.size(), [&](std::size_t p) {
      double heaviest = 0.0;
      for (const std::uint32_t s : sets_of_[p]) heaviest = std::max(heaviest, load[s]);
      weights[p] = heaviest > 0.0 ? weights[p] / heaviest : 0.0;
    });
  }
  return weights;
}

}  // namespace spherule::internal
