// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/kernels/check_plan_source.h"
#include "robot/check/internal/body_pairs.h"

#include <cstddef>
#include <vector>

namespace spherule::internal {

// The pairs of a robot as a plan is compiled from them.
struct RobotPlanSource {
  PlanSource source;
  std::vector<std::size_t> pair_of_test;  // of each test of the source
  std::vector<std::size_t> fixed_pairs;   // that no joint moves: they are not among the tests
};

// The first `count` of the pairs.
RobotPlanSource make_plan_source(const BodyPairs& pairs, std::size_t count);

}  // namespace spherule::internal
