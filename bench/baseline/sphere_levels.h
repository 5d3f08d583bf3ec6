// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Spheres in levels as the literature makes them, as a tree for queries.
//
// @code{.cpp}
// #include <spherule/bench/baseline/sphere_levels.h>
// #include <cassert>
//
// const spherule::SphereLevels spheres{
//     .levels = {{{{1, 0, 0}, 1.5}}, {{{0, 0, 0}, 1}, {{2, 0, 0}, 1}}}, .parents = {{0, 0}}};
// const auto made = spherule::enclosing_tree(spheres, spheres.levels.back());
// assert(made.tree.root().radius >= 2.0);  // made larger: it encloses its children
// @endcode

#include "geometry/sphere.h"
#include "spheretree/level_tree.h"

#include <cstdint>
#include <span>
#include <vector>

namespace spherule {

// Spheres in levels as the literature makes them, the coarsest first. Each level is meant to cover
// the solid by itself; a sphere need not enclose its children, only what they cover.
struct SphereLevels {
  std::vector<std::vector<Sphere>> levels;
  // parents[k][i]: the sphere of level k that sphere i of level k + 1 hangs under. One fewer than
  // levels.
  std::vector<std::vector<std::int32_t>> parents;
};

// Conservative if `leaves` are. A tree for the traversals of the library: its leaves are `leaves`,
// the finest level in its order, as it is or made conservative; the spheres above become as large
// as they have to be to enclose their children in exact arithmetic, about their own centre or,
// where that is smaller, about the centre of the sphere that encloses the children. A sphere
// without children is left out. Throws Error if the numbers of spheres and parents do not agree, or
// a parent is not there.
LevelTree enclosing_tree(const SphereLevels& levels, std::span<const Sphere> leaves);

}  // namespace spherule
