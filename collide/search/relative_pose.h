// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Two placed sphere trees, seen from each other, and the error budget behind G4 and G5. That all
// traversals and kernels decide by the canonical test below makes their answers equal (G7).
//
// Model: IEEE double, round to nearest, u = 2^-53; first-order terms are proved, the constants
// leave room for the rest. |.| is the Euclidean norm. Written for the exact poses, x in a's frame
// and y in b's:
//     d = ta - tb,   offset of two points   Ra x - Rb y + d,   distance D = |Ra x - Rb y + d|.
// Nothing depends on |ta| or |tb|: two bodies far from the origin are judged as well as near it.
//
// Scene size. Every sphere (x, r) of a tree has |x| + r <= reach(tree), SphereTree::reach(). With
//     S = reach(a) + reach(b) + |d|_1
// two spheres have |x| + ra + |y| + rb + |d| <= S and D <= S. The computed S errs by less than 8 u
// S. It is the same for every tree over the same spheres, and so is what the canonical test
// accepts. Spheres of nodes lie in the root sphere (c, R) of a layered tree, so |x| + r <= |c| + R,
// for which the sum of absolute coordinates stands in. T is S with the larger of this and the reach
// for each tree: it bounds the same for nodes and spheres alike, and T >= S.
//
// Canonical test (touches): the one test that decides whether two leaves overlap, in whatever order
// and by whatever kernel the traversal reached them.
//   Ra x: |Ea|_F <= 3 kRotationEntryError = 60 u gives 60 u |x|; a row of three products and two
//   sums errs by 3 u (row of |Ra|).|x| <= 3 u |x|, over three rows by 3 sqrt(3) u |x| < 5.2 u |x|:
//   65.2 u |x|. Likewise Rb y. Then two sums and the rounding of d: 2 u (|x| + |y| + |d|).
//   Together the offset errs by less than  e = 67.2 u (|x| + |y|) + 2 u |d|.
//   Its computed square d2 has a relative error of 3 u; the limit s = (ra + rb) + pad of 2 u, its
//   square 1 u more. So:
//   - never missed: D <= ra + rb implies d2 <= s^2 if  (D + e)(1 + 1.5 u) <= (ra + rb + pad)
//     (1 - 2.5 u), for which pad >= e + 4 u (ra + rb) is enough: at most 71.2 u S. kLeafPad = 76.
//   - little extra: d2 <= s^2 implies D - ra - rb <= pad + e + 1.5 u D + 2.5 u (ra + rb), at most
//     (76 + 71.2 + 1) u S < kSlack = 152 u S, which is collision_slack().
//   The test is symmetric to the last bit: swapping a and b negates the offset exactly.
//
// Change of frame (b_from_a and a_from_b): R = Rb^T Ra computed has |error|_F <= 60 u + 60 u + 9 u
// (entries: three products of unit columns, 3 u each). t = Rb^T d: 60 u |d| + 1 u |d| + 5.2 u |d|.
// The image R x + t: four terms a row, 4 sqrt(3) u |x| + 4 u |d| < 7 u |x| + 4 u |d|. So an image
// errs by less than  f = 136 u |x| + 71 u |d|  <= 136 u T.
//   - gap of two spheres, sqrt(d2) - (r + r'): f + 3 u T (differences and squares, half of 5 u) + 3
//   u
//     T (root, sum, difference): less than kGapError = 148 u T.
//   - node test, d2 <= (r + pad + r')^2: it must keep every pair of spheres whose gap is at most
//   the
//     slack, because leaves below them may touch canonically: pad >= 152 u S + f + 4 u T + ...:
//     less than kNodePad = 320 u T. Hence the set of reported pairs is exactly the set of pairs
//     that touch canonically, whatever the trees between, and the same for every kernel.
//
// Clearance c >= 0. Both tests also answer whether spheres come within c: the canonical test adds
// c (1 + 8 u) to its pad, the node test c' (1 + 32 u) for a margin c'.
//   - never missed: D <= ra + rb + c now requires c (1 + 8 u)(1 - u)(1 - 2.5 u) >= c (1 + 1.5 u),
//     beside what is required.
//   - little extra: the gap is at most kSlack S + c (1 + 8 u)(1 + u)(1 + 2.5 u), hence at most
//     kSlack S + c + 16 u c.
//   - a node test with the margin c' keeps every pair of spheres whose gap is at most kSlack S + c'
//     (1 + 16 u): its limit takes 3 u of c' (1 + 32 u)(1 - u), the squared distance 1.5 u.
//     So c' = c keeps all that the canonical test with the clearance c accepts.
//
// Underflow: each product may lose 2^-1075, and the squares of differences below 2^-511 vanish. The
// absolute term kUnderflow = 2^-530 in every pad is far above the first (a few dozen products) and
// gives s^2 >= 2^-1060, far above the few 2^-1075 lost in d2.

