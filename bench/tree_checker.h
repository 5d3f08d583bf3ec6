// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"
#include "collide/robot/robot_scene.h"

#include <memory>

namespace spherule {

// The workload's robot with its sphere trees, among its obstacles, its links not tested against
// each other; contacts confirmed on the triangles if asked for.
RobotChecker make_robot_checker(const Workload& workload,
                                InstructionSet instructions = best_instruction_set(),
                                bool confirmed = false);

enum class TreeMode { kSingle, kBatch, kConfirmed, kPairs, kMeshes };

// It, as an engine: one configuration a call, all, or one with confirmation. Or, without it,
// forward_kinematics() and collides() for each body and obstacle; or the robot and its torch as
// meshes (RobotMeshChecker) among the sphere trees of the obstacles.
std::unique_ptr<Checker> make_tree_checker(const Workload& workload, TreeMode mode,
                                           InstructionSet instructions = best_instruction_set());

}  // namespace spherule
