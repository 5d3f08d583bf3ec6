// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The leaves of all shapes, and what is proved of two of them. A leaf is a convex core grown by a
// radius: a sphere is a grown point, a capsule a grown segment, a triangle or a box is grown by 0.
//
// Error budget (G4), u = 2^-53. Two leaves are compared in the frame of the first. `size` (S)
// bounds, for the second as it stands in its own frame, the sum of what both cores reach from their
// origins, of both radii and of the distance of the two frames. `error()` is 192 u S.
//   - Image of the second core: 136 u S (search/relative_pose.h), for points, axes and discs alike.
//   - From below. For any vector n no point of a core a is nearer to one of a core b than
//     (least n.x - greatest n.y) / |n|. A projection is a sum of n.p, of |n.a| for half axes a, and
//     of r |n x m|; the two err by less than 20 u |n| S; norm, quotient, and the difference from
//     the radii take 8 u S.
//   - From above. A point of a core is a sum of corners and half axes with weights: 16 u S for both
//     cores. That of a disc is made perpendicular to its axis twice, and is its centre for
//     directions within 2^-40 of the axis, so that it is off the plane by 10 u of the radius.
//     Distance and radii: 8 u S.
//   - Half-spaces. n is the normal, which errs by 129 u itself, once more for |x| <= S: twice the
//     error.
// So each bound holds whatever directions and points a search comes up with; whether it converges
// decides how near to each other they are.
//
// Depth. If the corners of a closed surface of triangles are points of the difference of the two
// cores, and the origin sees each triangle from the inside and at least t away, then a ball of the
// radius t about the origin lies in the hull of the corners, and so (less the error) in the
// difference: a core has to be moved by t at least to part from the other. A triangle counts as
// seen from the inside if its determinant exceeds 64 u times the lengths that are multiplied.

#include "base/rounding.h"
#include "collide/search/query.h"
#include "collide/search/relative_pose.h"
#include "collide/solids/primitive.h"
#include "geometry/pose.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <limits>

namespace spherule::internal {

// The hull of one to three points, plus segments from -axes[i] to axes[i], plus a disc about the
// origin perpendicular to a unit vector, all of it grown by a radius. Or the half-space below the
// plane through points[0] with that unit vector as its normal.
struct Convex {
  int point_count = 1;
  int axis_count = 0;
  std::array<Eigen::Vector3d, 3> points{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                        Eigen::Vector3d::Zero()};
  std::array<Eigen::Vector3d, 3> axes{};
  double disc_radius = 0.0;
  Eigen::Vector3d disc_axis = Eigen::Vector3d::UnitZ();
  double radius = 0.0;
  bool is_half_space = false;

  static Convex sphere(const Sphere& sphere);
  static Convex triangle(const std::array<Eigen::Vector3d, 3>& corners);
  // Seen from another frame.
  Convex placed(const FrameChange& change) const;
};

// What is known of the distance of two leaves, and where it lies.
struct ConvexGap {
  // Between these is the distance of the leaves, unless it is 0. Below zero where they overlap:
  // then neither bounds anything but 0.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  // Of the two cores, the points that give `upper`; and the direction from b to a, of the length 1,
  // that gives `lower`.
  Eigen::Vector3d a = Eigen::Vector3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
};

// Two leaves that touch, by points in the frame of the first.
struct ConvexContact {
  // At least this far one of them has to be moved for them to part; below zero where rounding alone
  // may have made them touch.
  double depth = 0.0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  // from a to b
  Eigen::Vector3d on_a = Eigen::Vector3d::Zero();     // of a, the deepest in b
  Eigen::Vector3d on_b = Eigen::Vector3d::Zero();
  Eigen::Vector3d common = Eigen::Vector3d::Zero();  // of both, up to rounding
};

// Two leaves in the frame of the first; refers to them.
class ConvexPair {
 public:
  ConvexPair(const Convex& a, const Convex& b, double size)
      : a_(a), b_(b), error_(192.0 * kUnitRoundoff * size + kUnderflow) {}

  double error() const { return error_; }

  // Their distance (Gilbert, Johnson and Keerthi, "A fast procedure for computing the distance
  // between complex objects in three-dimensional space", 1988), with directions that are as exact
  // as the features they belong to. Ends as soon as `lower` exceeds `enough`, or `upper` is at most
  // `near`. `axis` is tried first.
  ConvexGap gap(const Eigen::Vector3d& axis,
                double enough = std::numeric_limits<double>::infinity(),
                double near = -std::numeric_limits<double>::infinity()) const;

  // How deep they overlap (van den Bergen, "Proximity queries and penetration depth computation on
  // 3D game objects", 2001: the expanding polytope), with growths of both beside their radii.
  ConvexContact contact(const ConvexGap& gap, double growth_a, double growth_b) const;

 private:
  class Search;
  class Polytope;

  ConvexGap half_space_gap() const;

  const Convex& a_;
  const Convex& b_;
  const double error_;
};

Convex convex_of(const Primitive& solid);

// The same in the world: `world_from` leads from the frame of its points.
Contact placed_contact(const SpherePair& leaves, const ConvexContact& contact,
                       const Pose& world_from);

}  // namespace spherule::internal
