// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/internal/relative_pose.h"
#include "collide/internal/tree_pair.h"
#include "collide/mesh_tree.h"
#include "spheretree/point_triangle.h"

#include <algorithm>
#include <array>

namespace spherule::internal {

// Leaf test of a ball against a triangle, in the triangle's frame.
//
// The image p of the ball's centre errs by less than 136 u S (relative_pose.h), and `lower` bounds
// the distance from p to the triangle. So a ball of radius r that meets the triangle has
// lower <= r + 136 u S, and the pad of 144 u S covers the rounding of the sum. Conversely a hit has
// an exact gap of at most 144 u S + 136 u S + (upper - lower): the last term is the width of
// the interval that point_triangle_distance() returns.
//
// That is more than the node tests are proved to keep, so the balls themselves must touch
// canonically as well. No contact is lost, because the leaf's ball encloses the triangle; and every
// accepted pair is one that the node tests keep, whatever the trees above it.
class TriangleLeaves {
 public:
  TriangleLeaves(const SphereTree& a, const MeshTree& b, const RelativePose& pose)
      : a_(a),
        b_(b),
        pose_(pose),
        b_from_a_(pose.b_from_a()),
        pad_(144.0 * kUnitRoundoff * pose.scene_size() + kUnderflow) {}

  bool touches(NodePair pair) const {
    return pose_.touches(ball_a(pair), ball_b(pair)) && lower(pair) <= radius(pair) + pad_;
  }
  double gap(NodePair pair) const {
    return std::max(lower(pair) - radius(pair), pose_.gap(ball_a(pair), ball_b(pair)));
  }

 private:
  Sphere ball_a(NodePair pair) const { return a_.ball(pair.index(0)); }
  Sphere ball_b(NodePair pair) const { return b_.tree().ball(pair.index(1)); }
  double radius(NodePair pair) const { return a_.data().radius[pair.index(0)]; }

  double lower(NodePair pair) const {
    const Eigen::Vector3d c = ball_a(pair).center;
    const Eigen::Vector3d p(b_from_a_.x(c.x(), c.y(), c.z()), b_from_a_.y(c.x(), c.y(), c.z()),
                            b_from_a_.z(c.x(), c.y(), c.z()));
    const std::array<Eigen::Vector3d, 3>& corners =
        b_.triangle(b_.tree().sphere_index(pair.index(1)));
    return point_triangle_distance(p, corners[0], corners[1], corners[2]).lower;
  }

  const SphereTree& a_;
  const MeshTree& b_;
  const RelativePose& pose_;
  const FrameChange b_from_a_;
  const double pad_;
};

}  // namespace spherule::internal
