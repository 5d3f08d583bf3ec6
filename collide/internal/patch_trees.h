// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/internal/cover_proof.h"

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// A box along the axes of the mesh's frame, and what is in it.
struct PatchNode {
  double center[3];
  double half[3];
  std::int32_t child;  // of two, the second follows; or ~i for triangle i
};

// For each ball of a cover a binary tree of boxes over its patches. Every box encloses the patches
// below it in exact arithmetic.
class PatchTrees {
 public:
  // The patches sorted by ball, as share_out() returns them.
  PatchTrees(std::span<const Patch> patches, std::size_t balls);

  // Edges on the longest way from a root: halving fewer than 2^31 triangles ends after so many.
  static constexpr std::size_t kMaxDepth = 31;

  // Calls visit(triangle) for the ball's patches that no box above them keeps off,
  // reject(box) being true for a box that does; until `visit` returns true, which is then the
  // answer.
  template <class Reject, class Visit>
  bool any(std::int32_t ball, const Reject& reject, const Visit& visit) const {
    const std::int32_t root = roots_[static_cast<std::size_t>(ball)];
    if (root < 0) return false;
    std::array<std::int32_t, kMaxDepth + 1> stack;  // every level leaves one box waiting
    std::size_t top = 0;
    stack[top++] = root;
    while (top > 0) {
      const PatchNode& node = nodes_[static_cast<std::size_t>(stack[--top])];
      if (reject(node)) continue;
      if (node.child < 0) {
        if (visit(~node.child)) return true;
        continue;
      }
      assert(top + 2 <= stack.size());
      stack[top++] = node.child + 1;
      stack[top++] = node.child;
    }
    return false;
  }

 private:
  std::vector<PatchNode> nodes_;
  std::vector<std::int32_t> roots_;
};

}  // namespace spherule::internal
