// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The first look at two trees: are the balls of their roots apart, or the boxes around their
// spheres along one of the six axes of these? Most pairs of bodies that are far from each other,
// but less so than the balls around them, end here, before anything is set up for a traversal. The
// nine axes that are products of two edges would find few more and cost as much again.
//
// Error budget in the terms of relative_pose.h; boxes (c, h) of SphereTree::box(), of which each
// coordinate has |c_j| + h_j <= reach, so |c| and |h| are at most sqrt(3) reach < 1.74 reach.
//   Centre of a's box seen from the centre of b's, in b's frame: the image errs by 136 u |c| + 71 u
//   |d|, the difference by u (|ca| + |cb| + |d|) more: less than 240 u S. Each row of R errs by at
//   most 129 u, so the reach of a's box along an axis of b errs by 129 u |h| and by its roundings,
//   4 u |h|: less than 233 u S with the sum of both. The gap along the axis errs by 6 u S more:
//   480 u S.
//   Seen along the axes of a: R^T times that centre, of length at most 1.74 S, errs by 240 u S and
//   by 129 u and 5.2 u of 1.74 S: 474 u S, with the reach and the last rounding 713 u S.
// So the exact gap of any two spheres is not below the computed one by more than kBoxError = 768 u
// S. Pairs that the canonical test accepts have a gap of at most kSlack S + c (1 + 16 u) for a
// clearance c, hence none is left where the lowered gap exceeds slack() + c (1 + 32 u). The leaf
// test of a mesh asks for more than that of the balls around its triangles, so the same holds for
// it.

#include "collide/internal/relative_pose.h"

#include <algorithm>
#include <cmath>

namespace spherule::internal {

inline constexpr double kBoxError = 768.0 * kUnitRoundoff;

// No sphere of a is nearer to one of b: negative, and of no use, where no axis separates the boxes.
inline double box_gap(const SphereTree& a, const SphereTree& b, const RelativePose& pose) {
  const FrameChange b_from_a = pose.b_from_a();
  const Box& box_a = a.box();
  const Box& box_b = b.box();
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
  const double widest = std::max(std::max(std::max(gaps_b[0], gaps_b[1]), gaps_b[2]),
                                 std::max(std::max(gaps_a[0], gaps_a[1]), gaps_a[2]));
  return widest - (kBoxError * pose.scene_size() + kUnderflow);
}

// False only if no sphere of a comes within the clearance of one of b by the canonical test. Boxes
// around single spheres say nothing that their balls do not.
inline bool roots_may_touch(const SphereTree& a, const SphereTree& b, const RelativePose& pose,
                            double clearance = 0.0) {
  if (!pose.may_touch(a.ball(0), b.ball(0), clearance)) return false;
  if (a.is_leaf(0) && b.is_leaf(0)) return true;
  return !(box_gap(a, b, pose) > pose.slack() + clearance * kMarginUp);
}

}  // namespace spherule::internal
