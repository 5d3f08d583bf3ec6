// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Two tests of a pair of trees before a traversal is set up: is the root sphere of one apart from
// the box around the spheres of the other, and are the two boxes apart along one of their six axes?
// Most pairs that are a fifth of their size from each other or more end here. The nine axes that
// are products of two edges are left out, as is usual: they separate few pairs more. The second
// test also serves for the boxes of nodes.
//
// Error budget in the terms of relative_pose.h; boxes (c, h) are those of SphereTree::box(), of
// which each coordinate has |c_j| + h_j <= reach (1 + 8 u) + 2^-1070, because a box is rounded
// outward in its own way, or of NodeBoxes, with reach (1 + 2^-21) + 2^-125; so |c| and |h| are
// below 1.74 reach + 2^-124, and what the latter adds to the errors is below 2^-160.
//   Boxes. Centre of a's box seen from that of b's, in b's frame: the image errs by 136 u |c| + 71
//   u |d|, the difference by u (|ca| + |cb| + |d|) more: less than 240 u S. Each row of R errs by
//   at most 129 u, so the reach of a's box along an axis of b errs by 129 u |h| and by its
//   roundings, 4 u |h|: less than 233 u S with the sum of both. The gap along the axis errs by 7 u
//   S more: 480 u S in all. Along the axes of a: R^T times that centre, of length at most 1.74 S,
//   errs by 240 u S and by 129 u and 5.2 u of 1.74 S: 474 u S, with the reach and the last rounding
//   714 u S. Sphere (c, r) and box. The centre of a root sphere need not lie within the reach of
//   its spheres, so S grows by |c|_1 to U. The centre in the axes of the world, from b's origin: 60
//   u |c| + 5.2 u |c| + 4 u U; turned by Rb^T: 65.2 u U more; less the centre and the half size of
//   the box: 8 u U. The distance that is made of the three errs by less than 143 u U + 5 u U.
// So no computed gap is above the exact one by more than kBoxError = 768 u of S or U, and a root
// sphere and a box hold all spheres exactly. Pairs that the canonical test accepts have a gap of at
// most kSlack S + c (1 + 16 u) for a clearance c: they are not apart by kBoxError + kSlack and
// c (1 + 32 u). The leaf test of a mesh accepts only where that of the spheres around its triangles
// does, so the same holds for it.

#include "collide/search/relative_pose.h"
#include "geometry/median_split.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace spherule::internal {

inline constexpr double kBoxError = 768.0 * kUnitRoundoff;

// True only if no sphere of a comes within the clearance of one of b by the canonical test: the
// root sphere of `a` is apart from the box of `b`. Of the poses alone, because it takes less time
// than to set up a RelativePose.
inline bool sphere_apart_from_box(const SphereTree& a, const Pose& world_from_a,
                                  const SphereTree& b, const Pose& world_from_b, double clearance) {
  const double* ra = world_from_a.matrix().data();  // column by column
  const double* rb = world_from_b.matrix().data();
  const Sphere& sphere = a.root();
  const double x = sphere.center.x(), y = sphere.center.y(), z = sphere.center.z();
  const Eigen::Vector3d& ta = world_from_a.translation();
  const Eigen::Vector3d& tb = world_from_b.translation();
  const double dx = ta.x() - tb.x(), dy = ta.y() - tb.y(), dz = ta.z() - tb.z();
  const double wx = (ra[0] * x + ra[3] * y) + (ra[6] * z + dx);
  const double wy = (ra[1] * x + ra[4] * y) + (ra[7] * z + dy);
  const double wz = (ra[2] * x + ra[5] * y) + (ra[8] * z + dz);
  const AxisAlignedBox& box = b.box();
  double squared = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double along = (rb[3 * i] * wx + rb[3 * i + 1] * wy) + rb[3 * i + 2] * wz;
    const double outside = std::max(std::abs(along - box.center[i]) - box.half_size[i], 0.0);
    squared += outside * outside;
  }
  const double size = ((std::abs(x) + std::abs(y)) + (std::abs(z) + a.reach())) +
                      ((std::abs(dx) + std::abs(dy)) + (std::abs(dz) + b.reach()));
  const double limit =
      (sphere.radius + clearance * kMarginUp) + ((kSlack + kBoxError) * size + 8.0 * kUnderflow);
  return squared > limit * limit;
}

