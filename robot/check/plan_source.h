// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/kernels/check_plan_source.h"
#include "collide/kernels/plan_trees.h"
#include "robot/check/body_pairs.h"
#include "robot/pairs/link_pairs.h"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace spherule::internal {

// The pairs of a robot as a plan is compiled from them.
struct RobotPlanSource {
  PlanSource source;
  std::vector<std::size_t> pair_of_test;  // of each test of the source
  std::vector<std::size_t> fixed_pairs;   // that no joint moves: they are not among the tests
  std::size_t first_static_tree = 0;  // the first test of BodyPairs::static_tree_pairs_begin() on
};

RobotPlanSource make_plan_source(const BodyPairs& pairs);

}  // namespace spherule::internal

// FreeBoxes of few variables as cells for the kernels, which query a cell in a fraction of the time
// that a search in the tree of boxes takes.

namespace spherule::internal {

// The cells all of whose configurations lie in free boxes, by FreeBoxes::contains(). For each of
// the boxes' variables the position of the plan that is its value. None for boxes of no or too many
// variables, and if no cell is free.
std::shared_ptr<const FreeCells> box_cells(const FreeBoxes& boxes, std::span<const int> positions);

}  // namespace spherule::internal
