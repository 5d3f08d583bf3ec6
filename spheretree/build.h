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
// centres at their mean (at the median where that leaves one side empty or the depth grows past 2
// log2 n + 8), collapsed to wide nodes by opening the child with the largest radius; the ball of
// each inner node is the smallest enclosing ball of its children's balls, rounded up so that it
// encloses them in exact arithmetic (G3). Deterministic; O(n log n).
// Throws Error if `spheres` is empty, a number in it is not usable, or an option is out of range.
SphereTree build_tree(std::span<const Sphere> spheres, const BuildOptions& options = {});

}  // namespace spherule
