// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/error.h"

#include <cstddef>

namespace spherule::internal {

// The grid of stage 1 would have more cells than it may.
class TooManyCells : public Error {
 public:
  // So many cells, of this edge the finest, are foreseen, the least if most large ones need not be
  // halved. The reason says what to choose so that memory suffices for the most.
  TooManyCells(double most_foreseen, double least_foreseen, double edge, std::size_t max_cells);
  // How many times longer the edges of the cells have to be, with a margin: above 1. The least
  // number goes with the area of the surface over their square.
  double coarsening() const { return coarsening_; }

 private:
  double coarsening_;
};

}  // namespace spherule::internal
