// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/sphere.h"
#include "robot/pairs/link_pairs.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace spherule::internal {

// The bodies of one link as a binary tree of pieces, for bounds of motion. Its leaves are triangles
// and spheres. A piece is the convex hull of points, each grown by `radius`: of a few neighbouring
// triangles, or of one sphere; it holds all that is below its node. Every point of the surface of a
// mesh grown by its growth lies in a leaf, and every point of a sphere.
struct LinkPieces {
  struct Node {
    Sphere sphere;                  // holds all leaves below
    std::int32_t first_child = -1;  // the second one follows it; -1 for a leaf
    std::int32_t first_point = 0;   // of a piece
    std::int32_t point_count = 0;   // 0 if the node is none
    double radius = 0.0;            // by which its points are grown
  };

  std::vector<Node> nodes;              // the root first
  std::vector<Eigen::Vector3d> points;  // of the pieces
  // Corners of the bodies, of very many few (HullCorners): each point of any body lies within
  // hull_radius of their convex hull.
  std::vector<Eigen::Vector3d> hull;
  double hull_radius = 0.0;
  double reach = 0.0;  // no point of the bodies is farther from the origin of the frame
  // Whether the hull is, up to a millimetre, all that pieces could tell.
  bool is_convex = false;
  std::vector<LinkBody> bodies;
};

// The bodies of each link. Throws Error for one without or with both shapes, and of no link.
std::vector<std::vector<LinkBody>> bodies_by_link(const RobotModel& robot,
                                                  std::span<const LinkBody> bodies);

LinkPieces make_link_pieces(std::span<const LinkBody> bodies);

// Whether any bodies of two links come within a clearance of each other, inside counted, under
// poses of the frames of the links: never false if they do, and true beyond that by the rounding of
// the tests only.
bool touches(std::span<const LinkBody> a, const Pose& world_from_a, std::span<const LinkBody> b,
             const Pose& world_from_b, double clearance);

// Whether two links have a point in common, inside counted, under poses of their frames: never
// false if they have, and true beyond that by the rounding of the mesh tests only.
bool touches(const LinkPieces& a, const Pose& world_from_a, const LinkPieces& b,
             const Pose& world_from_b, double clearance);

// Some of a set of points, whose convex hull all of them are within `radius` of, proved.
struct HullCorners {
  std::vector<Eigen::Vector3d> corners;
  double radius = 0.0;
};

// Few corners with a radius of little more than the tolerance at most (twice that for each two
// thousand corners that were needed); all points, and 0, where these are few already.
HullCorners hull_corners(std::span<const Eigen::Vector3d> points, double tolerance);

// The index of the first of the points that are least along an axis; 0 without points.
std::size_t least_along(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& axis);

// A direction along which two convex hulls of points are far apart, and by how much, up to
// rounding: nothing is proved here, whoever uses the direction proves what it needs.
struct HullDirection {
  Eigen::Vector3d direction =
      Eigen::Vector3d::UnitX();  // of unit length, from the second to the first
  double gap = 0.0;              // least along it of the first, minus the most of the second
  // Two points of the hulls are so far apart: the hulls are no farther.
  double distance = std::numeric_limits<double>::infinity();
};

// Gilbert, Johnson and Keerthi's iteration for the nearest points of the hulls, started along
// `start`, until they are known to be no farther apart than `enough`. Points of the second hull are
// given in the frame of the first.
HullDirection hull_direction(std::span<const Eigen::Vector3d> first,
                             std::span<const Eigen::Vector3d> second,
                             const Eigen::Matrix3d& first_from_second,
                             const Eigen::Vector3d& origin_of_second, const Eigen::Vector3d& start,
                             double enough = 0.0);

}  // namespace spherule::internal
