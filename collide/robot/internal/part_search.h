// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Do moving balls stay apart from a solid, or from each other, all along a part of a motion? The
// proof is in body_edge.cpp.

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

// A node of each of two trees.
struct PartNodes {
  std::int32_t a;
  std::int32_t b;
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

  // Of two trees, whose balls are given, in a depth-first search: `plane(a, b)` is that of two
  // balls. The stack has room for as many as stack_bound() says.
  template <class Plane>
  void run(const SphereTree& a, std::span<const MovingBall> balls_a, const SphereTree& b,
           std::span<const MovingBall> balls_b, const Plane& plane, std::span<PartNodes> stack) {
    std::size_t top = 0;
    stack[top++] = {0, 0};
    while (top > 0 && !may_touch_) {
      const PartNodes nodes = stack[--top];
      const auto node_a = static_cast<std::size_t>(nodes.a);
      const auto node_b = static_cast<std::size_t>(nodes.b);
      const MovingBall& ball_a = balls_a[node_a];
      const MovingBall& ball_b = balls_b[node_b];
      const bool leaf_a = a.is_leaf(node_a);
      const bool leaf_b = b.is_leaf(node_b);
      if (!opens(plane(ball_a, ball_b), ball_a.radius + ball_b.radius,
                 std::max(ball_a.radius, ball_b.radius), leaf_a && leaf_b)) {
        continue;
      }
      if (leaf_a || (!leaf_b && ball_a.radius < ball_b.radius)) {
        const std::int32_t first = b.first_child(node_b);
        const std::int32_t end = first + b.child_count(node_b);
        for (std::int32_t child = first; child < end; ++child) stack[top++] = {nodes.a, child};
      } else {
        top = push_children(a, nodes, stack, top);
      }
    }
  }

  // The same of a tree and a solid, `plane(ball)` being that of a ball and the solid.
  template <class Plane>
  void run(const SphereTree& tree, std::span<const MovingBall> balls, const Plane& plane,
           std::span<PartNodes> stack) {
    std::size_t top = 0;
    stack[top++] = {0, 0};
    while (top > 0 && !may_touch_) {
      const PartNodes nodes = stack[--top];
      const auto node = static_cast<std::size_t>(nodes.a);
      const MovingBall& ball = balls[node];
      if (!opens(plane(ball), ball.radius, ball.radius, tree.is_leaf(node))) continue;
      top = push_children(tree, nodes, stack, top);
    }
  }

  // To open a node puts at most so many children in its place, each of a smaller height, of which
  // all but one wait while that one is finished.
  static std::size_t stack_bound(int height, int branching) {
    return static_cast<std::size_t>(height) * static_cast<std::size_t>(branching) + 1;
  }

 private:
  static std::size_t push_children(const SphereTree& tree, PartNodes nodes,
                                   std::span<PartNodes> stack, std::size_t top) {
    const auto node = static_cast<std::size_t>(nodes.a);
    const std::int32_t first = tree.first_child(node);
    const std::int32_t end = first + tree.child_count(node);
    for (std::int32_t child = first; child < end; ++child) stack[top++] = {child, nodes.b};
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
