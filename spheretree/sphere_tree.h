// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The sphere tree, which build_tree() makes (spheretree/build.h).
//
// @code{.cpp}
// #include <spherule/spheretree/build.h>
// #include <spherule/spheretree/sphere_tree.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}, {{9, 0, 0}, 1}};
// const spherule::SphereTree tree = spherule::build_tree(spheres);
// std::size_t leaves = 0;
// for (std::size_t node = 0; node < tree.node_count(); ++node) {
//   assert(certainly_encloses(tree.root(), tree.sphere(node)) || node == 0);
//   if (tree.is_leaf(node)) ++leaves;
// }
// assert(leaves == spheres.size());
// @endcode

#include "geometry/sphere.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule {

// The plain content of a sphere tree: nodes in breadth-first order, as a structure of arrays. The
// children of a node are consecutive, so that one wide load per array brings all of them.
struct SphereTreeData {
  std::vector<double> x, y, z, radius;    // sphere of every node
  std::vector<std::int32_t> first_child;  // inner node: its first child; leaf: index of its sphere
  std::vector<std::int32_t> child_count;  // 0 marks a leaf
  std::vector<Sphere> spheres;            // the spheres the tree stands for, in the caller's order
};

// The points p of a frame with |p - center| <= half_size in each coordinate.
struct AxisAlignedBox {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_size = Eigen::Vector3d::Zero();
};

// Bounding sphere hierarchy over a set of spheres (Quinlan, "Efficient distance computation between
// non-convex objects", 1994; Hubbard, "Approximating polyhedra with spheres for time-critical
// collision detection", 1996); immutable, so threads may share it freely.
//
// Invariants, verified by check() (spheretree/check.h) whenever a tree is made from data, and kept
// by refit():
//  1. there is at least one sphere, and all numbers are usable (finite, radii not negative);
//  2. every node but the root (node 0) is the child of exactly one node, and the arrays are in
//     breadth-first order: the children of the inner nodes, in the order of their parents, number
//     the nodes from 1 on without gap, so there are no cycles;
//  3. every sphere is the sphere of exactly one leaf, bit for bit;
//  4. layered (Agarwal, Guibas, Nguyen, Russel and Zhang, "Collision detection for deforming
//     necklaces", 2004): the sphere of every inner node encloses the spheres of its children in
//     exact arithmetic (hence, by induction, every sphere below it);
//  5. no inner node has more than kMaxBranching children.
class SphereTree {
 public:
  static constexpr int kMaxBranching = 16;

  // Makes the tree that `data` describes. Throws Error, naming the node, if an invariant fails.
  explicit SphereTree(SphereTreeData data);

  // The spheres of the leaves as they were given, and the number of all nodes.
  std::span<const Sphere> spheres() const { return data_.spheres; }
  std::size_t node_count() const { return data_.radius.size(); }

  // The sphere of node 0.
  const Sphere& root() const { return root_; }
  // Of one node: its sphere, and its children, which stand side by side from the first on.
  Sphere sphere(std::size_t node) const {
    return {{data_.x[node], data_.y[node], data_.z[node]}, data_.radius[node]};
  }
  bool is_leaf(std::size_t node) const { return data_.child_count[node] == 0; }
  std::int32_t first_child(std::size_t node) const { return data_.first_child[node]; }
  std::int32_t child_count(std::size_t node) const { return data_.child_count[node]; }
  // Index into spheres(); only for leaves.
  std::int32_t sphere_index(std::size_t leaf) const { return data_.first_child[leaf]; }

  // Edges on the longest way from the root to a leaf.
  int depth() const { return depth_; }
  // Largest number of children of a node.
  int branching() const { return branching_; }
  // Upper bound of the distance from the origin of the frame to any point of the spheres. The same
  // for every tree over the same spheres, so that what depends on it does not depend on the tree.
  double reach() const { return reach_; }
  // A box along the axes of the frame that holds every sphere in exact arithmetic, the smallest up
  // to rounding. Of the spheres alone, as reach() is.
  const AxisAlignedBox& box() const { return box_; }

  // The spheres that stand at distance `level` from the root, and the leaves above them: a set of
  // spheres whose union contains all spheres. level 0 is the root, level depth() the spheres
  // themselves.
  std::vector<Sphere> level(int level) const;

  // As it is stored in files.
  const SphereTreeData& data() const { return data_; }

 private:
  friend SphereTree refit(SphereTree tree, std::span<const Sphere> moved);

  void measure();  // the root, and what is of the spheres alone

  SphereTreeData data_;
  int depth_ = 0;
  int branching_ = 0;
  Sphere root_;
  double reach_ = 0.0;
  AxisAlignedBox box_;
};

}  // namespace spherule
