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
  // The least number over the number allowed: above 1.
  double factor() const { return factor_; }

 private:
  double factor_;
};

}  // namespace spherule::internal
