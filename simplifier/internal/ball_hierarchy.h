// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere.h"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace spherule::internal {

// The least of |p - c| - r over a set of balls: negative inside of the union, where its absolute value
// is the depth in the deepest ball; outside, the distance to the union.
struct NearestBall {
  double lower = std::numeric_limits<double>::infinity();  // bounds of the exact value
  double upper = std::numeric_limits<double>::infinity();
  std::int32_t index = -1;  // a ball that attains it, up to rounding; -1 if none is nearer than asked
};

// Branch and bound over a binary hierarchy, split in centre and radius (covering.md 2.5). Immutable
// and safe to share between threads.
class BallHierarchy {
 public:
  BallHierarchy() = default;
  explicit BallHierarchy(std::span<const Sphere> balls);

  // Only values below `limit` are looked for; without one, both bounds are the limit.
  NearestBall nearest(const Eigen::Vector3d& point,
                      double limit = std::numeric_limits<double>::infinity()) const;

  bool empty() const { return balls_.empty(); }

 private:
  // Depth-first order: the left child is the next node; a leaf has right < 0 and holds [begin, end).
  struct Node {
    Eigen::Vector3d low;
    Eigen::Vector3d high;
    double max_radius = 0.0;
    std::int32_t right = -1;
    std::int32_t begin = 0;
    std::int32_t end = 0;
  };
  struct Entry {
    Sphere ball;
    std::int32_t index;
  };

  void build(std::int32_t begin, std::int32_t end);

  std::vector<Entry> balls_;
  std::vector<Node> nodes_;
};

}  // namespace spherule::internal
