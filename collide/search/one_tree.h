// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/search/traversal.h"
#include "spheretree/sphere_tree.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>

namespace spherule::internal {

// A policy says what a search of one tree examines:
//   bool afford(first, count)   before the nodes first .. first + count - 1 are examined: false
//                               ends the search;
//   bool enters(node)           whether what is below a node (or the leaf itself) matters;
//   bool leaf(node)             a leaf that was entered: false ends the search.

// Depth-first. True if nothing is left to examine, false if the policy ended it. The stack holds at
// most depth (B - 1) + 1 entries for B children a node: opening one leaves B in its place, of which
// all but one wait while that one is finished.
template <class Policy>
bool search_with(std::int32_t* stack, [[maybe_unused]] std::size_t capacity, const SphereTree& tree,
                 Policy& policy) {
  if (!policy.afford(0, 1)) return false;
  std::size_t top = 0;
  if (policy.enters(0)) stack[top++] = 0;
  while (top > 0) {
    const std::int32_t node = stack[--top];
    const auto index = static_cast<std::size_t>(node);
    if (tree.is_leaf(index)) {
      if (!policy.leaf(node)) return false;
      continue;
    }
    const std::int32_t first = tree.first_child(index);
    const std::int32_t count = tree.child_count(index);
    if (!policy.afford(first, count)) return false;
    for (std::int32_t child = first; child < first + count; ++child) {
      if (!policy.enters(child)) continue;
      assert(top < capacity);
      stack[top++] = child;
    }
  }
  return true;
}

// Without any stack: all leaves.
template <class Policy>
bool search_exhaustively(const SphereTree& tree, Policy& policy) {
  for (std::int32_t node = 0; node < static_cast<std::int32_t>(tree.node_count()); ++node) {
    if (!tree.is_leaf(static_cast<std::size_t>(node))) continue;
    if (!policy.afford(node, 1)) return false;
    if (policy.enters(node) && !policy.leaf(node)) return false;
  }
  return true;
}

// The stack is of the proved size, from the heap where a tree is deeper than build_tree() makes it.
// Never throws if the policy does not.
template <class Policy>
bool search_tree(const SphereTree& tree, Policy& policy) {
  const std::size_t capacity =
      static_cast<std::size_t>(tree.depth()) * static_cast<std::size_t>(tree.branching()) + 1;
  if (capacity <= kInlineStack) {
    std::int32_t stack[kInlineStack];
    return search_with(stack, kInlineStack, tree, policy);
  }
  const std::unique_ptr<std::int32_t[]> stack(new (std::nothrow) std::int32_t[capacity]);
  if (stack) return search_with(stack.get(), capacity, tree, policy);
  return search_exhaustively(tree, policy);
}

}  // namespace spherule::internal
