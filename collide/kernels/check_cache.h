// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/kernels/free_cells.h"
#include "collide/kernels/search_trees.h"

namespace spherule::internal {

// What compiled checks of a robot are made from and takes time to compute, kept with the robot.
struct CheckCache {
  SearchTreeCache search_trees;
  FreeCellsCache free_cells;
};

}  // namespace spherule::internal
