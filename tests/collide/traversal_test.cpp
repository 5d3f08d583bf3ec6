// SPDX-License-Identifier: BSD-3-Clause
// The stack of the traversal on the deepest trees there can be: within its proved bound, and
// nothing dropped.

#include "collide/search/traversal.h"

#include "collide/collide.h"
#include "tests/collide/trees.h"

#include <gtest/gtest.h>

#include <bit>

namespace spherule::test {
namespace {

// Visits every pair of leaves that is not pruned.
struct CountLeaves {
  static constexpr bool kNeedsGaps = false;
  std::size_t count = 0;

  bool afford(const internal::OpenedPair&, const auto&) { return true; }
  bool leaves(internal::NodePair) {
    ++count;
    return true;
  }
};

struct Peak {
  std::size_t entries = 0;  // highest entry written, plus one
  std::size_t leaf_pairs = 0;
};

// Runs on a stack of exactly the proved size, with watched entries behind it.
Peak traverse_on_tight_stack(const SphereTree& a, const SphereTree& b) {
  const internal::NodePair untouched(-7, -7);
  const std::size_t bound = internal::traversal_stack_bound(a, b);
  std::vector<internal::NodePair> stack(bound + 64, untouched);
  const Pose origin;
  const internal::RelativePose pose(a, origin, b, origin);
  CountLeaves policy;
  EXPECT_TRUE(
      internal::traverse_with(stack.data(), bound, internal::TreePair(a, b, pose), pose, policy));
  Peak peak{0, policy.count};
  for (std::size_t i = 0; i < stack.size(); ++i) {
    if (!(stack[i] == untouched)) peak.entries = i + 1;
  }
  EXPECT_LE(peak.entries, bound);
  return peak;
}

TEST(Traversal, StaysWithinTheProvedStackAndDropsNothing) {
  for (const int branching : {1, 2, 3, 8, 16}) {
    for (const int depth : {1, 2, 7, 40}) {
      for (const bool inner_first : {false, true}) {
        const SphereTree a = caterpillar(depth, branching, inner_first);
        const SphereTree b = caterpillar(depth / 2 + 1, branching, inner_first);
        const Peak peak = traverse_on_tight_stack(a, b);
        EXPECT_EQ(peak.leaf_pairs, a.spheres().size() * b.spheres().size());
        // The bound is no larger than it must be: the worst order reaches it.
        if (!inner_first) {
          EXPECT_EQ(peak.entries, internal::traversal_stack_bound(a, b));
        }
      }
    }
  }
}

// The bound on the depth that build_tree() gives, for a million spheres and the widest nodes.
TEST(Traversal, InlineStackIsEnoughForAMillionSpheres) {
  const std::size_t log2 = std::bit_width(std::size_t{1'000'000 - 1});
  const std::size_t deepest = 3 * log2 + 9;
  EXPECT_GE(internal::kInlineStack, 2 * deepest * (SphereTree::kMaxBranching - 1) + 1);
}

TEST(Traversal, TakesTreesThatOutgrowTheInlineStack) {
  const SphereTree a = caterpillar(1100, 2, false);
  const SphereTree b = caterpillar(1300, 2, true);
  ASSERT_GT(internal::traversal_stack_bound(a, b), internal::kInlineStack);
  EXPECT_TRUE(collides(a, Pose(), b, Pose()));
  const CollisionResult result = collide(a, Pose(), b, Pose());
  EXPECT_EQ(result.pairs.size(), a.spheres().size() * b.spheres().size());
  EXPECT_TRUE(result.complete);
  EXPECT_FALSE(collides(a, Pose(), b, Pose::from_translation({5000.0, 0.0, 0.0})));
  // Deep inside each other by the inner spheres and by the boxes, but no leaf touches.
  EXPECT_FALSE(collides(a, Pose(), b, Pose::from_translation({1.3, 1.3, 1.3})));
}

TEST(Traversal, TakesASingleSphere) {
  const SphereTree one = caterpillar(1, 1, false);
  EXPECT_EQ(traverse_on_tight_stack(one, one).leaf_pairs, 1u);
}

TEST(Traversal, WithoutAStackFindsTheSamePairs) {
  const SphereTree a = caterpillar(20, 3, false);
  const SphereTree b = caterpillar(30, 4, true);
  const Pose origin;
  const internal::RelativePose pose(a, origin, b, origin);
  CountLeaves policy;
  EXPECT_TRUE(internal::traverse_exhaustively(a, b, internal::TreePair(a, b, pose), policy));
  EXPECT_EQ(policy.count, a.spheres().size() * b.spheres().size());
}

}  // namespace
}  // namespace spherule::test
