// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/meshes/mesh_tree.h"
#include "collide/search/nearest_first.h"
#include "collide/search/relative_pose.h"
#include "collide/search/traversal.h"
#include "geometry/point_triangle.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstdint>

namespace spherule::internal {

// Whether one of seven axes proves that the distance from `p` to a triangle, which may be
// degenerate, is above `reach` - 8 u S: across its plane, from p to the nearest point of the line
// of each edge, and from p to each corner (the nearest point of a triangle lies in one of these
// directions). S bounds |p| + |V| for every corner V, and reach <= S.
//
// True only if the distance is above that. Proof: for any axis n, the computed n.(V - p) errs by u
// |n| S for the difference and 3 u |n| S for the product; the comparison of the squares by 4 u of
// both sides, which are below S: less than 8 u S.
//
// True whenever the exact distance d is above reach + 2^-23 S and at least 2^-22 S, the height of
// the triangle on its longest edge L is at least 2^-24 L and L^2 at least 2^-200. Proof: let x be
// the nearest point as seen from p, |x| = d, and n the computed axis of its feature, scaled so that
// |n - x| = e is least. Every corner has V.x >= d^2, so n.V >= d^2 - e R, where R <= S is the
// farthest corner's distance, and |n| <= d + e. So n is found to separate if
//     d^2 - e R - 8 u S (d + e) > (d + e) reach,   for which   e < 2^-25 d  is enough,
// as 2^-23 S d > e (R + d) + ... is then left.
//   corner: e <= u R.
//   edge: the edge's direction errs by u, the share of it that leads to the foot by 5 u R / |edge|
//     for the product and 7 u for the quotient, in lengths below 2 R: e < 30 u R.
//     Both are below 2^-48 S < 2^-25 d.
//   plane: the normal, from two edges of at most L, errs by less than 8 u L^2 and is at least 2^-24
//     L^2 long: e < 2^-26 d.
// Axes whose squares might underflow are not queried: with L as it is they are none of these.
bool are_apart(const Eigen::Vector3d& p, const std::array<Eigen::Vector3d, 3>& triangle,
               double reach);

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
