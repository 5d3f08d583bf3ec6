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
