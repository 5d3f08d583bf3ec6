// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/pairs/internal/link_pieces.h"
#include "robot/pairs/internal/pair_bound.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// A node of the tree of pieces of each of two links.
struct PieceNodes {
  std::int32_t first;
  std::int32_t second;
};

// Two links at the middle of a box, and the bound for all of it. Refers to what it is given.
struct PlacedPair {
  const LinkPieces& of_first;
  const Pose& world_from_first;
  const LinkPieces& of_second;
  const Pose& world_from_second;
  const PairBound& bound;

  // Between two sets of points, each in the frame of its link: the direction in the world, searched
  // from the one given, and the gap along it, up to rounding.
  double direction_between(std::span<const Eigen::Vector3d> first,
                           std::span<const Eigen::Vector3d> second,
                           Eigen::Vector3d& direction) const;
};

// Takes from a front, pairs of nodes that hold all pairs of leaves not proved apart yet, what is
// proved apart throughout the box, and opens the rest. True if nothing is left. Adds to `tests` how
// many pairs of nodes it examined.
bool clear_front(const PlacedPair& pair, std::vector<PieceNodes>& front, std::size_t& tests);

}  // namespace spherule::internal
