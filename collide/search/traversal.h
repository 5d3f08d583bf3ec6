// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/search/tree_pair.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <new>

namespace spherule::internal {

// Entries that a depth-first traversal needs at most, one node of a pair opened per step.
//
// Proof: let h be the sum of the heights (in edges) of a pair's two nodes and B the largest number
// of children. To finish a pair of sum h takes at most h (B - 1) + 1 entries: none are pushed for
// h = 0; otherwise its entry is replaced by at most B pairs of sum h - 1, and while the last of
// them is finished with (h - 1)(B - 1) + 1 entries at most B - 1 wait: h (B - 1) + 1 in all.
inline std::size_t traversal_stack_bound(const SphereTree& a, const SphereTree& b) {
  const auto height = static_cast<std::size_t>(a.depth()) + static_cast<std::size_t>(b.depth());
  const int branching = std::max({a.branching(), b.branching(), 1});
  return height * static_cast<std::size_t>(branching - 1) + 1;
}

// Entries kept in the frame of the function, 18 KiB that are not touched before they are needed.
// Enough for any two trees of build_tree with a million spheres each, whose depth is at most
// 3 log2 n + 9 = 69, log2 rounded up: 2 * 69 * 15 + 1 = 2071. Deeper trees, which only a file or
// more spheres can bring, take one block from the heap.
inline constexpr std::size_t kInlineStack = 2304;

// A policy says what to do with what the traversal finds:
//   static constexpr bool kNeedsGaps   whether pruned(gap) is called for every pruned pair, gap
//                                      being the distance of the two spheres, within gap_error();
//   bool afford(opened, leaf_pairs)    before the children are tested: false ends the traversal;
//                                      leaf_pairs() counts the pairs of leaves among them;
//   bool leaves(pair)                  a pair of leaves that may touch: false ends the traversal;
//   double margin(pair)                only where the policy has one: every pair of leaves below
//                                      `pair` whose gap is at most that much is visited as well
//                                      (relative_pose.h says how exactly). May change on the way;
//   bool nearest_first()               beside margin(): whether the nearest child is visited first,
//                                      which pays where what is found narrows the margin;
//   bool enters(pair)                  only where the policy has one: false for a pair that is
//                                      proved apart, though its spheres may touch.

template <class Policy>
concept ProvesPairsApart = requires(const Policy& policy, NodePair pair) {
  policy.enters(pair);
};

template <class Policy>
concept HasMargin = requires(const Policy& policy, NodePair pair) {
  policy.margin(pair);
};

// The child of smallest gap among those of the mask, which is not 0.
inline std::int32_t nearest_of(std::uint32_t mask, const SphereArrays& children,
                               const OpenedPair& opened) {
  double gaps[SphereTree::kMaxBranching];
  sphere_gaps(children, opened.first, opened.count, opened.sphere, gaps);
  std::int32_t nearest = std::countr_zero(mask);
  for (mask &= mask - 1; mask != 0; mask &= mask - 1) {
    const std::int32_t i = std::countr_zero(mask);
    if (gaps[i] < gaps[nearest]) nearest = i;
  }
  return nearest;
}

// Depth-first dual-tree traversal from the pair of roots, taken as if they may touch. Only pairs
// whose nodes are proved apart are left out (G4). True if
// nothing is left to visit, false if the policy ended it with pairs waiting.
template <class Policy>
bool traverse_with(NodePair* stack, [[maybe_unused]] std::size_t capacity, const TreePair& trees,
                   const RelativePose& pose, Policy& policy) {
  const double node_pad = pose.node_pad();
  std::size_t top = 0;
  stack[top++] = NodePair(0, 0);
  while (top > 0) {
    const NodePair pair = stack[--top];
    if (trees.is_leaf_pair(pair)) {
      if (!policy.leaves(pair)) return top == 0;
      continue;
    }
    const OpenedPair opened = trees.open(pair);
    const auto leaf_pairs = [&] {
      std::uint64_t count = 0;
      if (!trees.is_leaf(1 - opened.side, pair.node(1 - opened.side))) return count;
      for (std::int32_t i = 0; i < opened.count; ++i) {
        count += trees.is_leaf(opened.side, opened.first + i) ? 1u : 0u;
      }
      return count;
    };
    if (!policy.afford(opened, leaf_pairs)) return false;

    QuerySphere padded = opened.sphere;
    if constexpr (HasMargin<Policy>) {
      padded.radius += node_pad + policy.margin(pair) * kMarginUp;
    } else {
      padded.radius += node_pad;
    }
    const SphereArrays& children = trees.spheres(opened.side);
    std::uint32_t mask = overlap_mask(children, opened.first, opened.count, padded);
    if constexpr (Policy::kNeedsGaps) {
      double gaps[SphereTree::kMaxBranching];
      sphere_gaps(children, opened.first, opened.count, opened.sphere, gaps);
      for (std::int32_t i = 0; i < opened.count; ++i) {
        if (!(mask >> i & 1u)) policy.pruned(gaps[i]);
      }
    }
    if constexpr (ProvesPairsApart<Policy>) {
      for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
        const std::int32_t i = std::countr_zero(rest);
        if (!policy.enters(pair.with(opened.side, opened.first + i))) mask &= ~(1u << i);
      }
    }
    assert(top + static_cast<std::size_t>(std::popcount(mask)) <= capacity);
    if constexpr (HasMargin<Policy>) {
      if (std::popcount(mask) > 1 && policy.nearest_first()) {
        // On top of the stack, so that it comes next; the others in their order.
        const std::int32_t nearest = nearest_of(mask, children, opened);
        mask &= ~(1u << nearest);
        for (; mask != 0; mask &= mask - 1) {
          stack[top++] = pair.with(opened.side, opened.first + std::countr_zero(mask));
        }
        stack[top++] = pair.with(opened.side, opened.first + nearest);
        continue;
      }
    }
    for (; mask != 0; mask &= mask - 1) {
      stack[top++] = pair.with(opened.side, opened.first + std::countr_zero(mask));
    }
  }
  return true;
}