// The first test: the smaller sphere and the box of the other tree, since a box fits a body the
// better the longer it is.
inline bool far_apart(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                      const Pose& world_from_b, double clearance = 0.0) {
  const bool a_is_sphere = a.root().radius <= b.root().radius;
  return sphere_apart_from_box(a_is_sphere ? a : b, a_is_sphere ? world_from_a : world_from_b,
                               a_is_sphere ? b : a, a_is_sphere ? world_from_b : world_from_a,
                               clearance);
}

// No points of the two boxes are nearer to each other, but by kBoxError of S: negative, and of no
// use, where no axis separates them.
inline double box_gap(const AxisAlignedBox& box_a, const AxisAlignedBox& box_b,
                      const FrameChange& b_from_a) {
  const Eigen::Vector3d apart = b_from_a(box_a.center) - box_b.center;
  double gaps_b[3], gaps_a[3];
  for (int i = 0; i < 3; ++i) {
    const double* r = b_from_a.r + 3 * i;
    gaps_b[i] = std::abs(apart[i]) -
                ((std::abs(r[0]) * box_a.half_size.x() + std::abs(r[1]) * box_a.half_size.y()) +
                 (std::abs(r[2]) * box_a.half_size.z() + box_b.half_size[i]));
  }
  for (int i = 0; i < 3; ++i) {
    const double* r = b_from_a.r + i;
    gaps_a[i] = std::abs((r[0] * apart.x() + r[3] * apart.y()) + r[6] * apart.z()) -
                ((std::abs(r[0]) * box_b.half_size.x() + std::abs(r[3]) * box_b.half_size.y()) +
                 (std::abs(r[6]) * box_b.half_size.z() + box_a.half_size[i]));
  }
  return std::max(std::max(std::max(gaps_b[0], gaps_b[1]), gaps_b[2]),
                  std::max(std::max(gaps_a[0], gaps_a[1]), gaps_a[2]));
}

// No sphere of a is nearer to one of b.
inline double box_gap(const SphereTree& a, const SphereTree& b, const RelativePose& pose) {
  return box_gap(a.box(), b.box(), pose.b_from_a()) - (kBoxError * pose.scene_size() + kUnderflow);
}

// The second test: true only if no sphere of a comes within the clearance of one of b by the
// canonical test. Of boxes around single spheres nothing is queried: their spheres say more.
inline bool boxes_apart(const SphereTree& a, const SphereTree& b, const RelativePose& pose,
                        double clearance = 0.0) {
  if (a.is_leaf(0) && b.is_leaf(0)) return false;
  return box_gap(a, b, pose) > pose.slack() + clearance * kMarginUp;
}

}  // namespace spherule::internal

// How trees of boxes share out what they are built over.

namespace spherule::internal {

// Around the boxes `box_of(part)` of all parts.
template <class Part, class BoxOf>
Eigen::AlignedBox3d box_around(std::span<Part> parts, const BoxOf& box_of) {
  Eigen::AlignedBox3d box;
  for (const Part& part : parts) box.extend(box_of(part));
  return box;
}

// Sorts the parts along the longest side of that box, by the middles of their boxes; those with
// equal ones by their `number_of(part)`, so that the order depends on nothing else.
template <class Part, class BoxOf, class NumberOf>
void sort_along_longest_side(std::span<Part> parts, const BoxOf& box_of,
                             const NumberOf& number_of) {
  const Eigen::Index axis = longest_axis(box_around(parts, box_of));
  const auto key = [&](const Part& part) {
    const Eigen::AlignedBox3d& box = box_of(part);
    return std::pair(box.min()[axis] + box.max()[axis], number_of(part));
  };
  std::sort(parts.begin(), parts.end(),
            [&](const Part& a, const Part& b) { return key(a) < key(b); });
}

}  // namespace spherule::internal
