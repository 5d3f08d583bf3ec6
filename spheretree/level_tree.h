// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Sphere trees through given levels of detail, and sets of few spheres out of a tree.
//
// @code{.cpp}
// #include <spherule/spheretree/level_tree.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}, {{9, 0, 0}, 1}};
// const std::vector<spherule::SphereLevel> levels{
//     {.spheres = {{{1, 0, 0}, 2.5}, {{9, 0, 0}, 1.5}}, .parent_of = {0, 0, 1}}};
// const spherule::LevelTree made = spherule::build_tree_from_levels(spheres, levels);
// assert(made.tree.sphere(std::size_t(made.nodes[0][0])) == levels[0].spheres[0]);
// assert(spherule::cut(made.tree, 2).size() == 2);
// @endcode

#include "spheretree/build.h"
#include "spheretree/sphere_tree.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule {

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
