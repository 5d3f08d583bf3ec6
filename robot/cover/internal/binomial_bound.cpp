// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/internal/binomial_bound.h"

#include <cmath>

namespace spherule::internal {
namespace {

constexpr int kHalvings = 60;

// Of at most `hits` hits, by the logarithms of the terms: no term of a large sample underflows.
double probability_of_so_few(std::size_t hits, std::size_t trials, double share) {
  const double odds = std::log(share) - std::log1p(-share);
  double term = static_cast<double>(trials) * std::log1p(-share);
  double sum = std::exp(term);
  for (std::size_t i = 0; i < hits; ++i) {
    term += odds + std::log(static_cast<double>(trials - i) / static_cast<double>(i + 1));
    sum += std::exp(term);
  }
  return sum;
}

}  // namespace

double share_upper_bound(std::size_t hits, std::size_t trials, double confidence) {
  if (hits >= trials) return 1.0;
  double low = 0.0;
  double high = 1.0;
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (probability_of_so_few(hits, trials, middle) > 1.0 - confidence ? low : high) = middle;
  }
  return high;
}

}  // namespace spherule::internal
