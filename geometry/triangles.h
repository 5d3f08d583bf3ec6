// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace spherule::internal {

using Triangle = std::array<Eigen::Vector3d, 3>;

inline std::array<Eigen::Vector3d, 3> edges_of(const Triangle& t) {
  return {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
}

// Distance of the projections on `axis`, in units of its length; negative where they overlap.
inline double gap_along(const Eigen::Vector3d& axis, const Triangle& a, const Triangle& b) {
  const double a0 = axis.dot(a[0]), a1 = axis.dot(a[1]), a2 = axis.dot(a[2]);
  const double b0 = axis.dot(b[0]), b1 = axis.dot(b[1]), b2 = axis.dot(b[2]);
  const double low_a = std::min(std::min(a0, a1), a2), high_a = std::max(std::max(a0, a1), a2);
  const double low_b = std::min(std::min(b0, b1), b2), high_b = std::max(std::max(b0, b1), b2);
  return std::max(low_a - high_b, low_b - high_a);
}

enum class TriangleContact {
  kApart,      // proved: no point in common
  kTouch,      // proved: a point in common
  kUncertain,  // neither
};

// A filtered predicate (Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
// geometric predicates", 1997): rounding is bounded in advance, and what it leaves open is reported
// as uncertain. Contact of two placed triangles, which may be degenerate (needles, segments,
// points), both in one frame. Swapping them does not change the answer.
//
// The triangles that are judged are the exact ones. With corners X of one and Y of the other, x and
// y as given here, u = 2^-53 and S = scene_size, the caller sees to it that
//     |(X - Y) - (x - y)| <= 68 u S,   |X - Y| <= S,   |x| + |y| <= S (1 + 100 u),
// and that pad >= 76 u S + 2^-530.
//
// Apart. A separating axis n is any three numbers, however they were found. The computed gap of the
// projections errs by 3 u |n| S for the dot products, u |n| S for the difference and 68 u |n| S for
// the corners: 72 u |n| S. It is compared with |n| pad; what is left of the pad covers the 4 u of
// that comparison. Axes so short that their squares might underflow prove nothing.
//
// Touching. Two triangles in planes that are not parallel have a point in common if they overlap
// along both normals and the nine cross products of their edges: the normals of the faces of their
// Minkowski difference are among these. Overlap along a normal, which sees its own triangle as one
// point, excludes parallel planes. Here the exact axes N count. Edges err by 2 * 68 u S + u L <=
// 138 u S, where L <= S is the longest; so |n - N| <= 138 u S (2 L) + 4 u L^2 + ... <= 282 u S L,
// and the projections on N differ from those computed by that times |X - Y| <= S and 72 u |n| S
// with |n| <= L^2 <= L S more: 354 u S^2 L. kOverlap = 400 leaves the rest. A zero axis never
// overlaps by more than that, so degenerate triangles are at most uncertain.
//
// How deep. Where they overlap along all of these axes by more than a depth times the axis' length,
// a sphere of that radius about the origin lies in the difference: a triangle that moves, rigidly
// or not, none of its points by more than the depth, cannot be parted from the other by any plane.
// |N| <= |n| + 282 u S L.
//
// Doubt. Triangles that are apart by clearly more than the pad are found apart by an axis: faces by
// a normal, edges by a cross product, coplanar ones by the normals of their edges in the plane, and
// any by the direction from a corner to the nearest point of the other triangle. That direction is
// off by some u L / gap, so where nothing else separates (corner against corner of needles, say)
// the uncertainty may reach to about sqrt(u) L; elsewhere it is about a pad wide.
TriangleContact triangle_contact(const Triangle& a, const Triangle& b, double pad,
                                 double scene_size);

// A depth as above; not above zero if the triangles are not proved to touch.
double triangle_depth(const Triangle& a, const Triangle& b, double scene_size);

// Whether a gap along an axis, in units of its length, is more than a pad. False for axes of which
// the square is not far above the 2^-1075 that a product may lose to underflow: they prove nothing.
inline bool separates(const Eigen::Vector3d& axis, double gap, double pad) {
  constexpr double kShortestAxis = 0x1p-600;
  const double square = axis.squaredNorm();
  return gap > 0.0 && square >= kShortestAxis && gap * gap > square * (pad * pad);
}

// Solid angle under which the triangle of the corners a, b, c is seen from the origin, positive if
// they turn to the right as seen from there (Van Oosterom and Strackee 1983). Plain double.
inline double solid_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c) {
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2.0 * std::atan2(a.dot(b.cross(c)), denominator);
}

}  // namespace spherule::internal
