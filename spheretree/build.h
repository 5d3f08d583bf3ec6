// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Makes the sphere tree over a set of spheres.
//
// @code{.cpp}
// #include <spherule/spheretree/build.h>
// #include <cassert>
// #include <vector>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 1}, {{2, 0, 0}, 1}, {{4, 0, 0}, 1}};
// const spherule::SphereTree tree = spherule::build_tree(spheres, {.branching = 2});
// assert(tree.spheres().size() == 3 && tree.root().radius >= 3.0);
// @endcode

#include "spheretree/sphere_tree.h"

#include <span>

namespace spherule {

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

}  // namespace spherule

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

namespace spherule {

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

}  // namespace spherule
