// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere_tree.h"

#include <cstdint>
#include <vector>

namespace spherule::internal {

// The unit roundoff of single precision.
inline constexpr double kFloatRoundoff = 0x1p-24;

// The children of an inner node, as one wide test reads them.
struct alignas(64) PackedNode {
  static constexpr int kWidth = 8;

  float x[kWidth];
  float y[kWidth];
  float z[kWidth];
  float radius[kWidth];
  // Of the child: a node, or ~i for the leaf of sphere i. Lanes without a child are balls of radius
  // zero so far away that nothing reaches them.
  std::int32_t child[kWidth];
};

// A sphere tree for filters in single precision: a test that finds two of its balls apart proves
// that no spheres below them touch.
//
// Every ball is the one of the tree, or the smallest around the spheres below it where that is
// smaller (it need not contain the balls between, since nothing but leaves decides), with
//   centre: rounded to nearest, by which its radius grows;
//   radius: r' >= (r + rounding of the centre + inflation) (1 + 8 v), rounded up, v = 2^-24.
//
// What the test may round. Let two balls overlap in exact arithmetic after their centres have been
// displaced by at most the `inflation` of each, so that the distance of the displaced centres as
// they are stored is D <= s = (r1' + r2') / (1 + 8 v). The test computes, with or without fused
// operations, differences with a relative error of v, squares and sums of positive terms with 3 v
// more, so d2 <= D^2 (1 + 5.1 v), and a limit of (r1' + r2')^2 (1 - 3.1 v) at least. Since
// (1 + 8 v)^2 > (1 + 5.1 v) / (1 - 3.1 v), d2 <= limit: they are never found apart. Squares that
// underflow (below 2^-126) lose 2^-149 each, which the absolute term of every radius covers: it
// makes the limit exceed s^2 by 2^-120. Coordinates of up to kMaxCoordinate do not overflow.
class PackedTree {
 public:
  // `inflation` is an absolute length. The tree may have any branching.
  PackedTree(const SphereTree& tree, double inflation);

  const PackedNode* nodes() const { return nodes_.data(); }
  // The ball around all, as the balls of the nodes; its centre is exact in single precision.
  const Sphere& root() const { return root_; }
  // Nodes on the longest way from the root to a leaf, at least one.
  int depth() const { return depth_; }
  // No more than this has been added to the radius of any leaf.
  double largest_growth() const { return largest_growth_; }

 private:
  std::vector<PackedNode> nodes_;
  Sphere root_;
  int depth_ = 0;
  double largest_growth_ = 0.0;
};

}  // namespace spherule::internal
