// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere_tree.h"

#include <span>

namespace spherule {

// The tree over `moved`, the spheres of `tree` after they have moved, grown or shrunk: as many, in
// the same order. The nodes and their children stay; the ball of an inner node becomes the smallest
// around the balls of its children, as build_tree() makes it, unless none of these has changed:
// then it stays. So spheres that have not moved give the same bytes, and a tree of build_tree()
// gives balls that depend on its nodes and on `moved` alone, whatever refits lie between.
// Deterministic (G7). O(n). A tree that is moved in (std::move) is not copied.
//
// Every query is as right as on a new tree (G3), but may be slower: spheres that stand under one
// node are supposed to be neighbours. Build anew when they are no longer, that is, when spheres
// have moved against their neighbours by several times their distance; check() shows it, whose
// mean_growth rises from that of the tree as it was built. To move all spheres as one, move the
// tree's Pose instead.
//
// Throws Error if the numbers of spheres differ, a number in `moved` is not usable, or the ball
// around all of them would not be.
SphereTree refit(SphereTree tree, std::span<const Sphere> moved);

}  // namespace spherule
