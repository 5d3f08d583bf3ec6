// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/search/relative_pose.h"
#include "collide/search/sphere_tests.h"

#include <cassert>
#include <cstddef>
#include <cstdint>

namespace spherule::internal {

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

}  // namespace spherule::internal
