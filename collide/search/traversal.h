// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// One sphere against the consecutive spheres of a structure of arrays: the inner loop of every
// query. All variants do the same double operations in the same order, lane by lane, so they give
// the same bits. Kernels for wider instruction sets belong here, behind these functions.

#include "collide/search/relative_pose.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace spherule::internal {

// Spheres first, first + 1, ... of a tree.
struct SphereArrays {
  const double* x;
  const double* y;
  const double* z;
  const double* radius;
};

// A sphere in the frame of the arrays; the pad of the test is part of its radius.
struct QuerySphere {
  double x, y, z, radius;
};

inline bool overlaps(const SphereArrays& spheres, std::int32_t i, const QuerySphere& q) {
  const double dx = spheres.x[i] - q.x;
  const double dy = spheres.y[i] - q.y;
  const double dz = spheres.z[i] - q.z;
  const double limit = q.radius + spheres.radius[i];
  return dx * dx + dy * dy + dz * dz <= limit * limit;
}

// Bit i is set if sphere first + i overlaps `q`; 1 <= count <= 32. For any machine.
inline std::uint32_t portable_overlap_mask(const SphereArrays& spheres, std::int32_t first,
                                           std::int32_t count, const QuerySphere& q) {
  std::uint32_t mask = 0;
  for (std::int32_t i = 0; i < count; ++i) {
    mask |= static_cast<std::uint32_t>(overlaps(spheres, first + i, q)) << i;
  }
  return mask;
}

// The same, as fast as this machine can.
inline std::uint32_t overlap_mask(const SphereArrays& spheres, std::int32_t first,
                                  std::int32_t count, const QuerySphere& q) {
#if defined(__SSE2__)
  if (count == 1) return overlaps(spheres, first, q) ? 1u : 0u;
  const __m128d qx = _mm_set1_pd(q.x);
  const __m128d qy = _mm_set1_pd(q.y);
  const __m128d qz = _mm_set1_pd(q.z);
  const __m128d qr = _mm_set1_pd(q.radius);
  std::uint32_t mask = 0;
  for (std::int32_t done = 0; done < count; done += 2) {
    // An odd count tests its last but one sphere twice, rather than read past the end.
    const std::int32_t lane = done + 2 <= count ? done : count - 2;
    const std::int32_t i = first + lane;
    const __m128d dx = _mm_sub_pd(_mm_loadu_pd(spheres.x + i), qx);
    const __m128d dy = _mm_sub_pd(_mm_loadu_pd(spheres.y + i), qy);
    const __m128d dz = _mm_sub_pd(_mm_loadu_pd(spheres.z + i), qz);
    const __m128d limit = _mm_add_pd(qr, _mm_loadu_pd(spheres.radius + i));
    const __m128d d2 =
        _mm_add_pd(_mm_add_pd(_mm_mul_pd(dx, dx), _mm_mul_pd(dy, dy)), _mm_mul_pd(dz, dz));
    const int bits = _mm_movemask_pd(_mm_cmple_pd(d2, _mm_mul_pd(limit, limit)));
    mask |= static_cast<std::uint32_t>(bits) << lane;
  }
  return mask;
#else
  return portable_overlap_mask(spheres, first, count, q);
#endif
}

// gaps[i] = distance of the centres minus both radii (negative where they overlap).
inline void sphere_gaps(const SphereArrays& spheres, std::int32_t first, std::int32_t count,
                        const QuerySphere& q, double* gaps) {
  for (std::int32_t i = 0; i < count; ++i) {
    const double dx = spheres.x[first + i] - q.x;
    const double dy = spheres.y[first + i] - q.y;
    const double dz = spheres.z[first + i] - q.z;
    gaps[i] = std::sqrt(dx * dx + dy * dy + dz * dz) - (q.radius + spheres.radius[first + i]);
  }
}

