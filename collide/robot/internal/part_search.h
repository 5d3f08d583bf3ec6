// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Do moving balls stay apart from a solid, or from each other, all along a part of a motion? The
// proof is in body_edge.cpp.

#include "collide/internal/tree_pair.h"
#include "spheretree/sphere_tree.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace spherule::internal {

// In the world, in the middle of a part; the velocity is for the motion's time, from 0 to 1.
struct MovingBall {
  Eigen::Vector3d center;
  Eigen::Vector3d velocity;
  double radius;
};

// What holds for all points of a pair of bodies over a part of a motion.
struct PartBounds {
  double half = 0.0;    // of the part's length
  double way = 0.0;     // no point of one moves further than this from where it is in the middle,
  double bend = 0.0;    // nor than this from where its velocity there takes it
  double pad = 0.0;     // of distances, for rounding
  double enough = 0.0;  // what is nearer than this need not be kept apart any more
};

// A plane between a ball's centre and something else, all numbers times the length of the normal.
struct SeparatingPlane {
  double distance;  // of the centre, from what is behind the plane
  double normal;    // the length
  double approach;  // the centre's velocity along the normal
};

// What was found of the balls so far.
class PartSearch {
 public:
  explicit PartSearch(const PartBounds& bounds) : bounds_(bounds) {}

  bool is_near() const { return is_near_; }
  // By how much balls were grown at most that are near.
  double growth() const { return growth_; }
  // Whether there are leaves that are not apart in the middle, up to rounding.
  bool may_touch() const { return may_touch_; }

  // Of a ball of this radius, or of two whose radii have this sum, the larger one having `largest`:
  // whether what is below them has to be looked at. Where the motion matters more than their size
  // it has not, unless they may touch.
  bool opens(const SeparatingPlane& plane, double radius, double largest, bool is_leaf) {
    const double reach = radius + bounds_.pad;
    const double approach = std::abs(plane.approach) * bounds_.half;
    const bool has_normal = plane.normal > kSmallest;
    if (has_normal && (plane.distance > plane.normal * (reach + bounds_.way) ||
                       plane.distance > plane.normal * (reach + bounds_.bend) + approach)) {
      return false;
    }
    const bool overlap = !has_normal || plane.distance <= plane.normal * reach;
    const double growth =
        has_normal ? std::min(bounds_.way, bounds_.bend + approach / plane.normal) : bounds_.way;
    if (!is_leaf && (overlap || growth <= std::max(largest, bounds_.enough))) return true;
    is_near_ = true;
    growth_ = std::max(growth_, growth);
    may_touch_ |= is_leaf && overlap;
    return false;
  }

  // `plane(ball)` is that of a ball and the solid. The stack has room for as many as stack_bound().
  template <class Plane>
  void run(const SphereTree& tree, std::span<const MovingBall> balls, const Plane& plane,
           std::span<NodePair> stack) {
    std::size_t top = 0;
    stack[top++] = NodePair(0, 0);
    while (top > 0 && !may_touch_) {
      const NodePair pair = stack[--top];
      const MovingBall& ball = balls[pair.index(0)];
      const bool is_leaf = tree.is_leaf(pair.index(0));
      if (!opens(plane(ball), ball.radius, ball.radius, is_leaf)) continue;
      top = push_children(tree, pair, 0, stack, top);
    }
  }

  // Two trees, `plane(a, b)` being that of two balls. The same, with traversal_stack_bound().
  template <class Plane>
  void run(const SphereTree& a, std::span<const MovingBall> balls_a, const SphereTree& b,
           std::span<const MovingBall> balls_b, const Plane& plane, std::span<NodePair> stack) {
    std::size_t top = 0;
    stack[top++] = NodePair(0, 0);
    while (top > 0 && !may_touch_) {
      const NodePair pair = stack[--top];
      const MovingBall& ball_a = balls_a[pair.index(0)];
      const MovingBall& ball_b = balls_b[pair.index(1)];
      const bool leaf_a = a.is_leaf(pair.index(0));
      const bool leaf_b = b.is_leaf(pair.index(1));
      if (!opens(plane(ball_a, ball_b), ball_a.radius + ball_b.radius,
                 std::max(ball_a.radius, ball_b.radius), leaf_a && leaf_b)) {
        continue;
      }
      const int side = leaf_a || (!leaf_b && ball_a.radius < ball_b.radius) ? 1 : 0;
      top = push_children(side == 0 ? a : b, pair, side, stack, top);
    }
  }

  static std::size_t stack_bound(const SphereTree& tree) {
    return static_cast<std::size_t>(tree.depth()) * static_cast<std::size_t>(tree.branching()) + 1;
  }

 private:
  static std::size_t push_children(const SphereTree& tree, NodePair pair, int side,
                                   std::span<NodePair> stack, std::size_t top) {
    const std::int32_t first = tree.first_child(pair.index(side));
    const std::int32_t count = tree.child_count(pair.index(side));
    for (std::int32_t i = 0; i < count; ++i) stack[top++] = pair.with(side, first + i);
    return top;
  }

  // Normals that are shorter may be made of rounding and underflow alone.
  static constexpr double kSmallest = 1e-100;

  PartBounds bounds_;
  bool is_near_ = false;
  double growth_ = 0.0;
  bool may_touch_ = false;
};

}  // namespace spherule::internal
