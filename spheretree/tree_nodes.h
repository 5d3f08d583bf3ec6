// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The binary tree that splits make of spheres, before it is made wide.

#include "geometry/sphere.h"
#include "spheretree/sphere_tree.h"

#include <cstddef>
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

// What building, refitting and checking a tree share: the spheres of its nodes.

// Throws Error if a number in `spheres` is not usable.
void require_usable(std::span<const Sphere> spheres);

// Equality of all bits: unlike ==, it tells -0.0 from 0.0.
bool same_bits(const Sphere& a, const Sphere& b);

Sphere sphere_of(const SphereTreeData& data, std::size_t node);
void set_sphere(SphereTreeData& data, std::size_t node, const Sphere& sphere);

// The smallest sphere around the spheres of the node's children (at least one, at most
// kMaxBranching), rounded up so that it encloses them in exact arithmetic.
Sphere sphere_around_children(const SphereTreeData& data, std::size_t node);

// Throws Error if the sphere of the root is too large to be usable.
void check_root(const SphereTreeData& data);

// Which nodes of a binary tree are kept when it is made wide.

// The choice for which the squares of the radii of all inner nodes that are kept sum up to the
// least: a node is tested by a query about as often as that. O(n branching^2) time, O(n branching)
// memory. (For boxes and their surface: Ylitie, Karras and Laine, Efficient Incoherent Ray
// Traversal on GPUs Through Compressed Wide BVHs, 2017, 3.1.)
class WideNodes {
 public:
  // `nodes`, as binary_tree() makes them, must outlive this.
  WideNodes(std::span<const BinaryNode> nodes, int branching);

  // The children of an inner node that is kept, at least two, in the order of the splits.
  std::vector<std::int32_t> children(std::int32_t node) const;

 private:
  std::size_t slot_index(std::int32_t node, int slots) const;
  const BinaryNode& at(std::int32_t node) const { return nodes_[static_cast<std::size_t>(node)]; }
  float cost(std::int32_t node, int slots) const;
  void choose(std::int32_t node, double largest_radius);
  void collect(std::int32_t node, int slots, std::vector<std::int32_t>& children) const;

  std::span<const BinaryNode> nodes_;
  int branching_;
  std::vector<std::int32_t> rows_;  // of an inner node, in the tables below
  // The least cost of what is below a node, where its parent has so many slots for it.
  std::vector<float> costs_;
  // Then, how many of these its left child is given; 0 if it takes one slot itself. For one slot:
  // how many of all its own the left child is given.
  std::vector<std::int8_t> left_slots_;
};

}  // namespace spherule::internal
