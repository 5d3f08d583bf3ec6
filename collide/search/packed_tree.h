// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/search/culling_spheres.h"
#include "collide/search/packed_node.h"
#include "spheretree/pose.h"
#include "spheretree/sphere_tree.h"

#include <cstdint>
#include <vector>

namespace spherule::internal {

// A sphere tree for filters in single precision: a test that finds two of its spheres apart proves
// that no spheres below them touch.
//
// Every sphere is the one of the tree, or the smallest around the spheres below it where that is
// smaller (it need not contain the spheres between, since nothing but leaves decides), with
//   centre: rounded to nearest, by which its radius grows;
//   radius: r' >= (r + rounding of the centre + inflation) (1 + 8 v), rounded up, v = 2^-24.
//
// What the test may round. Let two spheres overlap in exact arithmetic after their centres have
// been displaced by at most the `inflation` of each, so that the distance of the displaced centres
// as they are stored is D <= s = (r1' + r2') / (1 + 8 v). The test computes, with or without fused
// operations, differences with a relative error of v, squares and sums of positive terms with 3 v
// more, so d2 <= D^2 (1 + 5.1 v), and a limit of (r1' + r2')^2 (1 - 3.1 v) at least. Since
// (1 + 8 v)^2 > (1 + 5.1 v) / (1 - 3.1 v), d2 <= limit: they are never found apart. Squares that
// underflow (below 2^-126) lose 2^-149 each, which the absolute term of every radius covers: it
// makes the limit exceed s^2 by 2^-120. Coordinates of up to kMaxCoordinate do not overflow.
//
// What touches for sure. Let g1 and g2 bound what was added to the radii, r' <= r + g; each holds
// the displacement and 8 v r. A test with a limit of r1' + r2' - 3 g1 - 3 g2, which rounding makes
// larger by at most 2 v (r1 + r2), that finds d2 <= limit^2 has a displaced distance of at most
//     (r1 + r2 - 2 g1 - 2 g2 + 2 v (r1 + r2)) (1 + 4.2 v),
// so an exact one of at most that and g1 + g2: r1 + r2 - (g1 + g2) + 6.2 v (r1 + r2) <= r1 + r2.
class PackedTree {
 public:
  // `inflation` is an absolute length. The tree's branching must be at most PackedNode::kWidth.
  PackedTree(const SphereTree& tree, double inflation);
  // The same of a tree whose culling spheres are known, placed by a pose: what that rounds is for
  // the inflation to cover.
  PackedTree(const SphereTree& tree, const CullingSpheres& culling, const Pose& pose,
             double inflation);

  // The root is node 0; behind the last, number node_count(), one holds the sphere around all.
  const PackedNode* nodes() const { return nodes_.data(); }
  std::int32_t node_count() const { return static_cast<std::int32_t>(nodes_.size()) - 1; }
  // One for every sphere of the tree, in its order.
  const PackedSphere* leaves() const { return leaves_.data(); }
  // The sphere around all, as the spheres of the nodes; its centre is exact in single precision.
  const Sphere& root() const { return root_; }
  // Nodes on the longest way from the root to a leaf, at least one.
  int depth() const { return depth_; }
  // No more than this has been added to the radius of any leaf.
  double largest_inflation() const { return largest_inflation_; }

 private:
  std::vector<PackedNode> nodes_;
  std::vector<PackedSphere> leaves_;
  Sphere root_;
  int depth_ = 0;
  double largest_inflation_ = 0.0;
};

}  // namespace spherule::internal
