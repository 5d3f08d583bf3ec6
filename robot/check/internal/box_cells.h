// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// FreeBoxes of few variables as cells for the kernels, which query a cell in a fraction of the time
// that a search in the tree of boxes takes.

#include "collide/kernels/free_cells.h"
#include "robot/pairs/free_boxes.h"

#include <memory>
#include <span>

namespace spherule::internal {

// The cells all of whose configurations lie in free boxes, by FreeBoxes::contains(). For each of
// the boxes' variables the position of the plan that is its value. None for boxes of no or too many
// variables, and if no cell is free.
std::shared_ptr<const FreeCells> box_cells(const FreeBoxes& boxes, std::span<const int> positions);

}  // namespace spherule::internal
