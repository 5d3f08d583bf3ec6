// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The sphere tree: build_tree() makes it, refit() moves its spheres, check() proves its invariants,
// and cut() takes few spheres out of it. Files of trees: spheretree/tree_file.h.
//
// @code{.cpp}
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
#include <string>
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
// Invariants, verified by check() whenever a tree is made from data, and kept
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

// Makes the sphere tree over a set of spheres.
//
// @code{.cpp}
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}, {{4, 0, 0}, 1}};
// const spherule::SphereTree tree = spherule::build_tree(spheres, {.branching = 2});
// assert(tree.spheres().size() == 3 && tree.root().radius >= 3.0);
// @endcode

// The shape of the tree.
struct BuildOptions {
  // Children of a wide node, 2 to SphereTree::kMaxBranching.
  int branching = 8;
};

// Builds the layered hierarchy over `spheres`: top-down binary splits along an axis, where the two
// boxes' diagonals times their numbers of spheres sum up to the least (by bins for more than 256;
// at the median where all centres coincide or the depth grows past 2 log2 n + 8, so that no input
// gives a depth of more than 3 log2 n + 9 edges, log2 rounded up), of which those inner nodes are
// kept for wide ones whose squared radii sum up to the least; the sphere of each inner node is the
// smallest enclosing ball of its children's spheres, rounded up so that it encloses them in exact
// arithmetic (G3). Deterministic (G7): no threads, no random numbers, only + - * / sqrt. O(n log n)
// time; O(n) memory, some 220 bytes a sphere. Where the same spheres only move, refit() is faster.
// Throws Error if `spheres` is empty or has more than 2^30 elements, a number in it is not usable,
// the sphere around all of them would not be usable, or an option is out of range.
SphereTree build_tree(std::span<const Sphere> spheres, const BuildOptions& options = {});

// Sphere trees over spheres that move, without building them anew.
//
// @code{.cpp}
// #include <utility>
//
// std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1.0}, {{2, 0, 0}, 1.0}};
// spherule::SphereTree tree = spherule::build_tree(spheres);
// spheres[1].center.x() = 3.0;
// tree = spherule::refit(std::move(tree), spheres);
// assert(tree.spheres()[1] == spheres[1] && tree.root().radius >= 2.5);
// @endcode

// The tree over `moved`, the spheres of `tree` after they have moved, grown or shrunk: as many, in
// the same order. The nodes and their children stay; the sphere of an inner node becomes the
// smallest around the spheres of its children, as build_tree() makes it, unless none of these has
// changed: then it stays. So spheres that have not moved give the same bytes, and a tree of
// build_tree() gives spheres that depend on its nodes and on `moved` alone, whatever refits lie
// between. Deterministic (G7). O(n) with a small constant, plus a smallest sphere for each inner
// node above something that has moved. A tree that is moved in (std::move) is not copied; it is
// lost if refit() throws.
//
// Every query is as right as on a new tree (G3), but may be slower, because spheres under one node
// are supposed to be neighbours. Build anew when they no longer are: when spheres have moved
// against their neighbours by more than about their distance, or the set has been stretched or
// twisted a good deal. The mean_inflation that check() reports then exceeds that of the tree as
// built; by a fifth, queries visit up to twice the nodes of a new tree, at double, five times as
// many. To move all spheres as one, move the tree's Pose instead.
//
// Throws Error if the numbers of spheres differ, a number in `moved` is not usable, or the sphere
// around all of them would not be, and in a thread that does not round to nearest
// (base/rounding.h).
SphereTree refit(SphereTree tree, std::span<const Sphere> moved);

// Checks the invariants of a sphere tree, of any origin.
//
// @code{.cpp}
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1.0}, {{2, 0, 0}, 1.0}};
// spherule::SphereTreeData data = spherule::build_tree(spheres).data();
// assert(spherule::check(data).valid);
// data.radius[0] = 1.5;  // no longer encloses the two
// assert(!spherule::check(data).valid && !spherule::check(data).problems.empty());
// @endcode

// What check() found. `problems` names the invariant and the node, at most kMaxProblems of them.
struct TreeReport {
  static constexpr std::size_t kMaxProblems = 20;

  bool valid = false;
  std::vector<std::string> problems;
  std::size_t sphere_count = 0;
  std::size_t node_count = 0;
  std::size_t leaf_count = 0;
  int depth = 0;      // edges on the longest way from the root to a leaf
  int branching = 0;  // largest number of children
  double root_radius = 0.0;
  // Mean over inner nodes of radius / largest child radius: how much a level loses.
  double mean_inflation = 0.0;
};

// Checks all five invariants of SphereTree with outward rounding: `valid` is true only if they hold
// in exact arithmetic. A sphere that encloses another by less than a few units in the last place
// may be refused; build_tree never makes one. Throws Error only in a thread that does not round to
// nearest (base/rounding.h).
TreeReport check(const SphereTreeData& data);
TreeReport check(const SphereTree& tree);

// Sphere trees through given levels of detail, and sets of few spheres out of a tree.
//
// @code{.cpp}
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}, {{9, 0, 0}, 1}};
// const std::vector<spherule::SphereLevel> levels{
//     {.spheres = {{{1, 0, 0}, 2.5}, {{9, 0, 0}, 1.5}}, .parent_of = {0, 0, 1}}};
// const spherule::LevelTree made = spherule::build_tree_from_levels(spheres, levels);
// assert(made.tree.sphere(std::size_t(made.nodes[0][0])) == levels[0].spheres[0]);
// assert(spherule::cut(made.tree, 2).size() == 2);
// @endcode

// A set of spheres, each of which encloses some of the next finer set.
struct SphereLevel {
  // Share of its radius by which a sphere has to be larger than it takes to enclose its children,
  // unless it equals its only child: room for the slightly smaller copies of it that
  // build_tree_from_levels() makes.
  static constexpr double kReserve = 0x1p-42;

  std::vector<Sphere> spheres;
  // For every sphere of the next finer set: which of `spheres` encloses it.
  std::vector<std::int32_t> parent_of;
};

// A sphere tree, and where in it the levels stand that it was made from: nodes[k][i] is the node
// whose sphere is sphere i of level k, bit for bit. A sphere with the same sphere as its only child
// shares its child's node.
struct LevelTree {
  SphereTree tree;
  std::vector<std::vector<std::int32_t>> nodes;
};

// Builds the layered hierarchy over `spheres` whose inner nodes are the spheres of `levels`, the
// finest first: the parents of the spheres are those of levels[0], theirs those of levels[1], and
// so on; above the last level it is the tree of build_tree(). Where a sphere has more children than
// `branching`, nodes come between that group them as build_tree() would; such a node whose smallest
// sphere is not enclosed by the parent's takes the parent's sphere instead, a unit in the last
// place smaller. Deterministic. Throws Error for what build_tree() refuses, for a parent that does
// not exist, for a sphere without children, and for one that does not enclose its children with the
// reserve.
LevelTree build_tree_from_levels(std::span<const Sphere> spheres,
                                 std::span<const SphereLevel> levels,
                                 const BuildOptions& options = {});

// At most `count` spheres (at least 1) whose union contains all spheres of the tree, as coarse as
// the tree has them: from the root on, the node with the largest sphere is replaced by its children
// as long as that does not make too many.
std::vector<Sphere> cut(const SphereTree& tree, std::size_t count);

}  // namespace spherule
