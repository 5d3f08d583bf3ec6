// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"
#include "collide/robot/robot_checker.h"

#include <memory>

namespace spherule {

// The workload's robot with its sphere trees, among its obstacles.
RobotChecker make_robot_checker(const Workload& workload,
                                InstructionSet instructions = best_instruction_set());

enum class TreeMode { kSingle, kBatch };

// It, as an engine: one configuration a call, or all.
std::unique_ptr<Checker> make_tree_checker(const Workload& workload, TreeMode mode,
                                           InstructionSet instructions = best_instruction_set());

}  // namespace spherule
