// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/pose.h"
#include "spheretree/sphere_tree.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule::internal {

// The children of an inner node, as one wide test reads them.
struct alignas(64) PackedNode {
  static constexpr int kWidth = 8;

  float x[kWidth];
  float y[kWidth];
  float z[kWidth];
  float radius[kWidth];
  // Of the child: a node, or ~i for the leaf of sphere i. Lanes without a child are spheres of
  // radius zero so far away that nothing reaches them.
  std::int32_t child[kWidth];
};

// A leaf, as the nodes hold it.
struct PackedSphere {
  float center[3];
  float radius;
};

// The eight children of a node, moved.
struct alignas(32) KernelSpheres {
  float x[8], y[8], z[8], radius[8];
};

// The spheres of a tree's nodes, as a search culls with them: for each node the tree's own, or the
// smallest around the leaves below it where that is smaller (it need not enclose the nodes between,
// since nothing but leaves decides).
class CullingSpheres {
 public:
  explicit CullingSpheres(const SphereTree& tree);

  const Sphere& operator[](std::size_t node) const { return spheres_[node]; }

 private:
  void visit(const SphereTree& tree, std::size_t node, std::vector<Sphere>& leaves);

  std::vector<Sphere> spheres_;
};

// The unit roundoff of single precision.
inline constexpr double kFloatRoundoff = 0x1p-24;

// The nearest number of single precision. A function that is not inlined: where g++ 12 vectorises
// the way there and back (at -O2, two numbers at once), it leaves it out.
// PackedTree.EverySphereHasRoomForTheInflatedSpheresBelow shows it.
double in_single_precision(double x);

// A number in single precision, not below the one given.
float rounded_up_to_single(double x);

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
