// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere.h"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace spherule::internal {

// The least of |p - c| - r over a set of balls: negative inside of the union, where its absolute
// value is the depth in the deepest ball; outside, the distance to the union.
struct NearestBall {
  double lower = std::numeric_limits<double>::infinity();  // bounds of the exact value
  double upper = std::numeric_limits<double>::infinity();
  std::int32_t index =
      -1;  // a ball that attains it, up to rounding; -1 if none is nearer than asked
};

// Branch and bound over a binary hierarchy, split in centre and radius. A node is bounded by the
// box of its centres with its largest radius, and by a half-space that contains its balls: balls
// that touch a flat wall at different distances have radii that are an affine function of their
// centres, with the wall's normal for a gradient, so the normal is found by regression. Immutable
// and safe to share between threads.
class BallHierarchy {
 public:
  BallHierarchy() = default;
  explicit BallHierarchy(std::span<const Sphere> balls);

  // Only values below `limit` are looked for; without one, both bounds are the limit. The search
  // may be content with a ball that is up to `tolerance` worse than the nearest: many balls are
  // nearly tied where they line a smooth surface, and the bounds are then that far apart.
  NearestBall nearest(const Eigen::Vector3d& point,
                      double limit = std::numeric_limits<double>::infinity(),
                      double tolerance = 0.0) const;

  bool empty() const { return balls_.empty(); }

 private:
  // Depth-first order: the left child is the next node; a leaf has right < 0 and holds [begin,
  // end).
  struct Node {
    Eigen::Vector3d low;
    Eigen::Vector3d high;
    double max_radius = 0.0;
    Eigen::Vector3d normal;  // |normal| <= 1; normal.x >= offset for every point x of the balls
    double offset = 0.0;
    std::int32_t right = -1;
    std::int32_t begin = 0;
    std::int32_t end = 0;
  };
  struct Entry {
    Sphere ball;
    std::int32_t index;
  };

  void build(std::int32_t begin, std::int32_t end);
  void fit_half_space(Node& node) const;

  std::vector<Entry> balls_;
  std::vector<Node> nodes_;
  double magnitude_ = 0.0;  // largest norm of a centre
};

}  // namespace spherule::internal