#include "base/rounding.h"
#include "geometry/pose.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <cmath>

namespace spherule::internal {

inline constexpr double kLeafPad = 76.0 * kUnitRoundoff;
inline constexpr double kSlack = 152.0 * kUnitRoundoff;
inline constexpr double kGapError = 148.0 * kUnitRoundoff;
inline constexpr double kNodePad = 320.0 * kUnitRoundoff;
inline constexpr double kMarginUp = 1.0 + 32.0 * kUnitRoundoff;

// A change of frame x' = R x + t by rounded numbers, R in row order.
struct FrameChange {
  double r[9];
  double t[3];

  double x(double px, double py, double pz) const { return row(0, px, py, pz); }
  double y(double px, double py, double pz) const { return row(1, px, py, pz); }
  double z(double px, double py, double pz) const { return row(2, px, py, pz); }
  Eigen::Vector3d operator()(const Eigen::Vector3d& p) const {
    return {x(p.x(), p.y(), p.z()), y(p.x(), p.y(), p.z()), z(p.x(), p.y(), p.z())};
  }

 private:
  double row(int i, double px, double py, double pz) const {
    return (r[3 * i] * px + r[3 * i + 1] * py) + (r[3 * i + 2] * pz + t[i]);
  }
};

// How far from the origin of its frame any sphere of a layered tree reaches, those of nodes
// included.
inline double node_reach(const SphereTree& tree) {
  const Sphere& root = tree.root();
  const double of_root =
      (std::abs(root.center.x()) + std::abs(root.center.y()) + std::abs(root.center.z())) +
      root.radius;
  return std::max(tree.reach(), of_root);
}

// What all tests between two placed trees share. Cheap: a root test needs no more than this. Refers
// to the two poses, which must outlive it.
class RelativePose {
 public:
  RelativePose(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
               const Pose& world_from_b)
      : RelativePose(a, world_from_a, b.reach(), node_reach(b), world_from_b) {}

  // The same for a body b that is no tree and reaches so far from the origin of its frame.
  RelativePose(const SphereTree& a, const Pose& world_from_a, double reach_b,
               const Pose& world_from_b)
      : RelativePose(a, world_from_a, reach_b, reach_b, world_from_b) {}

  // S and T of the budget above.
  double scene_size() const { return scene_size_; }
  double node_size() const { return node_size_; }

  // Pads of the radius sums in the tests, and bounds of what they may give away.
  double leaf_pad() const { return kLeafPad * scene_size_ + kUnderflow; }
  double node_pad() const { return kNodePad * node_size_ + 8.0 * kUnderflow; }
  double gap_error() const { return kGapError * node_size_ + kUnderflow; }
  double slack() const { return kSlack * scene_size_ + 4.0 * kUnderflow; }
  double slack(double clearance) const { return slack() + 16.0 * kUnitRoundoff * clearance; }

