// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"
#include "robot/check/robot_scene.h"

#include <memory>

namespace spherule {

// Whose meshes take the place of their spheres (RobotCheckerOptions::meshes).
enum class UsedMeshes { kNone, kOfRobot, kAll };

// The workload's robot with its sphere trees, among its obstacles, its links not tested against
// each other.
RobotChecker make_robot_checker(const Workload& workload,
                                InstructionSet instructions = best_instruction_set(),
                                UsedMeshes used = UsedMeshes::kNone);

enum class TreeMode { kSingle, kBatch, kConfirmed, kPairs, kMeshes };

// It, as an engine: one configuration a call, all, one with all meshes, or one with the meshes of
// the robot and its torch among the spheres of the obstacles. Or, without it, forward_kinematics()
// and collides() for each body and obstacle.
std::unique_ptr<Checker> make_tree_checker(const Workload& workload, TreeMode mode,
                                           InstructionSet instructions = best_instruction_set());

}  // namespace spherule
