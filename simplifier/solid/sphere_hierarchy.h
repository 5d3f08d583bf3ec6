// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/error.h"
#include "base/rounding.h"
#include "geometry/sphere.h"
#include "simplifier/solid/cells.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

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

// Branch and bound over a binary hierarchy. What bounds a node is made for spheres that touch a
// surface, as external spheres do: where it is flat they have a half-space in common, however far
// their centres are from it. Immutable and safe to share between threads.
class SphereHierarchy {
 public:
  SphereHierarchy() = default;
  // Of any spheres, built by several threads where these are many: split in centre and radius; the
  // wall that the spheres of a node touch is guessed by regression, as their radii are then an
  // affine function of their centres.
  explicit SphereHierarchy(std::span<const Sphere> spheres);

  // Only values below `limit` are searched for; without one, both bounds are the limit. Without a
  // tolerance, the bounds are those of LeastGap. The search may be content with a sphere that is up
  // to `tolerance` worse than the nearest: many spheres are nearly tied where they line a smooth
  // surface, and the bounds are then that far apart.
  NearestSphere nearest(const Eigen::Vector3d& point,
                        double limit = std::numeric_limits<double>::infinity(),
                        double tolerance = 0.0) const;

  // Whether the value of a sphere, as LeastGap computes it, is below `value`.
  bool is_any_nearer(const Eigen::Vector3d& point, double value) const;

  // Calls visit(index) for all spheres whose value at some point of the cell, as LeastGap computes
  // it, is at most `value` + slope . (point - centre of the cell), and some others, in a fixed
  // order, until it returns false. The slope is no longer than 1.
  void for_each_below(const BoxCell& cell, double value, const Eigen::Vector3d& slope,
                      const std::function<bool(std::int32_t)>& visit) const;

  // At least |p|, the largest norm of a centre and the largest radius in all; 0 for no spheres.
  double length_at(const Eigen::Vector3d& point) const;

  bool empty() const { return spheres_.empty(); }

 private:
  // The spheres [begin, end); the two children of an inner node stand side by side. In the frame of
  // a node (normal, axis, side) its centres lie in the box [low, high]; normal.x is at least
  // `offset` for every point x of its spheres.
  struct Node {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();
    Eigen::Vector3d side = Eigen::Vector3d::Zero();
    Eigen::Vector3d low = Eigen::Vector3d::Zero();
    Eigen::Vector3d high = Eigen::Vector3d::Zero();
    double offset = 0.0;
    double min_radius = 0.0;
    double max_radius = 0.0;
    std::int32_t children = -1;  // the first; negative for a leaf
    std::int32_t begin = 0;
    std::int32_t end = 0;
  };
  struct Entry {
    Sphere sphere;
    std::int32_t index;
  };

  // The subtree of the node `self`; its two children are stored at `children`, their descendants
  // from `children` + 2 on.
  void build(std::size_t self, std::size_t children);
  std::span<const Entry> spheres_of(const Node& node) const;
  void fit_box(Node& node, const Eigen::Vector3d& normal) const;
  // Branch and bound, nearer children first, until is_done() after a leaf.
  template <typename Done>
  void search(const Eigen::Vector3d& point, double tolerance, LeastGap& least,
              const Done& is_done) const;
  // True only if all values of the node are above the affine function of for_each_below() all over
  // the cell.
  bool is_above(const Node& node, const BoxCell& cell, double value,
                const Eigen::Vector3d& slope) const;
  double bound(const Node& node, const Eigen::Vector3d& point, double enough) const;

  std::vector<Entry> spheres_;
  std::vector<Node> nodes_;
  double magnitude_ = 0.0;  // largest norm of a centre
};

// A set of spheres that grows, with the nearest-sphere query of SphereHierarchy: most of the
// spheres are in a hierarchy, the last few in a list.
class SphereSet {
 public:
  void add(const Sphere& sphere) {
    spheres_.push_back(sphere);
    if (spheres_.size() - settled_ < std::max<std::size_t>(16, settled_ / 8)) return;
    hierarchy_ = SphereHierarchy(spheres_);
    settled_ = spheres_.size();
  }

  // Bounds of the least |p - c| - r, infinite for an empty set.
  NearestSphere nearest(const Eigen::Vector3d& point) const {
    NearestSphere best = hierarchy_.nearest(point);
    for (std::size_t i = settled_; i < spheres_.size(); ++i) {
      const Sphere& s = spheres_[i];
      best.lower = std::min(best.lower, sub_down(distance_lower(point, s.center), s.radius));
      const double upper = sub_up(distance_upper(point, s.center), s.radius);
      if (upper < best.upper) {
        best.upper = upper;
        best.index = static_cast<std::int32_t>(i);
      }
    }
    return best;
  }

  const std::vector<Sphere>& spheres() const { return spheres_; }

 private:
  std::vector<Sphere> spheres_;
  SphereHierarchy hierarchy_;
  std::size_t settled_ = 0;
};

// Throws Error for the first sphere that is not usable.
inline void check_usable(std::span<const Sphere> spheres) {
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (!is_usable(spheres[i])) {
      throw Error("sphere " + std::to_string(i), "not finite, too large, or of negative radius");
    }
  }
}

}  // namespace spherule::internal