  // The canonical test: true if the closed spheres (x, ra) of a and (y, rb) of b overlap or touch
  // under the exact poses; never true if their gap exceeds slack().
  bool touches(const Sphere& a, const Sphere& b) const { return within(a, b, leaf_pad()); }

  // The same for spheres that come within a clearance; never true beyond slack(clearance).
  bool touches(const Sphere& a, const Sphere& b, double clearance) const {
    return within(a, b, leaf_pad() + clearance * kRelativeUp);
  }

  // Weaker: true for all pairs of spheres that contain spheres for which touches() is true.
  bool may_touch(const Sphere& a, const Sphere& b) const { return within(a, b, node_pad()); }
  bool may_touch(const Sphere& a, const Sphere& b, double margin) const {
    return within(a, b, node_pad() + margin * kMarginUp);
  }

  // Distance of the centres minus the radii, within gap_error() of the exact one.
  double gap(const Sphere& a, const Sphere& b) const {
    return std::sqrt(squared_distance(a, b)) - (a.radius + b.radius);
  }

  FrameChange b_from_a() const { return change(world_from_a_.matrix(), world_from_b_.matrix(), 1); }
  FrameChange a_from_b() const {
    return change(world_from_b_.matrix(), world_from_a_.matrix(), -1);
  }
  // The same to the last bit, where the other is at hand: its products come in the same order.
  FrameChange a_from_b(const FrameChange& b_from_a) const {
    FrameChange result;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) result.r[3 * i + j] = b_from_a.r[3 * j + i];
      result.t[i] = turned_back(world_from_a_.matrix(), i, -1);
    }
    return result;
  }

 private:
  RelativePose(const SphereTree& a, const Pose& world_from_a, double reach_b, double node_reach_b,
               const Pose& world_from_b)
      : world_from_a_(world_from_a),
        world_from_b_(world_from_b),
        dx_(world_from_a.translation().x() - world_from_b.translation().x()),
        dy_(world_from_a.translation().y() - world_from_b.translation().y()),
        dz_(world_from_a.translation().z() - world_from_b.translation().z()) {
    const double offset = std::abs(dx_) + std::abs(dy_) + std::abs(dz_);
    scene_size_ = (a.reach() + reach_b) + offset;
    node_size_ = (node_reach(a) + node_reach_b) + offset;
  }

  static double row(const Eigen::Matrix3d& m, int i, const Eigen::Vector3d& x) {
    return m(i, 0) * x.x() + m(i, 1) * x.y() + m(i, 2) * x.z();
  }

  double squared_distance(const Sphere& a, const Sphere& b) const {
    const Eigen::Matrix3d& ra = world_from_a_.matrix();
    const Eigen::Matrix3d& rb = world_from_b_.matrix();
    const double x = (row(ra, 0, a.center) - row(rb, 0, b.center)) + dx_;
    const double y = (row(ra, 1, a.center) - row(rb, 1, b.center)) + dy_;
    const double z = (row(ra, 2, a.center) - row(rb, 2, b.center)) + dz_;
    return x * x + y * y + z * z;
  }

  bool within(const Sphere& a, const Sphere& b, double pad) const {
    const double limit = (a.radius + b.radius) + pad;
    return squared_distance(a, b) <= limit * limit;
  }

  // `to` transposed times `from`, and times the offset.
  FrameChange change(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to, double sign) const {
    FrameChange result;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        result.r[3 * i + j] = to(0, i) * from(0, j) + to(1, i) * from(1, j) + to(2, i) * from(2, j);
      }
      result.t[i] = turned_back(to, i, sign);
    }
    return result;
  }

  double turned_back(const Eigen::Matrix3d& to, int i, double sign) const {
    return sign * (to(0, i) * dx_ + to(1, i) * dy_ + to(2, i) * dz_);
  }

  const Pose& world_from_a_;
  const Pose& world_from_b_;
  double dx_, dy_, dz_;
  double scene_size_;
  double node_size_;
};

}  // namespace spherule::internal
