// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Which nodes of a binary tree are kept when it is made wide.

#include "spheretree/internal/binary_tree.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

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
