// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/rounding.h"
#include "spheretree/sphere.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace spherule::internal {

// Of a shorter vector no direction can be computed: its square underflows.
inline constexpr double kLeastNorm = 1e-100;

// The least of |p - c| - r over a set of spheres: negative inside of the union, where its absolute
// value is the depth in the deepest sphere; outside, the distance to the union.
struct NearestSphere {
  double lower = std::numeric_limits<double>::infinity();  // bounds of the exact value
  double upper = std::numeric_limits<double>::infinity();
  std::int32_t index =
      -1;  // a sphere that attains it, up to rounding; -1 if none is nearer than requested
};

// The least of the values sqrt(|p - c|^2) - r, as computed, below a limit, and the smallest index
// of the spheres that have it: the same in whatever order spheres are examined, and whether or not
// those with larger values are.
//
// With d the exact distance, the computed v errs by at most 3.5 u d + u |v|, which is below
// 8 u (|v| + r), up to underflow.
class LeastGap {
 public:
  explicit LeastGap(double limit) : value_(limit) {}

  void examine(const Eigen::Vector3d& point, const Sphere& sphere, std::int32_t index) {
    const double squared = (point - sphere.center).squaredNorm();
    // Saves the root. A v that is not above the value has sqrt(squared) <= (1 + u) s for a root s,
    // as computed, of at most value + r + u |v|. If v >= 0, u |v| <= u s; else |v| <= r. So it is
    // at most (1 + 3 u) (value + r + u r), of which `reach` is no less than (1 - 2 u) times; 32 u
    // cover the square of the ratio and the three roundings of the test.
    constexpr double kSlack = 1.0 + 32.0 * kUnitRoundoff;
    const double reach = value_ + kRelativeUp * sphere.radius;
    if (reach < 0.0 || squared > kSlack * reach * reach) return;
    const double gap = std::sqrt(squared) - sphere.radius;
    if (gap < value_ || (gap == value_ && index < index_)) {
      value_ = gap;
      index_ = index;
    }
  }

  double value() const { return value_; }
  std::int32_t index() const { return index_; }  // -1 if there is none

  // Where what was not examined is larger than the value less the tolerance; `length` is at least
  // the sum of the largest radius and the lengths of p and of any centre. As v - 8 u |v| grows with
  // v, the least exact gap is at least v - 8 u (|v| + length) for the least v.
  NearestSphere bounds(double tolerance, double length) const {
    if (std::isinf(value_)) return {value_, value_, index_};
    const double slack = 8.0 * kUnitRoundoff * (std::abs(value_) + length) + kUnderflow;
    return {sub_down(sub_down(value_, tolerance), slack),
            index_ < 0 ? value_ : add_up(value_, slack), index_};
  }

 private:
  double value_;
  std::int32_t index_ = -1;
};

}  // namespace spherule::internal