// A node of a (side 0) and a node of b (side 1), packed into one word, so that a pair that was just
// put on a stack can be forwarded to the load that takes it off again.
class NodePair {
 public:
  NodePair() = default;  // not initialised: a stack of these costs nothing before it is used
  NodePair(std::int32_t a, std::int32_t b)
      : word_(static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) |
              static_cast<std::uint64_t>(static_cast<std::uint32_t>(b)) << 32) {}

  std::int32_t node(int side) const { return static_cast<std::int32_t>(word_ >> (32 * side)); }
  std::size_t index(int side) const { return static_cast<std::size_t>(node(side)); }

  // The same pair with another node on one side.
  NodePair with(int side, std::int32_t node) const {
    const std::uint64_t kept = word_ & (std::uint64_t{0xffffffff} << (32 * (1 - side)));
    return NodePair(kept | static_cast<std::uint64_t>(static_cast<std::uint32_t>(node))
                               << (32 * side));
  }

  friend bool operator==(NodePair, NodePair) = default;

 private:
  explicit NodePair(std::uint64_t word) : word_(word) {}

  std::uint64_t word_;
};

// A pair of nodes with one of them opened: the other's sphere, in the frame of the opened node's
// children.
struct OpenedPair {
  std::int32_t side;   // the tree that was opened: 0 for a, 1 for b
  std::int32_t first;  // children first .. first + count - 1
  std::int32_t count;
  QuerySphere sphere;  // radius without pad
};

// Two placed trees with both changes of frame, ready to be traversed. The descent rule stands here
// and nowhere else: the larger sphere is opened, a's of two equal ones; a leaf is never opened.
class TreePair {
 public:
  TreePair(const SphereTree& a, const SphereTree& b, const RelativePose& pose)
      : TreePair(a, b, pose, pose.b_from_a()) {}

  const SphereArrays& spheres(int side) const { return sides_[side].spheres; }
  bool is_leaf(int side, std::int32_t node) const { return sides_[side].child_count[node] == 0; }
  bool is_leaf_pair(NodePair pair) const {
    // Counts are not negative. No branch between the two.
    return (sides_[0].child_count[pair.node(0)] | sides_[1].child_count[pair.node(1)]) == 0;
  }

  // The pair must not be a pair of leaves. Free of branches on data: which sphere is larger is a
  // coin toss that a processor cannot predict.
  OpenedPair open(NodePair pair) const {
    const std::int32_t a = pair.node(0);
    const std::int32_t b = pair.node(1);
    const bool smaller = sides_[0].spheres.radius[a] < sides_[1].spheres.radius[b];
    const int side = static_cast<int>(is_leaf(0, a)) |
                     (static_cast<int>(smaller) & static_cast<int>(!is_leaf(1, b)));
    const Side& opened = sides_[side];
    const Side& other = sides_[1 - side];
    const std::int32_t node = side == 0 ? a : b;
    const std::int32_t kept = side == 0 ? b : a;
    assert(opened.child_count[node] > 0);
    const double x = other.spheres.x[kept];
    const double y = other.spheres.y[kept];
    const double z = other.spheres.z[kept];
    const FrameChange& change = opened.from_other;
    return {side,
            opened.first_child[node],
            opened.child_count[node],
            {change.x(x, y, z), change.y(x, y, z), change.z(x, y, z), other.spheres.radius[kept]}};
  }

 private:
  struct Side {
    Side(const SphereTree& tree, const FrameChange& change)
        : spheres{tree.data().x.data(), tree.data().y.data(), tree.data().z.data(),
                  tree.data().radius.data()},
          first_child(tree.data().first_child.data()),
          child_count(tree.data().child_count.data()),
          from_other(change) {}

    SphereArrays spheres;
    const std::int32_t* first_child;
    const std::int32_t* child_count;
    FrameChange from_other;
  };

  TreePair(const SphereTree& a, const SphereTree& b, const RelativePose& pose,
           const FrameChange& b_from_a)
      : sides_{Side(a, pose.a_from_b(b_from_a)), Side(b, b_from_a)} {}

  Side sides_[2];
};

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
