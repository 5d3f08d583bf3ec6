// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mesh_tree.h"
#include "collide/meshes/sphere_triangle.h"
#include "collide/search/nearest_first.h"
#include "collide/search/relative_pose.h"
#include "collide/search/tree_pair.h"
#include "mesh/point_triangle.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace spherule::internal {

// Leaf test of a sphere against a triangle, in the triangle's frame.
//
// The image p of the sphere's centre errs by less than 136 u S (relative_pose.h), and `lower`
// bounds the distance from p to the triangle. So a sphere of radius r that intersects the triangle
// has lower <= r + 136 u S, and the pad of 144 u S covers the rounding of the sum. Conversely a hit
// has an exact gap of at most 144 u S + 136 u S + (upper - lower): the last term is the width of
// the interval that point_triangle_distance() returns.
//
// That is more than the node tests are proved to keep, so the spheres themselves must touch
// canonically as well. No contact is lost, because the leaf's sphere encloses the triangle; and
// every accepted pair is one that the node tests keep, whatever the trees above it.
//
// The last term has no bound that could be relied on. are_apart() has one, so that filters in
// single precision never find apart what is accepted here: it loses no contact with r + 136 u S and
// the 8 u S that it requires, and 160 u S covers the rounding of the sum.
//
// A clearance c adds c (1 + 32 u) to both pads: S + c takes the place of S, of whose 8 u c and of
// the roundings of the sum, 2 u c, it leaves nothing over.
class TriangleLeaves {
 public:
  TriangleLeaves(const SphereTree& a, const MeshTree& b, const RelativePose& pose,
                 double clearance = 0.0)
      : a_(a),
        b_(b),
        pose_(pose),
        b_from_a_(pose.b_from_a()),
        clearance_(clearance),
        pad_((144.0 * kUnitRoundoff * pose.scene_size() + kUnderflow) + clearance * kMarginUp),
        axis_pad_((160.0 * kUnitRoundoff * pose.scene_size() + kUnderflow) +
                  clearance * kMarginUp) {}

  bool touches(NodePair pair) const {
    return touches(a_.sphere_index(pair.index(0)), b_.tree().sphere_index(pair.index(1)));
  }
  bool touches(std::int32_t index, std::int32_t triangle) const {
    const Sphere& sphere = a_.spheres()[static_cast<std::size_t>(index)];
    return pose_.touches(sphere, b_.tree().spheres()[static_cast<std::size_t>(triangle)],
                         clearance_) &&
           !are_apart(b_from_a_(sphere.center), b_.triangle(triangle), sphere.radius + axis_pad_) &&
           lower(sphere, triangle) <= sphere.radius + pad_;
  }
  double gap(NodePair pair) const {
    const Sphere sphere = a_.sphere(pair.index(0));
    return std::max(lower(sphere, b_.tree().sphere_index(pair.index(1))) - sphere.radius,
                    pose_.gap(sphere, b_.tree().sphere(pair.index(1))));
  }
  // So deep is the triangle in the sphere at least, if that is above zero: its image errs by less
  // than the pad.
  double depth(std::int32_t index, std::int32_t triangle) const {
    const Sphere& sphere = a_.spheres()[static_cast<std::size_t>(index)];
    return (sphere.radius - pad_) - distance(sphere, triangle).upper;
  }
  GapInterval interval(NodePair pair) const {
    const Sphere sphere = a_.sphere(pair.index(0));
    const TriangleDistance found = distance(sphere, b_.tree().sphere_index(pair.index(1)));
    return {found.lower - sphere.radius, found.upper - sphere.radius};
  }

 private:
  TriangleDistance distance(const Sphere& sphere, std::int32_t triangle) const {
    const std::array<Eigen::Vector3d, 3>& corners = b_.triangle(triangle);
    return point_triangle_distance(b_from_a_(sphere.center), corners[0], corners[1], corners[2]);
  }
  double lower(const Sphere& sphere, std::int32_t triangle) const {
    return distance(sphere, triangle).lower;
  }

  const SphereTree& a_;
  const MeshTree& b_;
  const RelativePose& pose_;
  const FrameChange b_from_a_;
  const double clearance_;
  const double pad_;
  const double axis_pad_;
};

}  // namespace spherule::internal
