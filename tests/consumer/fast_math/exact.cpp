// SPDX-License-Identifier: BSD-3-Clause
// The oracle of main.cpp, which declares it.
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace exact {

using Point = std::array<double, 3>;

namespace {

// To within 4 units of long double's rounding; what is asked for is told with that share of doubt.
long double distance(const Point& a, const Point& b) {
  const auto difference = [&](std::size_t i) {
    return static_cast<long double>(a[i]) - static_cast<long double>(b[i]);
  };
  return std::hypot(difference(0), difference(1), difference(2));
}

constexpr long double kDoubt = 8.0L * std::numeric_limits<long double>::epsilon();

}  // namespace

double not_a_number() {
  return std::numeric_limits<double>::quiet_NaN();
}

double infinity() {
  return std::numeric_limits<double>::infinity();
}

bool flushes_to_zero() {
  volatile double least = std::numeric_limits<double>::min();
  return least / 2.0 == 0.0;
}

bool is_at_least(const Point& a, const Point& b, double lower) {
  return distance(a, b) * (1.0L + kDoubt) >= lower;
}

bool is_at_most(const Point& a, const Point& b, double add, double upper) {
  return (distance(a, b) + add) * (1.0L - kDoubt) <= upper;
}

bool is_not_below(double sum, double a, double b) {
  return static_cast<long double>(a) + b <= sum;
}

bool is_not_above(double sum, double a, double b) {
  return static_cast<long double>(a) + b >= sum;
}

}  // namespace exact