// The same answers without any stack, by trying all pairs of leaves: for the case that there is no
// memory for the stack of a degenerate tree. No pair is ever dropped.
template <class Policy>
bool traverse_exhaustively(const SphereTree& a, const SphereTree& b, const TreePair& trees,
                           Policy& policy) {
  const auto nodes_a = static_cast<std::int32_t>(a.node_count());
  const auto nodes_b = static_cast<std::int32_t>(b.node_count());
  const auto one_pair = [] { return std::uint64_t{1}; };
  for (std::int32_t i = 0; i < nodes_a; ++i) {
    if (!trees.is_leaf(0, i)) continue;
    for (std::int32_t j = 0; j < nodes_b; ++j) {
      if (!trees.is_leaf(1, j)) continue;
      if (!policy.afford(OpenedPair{1, j, 1, {}}, one_pair)) return false;
      if (!policy.leaves(NodePair(i, j))) return false;
    }
  }
  return true;
}

// The traversal with a stack of the proved size, wherever that fits. Never throws.
template <class Policy>
bool traverse(const SphereTree& a, const SphereTree& b, const RelativePose& pose,
              Policy& policy) noexcept(noexcept(policy.leaves(NodePair(0, 0)))) {
  const TreePair trees(a, b, pose);
  const std::size_t capacity = traversal_stack_bound(a, b);
  if (capacity <= kInlineStack) {
    NodePair stack[kInlineStack];
    return traverse_with(stack, kInlineStack, trees, pose, policy);
  }
  const std::unique_ptr<NodePair[]> stack(new (std::nothrow) NodePair[capacity]);
  if (stack) return traverse_with(stack.get(), capacity, trees, pose, policy);
  return traverse_exhaustively(a, b, trees, policy);
}

}  // namespace spherule::internal
