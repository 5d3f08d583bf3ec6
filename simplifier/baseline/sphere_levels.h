// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/level_tree.h"
#include "spheretree/sphere.h"

#include <cstdint>
#include <span>
#include <vector>

namespace spherule {

// Balls in levels as the literature makes them, the coarsest first. Each level is meant to cover
// the solid by itself; a ball need not enclose its children, only what they cover.
struct SphereLevels {
  std::vector<std::vector<Sphere>> levels;
  // parents[k][i]: the ball of level k that ball i of level k + 1 hangs under. One fewer than
  // levels.
  std::vector<std::vector<std::int32_t>> parents;
};

// Conservative if `leaves` are. A tree for the traversals of the library: its leaves are `leaves`,
// the finest level in its order, as it is or made conservative; the balls above become as large as
// they have to be to enclose their children in exact arithmetic, about their own centre or, where
// that is smaller, about the centre of the ball that encloses the children. A ball without children
// is left out. Throws Error if the numbers of balls and parents do not agree, or a parent is not
// there.
LevelTree enclosing_tree(const SphereLevels& levels, std::span<const Sphere> leaves);

}  // namespace spherule
