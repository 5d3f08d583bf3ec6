// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere_tree.h"

#include <span>

namespace spherule {

struct BuildOptions {
  // Children of a wide node, 2 to SphereTree::kMaxBranching.
  int branching = 8;
};

// Builds the layered hierarchy over `spheres`: top-down splits along the longest axis of the
// centres at their mean (at the median where all centres coincide or the depth grows past 2 log2 n
// + 8, so that no input gives a depth of more than 3 log2 n + 9 edges, log2 rounded up), collapsed
// to wide nodes by opening the child with the largest radius; the ball of each inner node is the
// smallest enclosing ball of its children's balls, rounded up so that it encloses them in exact
// arithmetic (G3). Deterministic (G7): no threads, no random numbers, only + - * / sqrt. O(n log n)
// time, of which the splits take half and the balls a quarter for a million spheres; O(n) memory,
// some 160 bytes a sphere. Where the same spheres only move, refit() is faster. Throws Error if
// `spheres` is empty or has more than 2^30 elements, a number in it is not usable, the ball around
// all of them would not be usable, or an option is out of range.
SphereTree build_tree(std::span<const Sphere> spheres, const BuildOptions& options = {});

}  // namespace spherule
