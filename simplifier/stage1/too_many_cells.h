// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/error.h"

#include <cstddef>

namespace spherule::internal {

// The grid of stage 1 would have more cells than it may.
class TooManyCells : public Error {
 public:
  // `count` cells, of this edge the finest, are foreseen. The reason says what to choose.
  TooManyCells(double count, double edge, std::size_t max_cells);
  // The number foreseen over the number allowed.
  double factor() const { return factor_; }

 private:
  double factor_;
};

}  // namespace spherule::internal
