// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/pairs/internal/pair_space.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace spherule::internal {

// What halving proved.
struct PairSearchResult {
  std::string nodes;  // as FreeBoxes takes them
  std::size_t boxes = 0;
  // The first middle of a box at which the links touch; empty if none did.
  std::vector<double> witness{};
};

// Where surfaces of fine meshes are near each other in most of a box, it takes thousands of tests
// of pieces. So a search of n boxes also ends once its boxes have taken n times as many as this.
inline constexpr std::size_t kTestsOfBox = 1000;

struct PairSearchLimits {
  std::size_t boxes = 0;
  // Where the links touch, or where so many boxes leave more than kHopeful of the ranges open.
  std::size_t boxes_once_touching = 0;
  // Called at most once, after so many boxes of which no middle touches: whether another search
  // finds that the links do.
  std::function<bool()> finds_contact{};
  double smallest_motion = 0.0;     // of boxes that are halved, metres
  std::function<bool()> is_over{};  // no time is left
};

// What boxes leave open halves more and more slowly, the more joints there are. Where it is more
// than this share of the ranges after LinkPairOptions::boxes, ten times as many do not finish it.
inline constexpr double kHopeful = 0.25;

// Proves boxes of the ranges free, the largest first, those around touching middles later: each box
// that is not proved at its middle is halved, along the variable that moves the links most against
// each other.
//
// Proof for one box (G9). Either the hulls of the links, grown by their radii, are apart throughout
// (pair_bound.h). Or all pairs of leaves (link_pieces.h) are, by pieces that
// hold them, so that the surfaces of meshes,
// grown, and spheres have no point in common throughout; and at the middle the solids have none, as
// exact tests say that know the inside. Then they have none anywhere in the box: it is connected,
// so that on the straight way from the middle a first point in common would have to be one of the
// surfaces, or of a sphere, which is a piece as a whole. The test at the middle holds for the exact
// mechanism too: the pieces' distance exceeds the error of the poses. A pair of nodes of the trees
// of pieces that is proved apart in a box is in its halves; pairs that are not are handed down to
// them.
PairSearchResult search_free_boxes(const PairSpace& space, const PairSearchLimits& limits);

}  // namespace spherule::internal
