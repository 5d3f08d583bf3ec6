// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The binary tree that splits make of spheres, before it is made wide.

#include "spheretree/sphere.h"

#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// Children have larger numbers than their parent.
struct BinaryNode {
  std::int32_t left = -1;  // a leaf has none
  std::int32_t right = -1;
  std::int32_t leaf_sphere = -1;  // its index, of a leaf
  // About the smallest around the spheres below; decides which nodes are kept when the tree is made
  // wide, and is not part of the result.
  Sphere sphere;

  bool is_leaf() const { return left < 0; }
};

// The splits that build_tree() describes; `spheres` is not empty. The root is the first node.
std::vector<BinaryNode> binary_tree(std::span<const Sphere> spheres);

}  // namespace spherule::internal
