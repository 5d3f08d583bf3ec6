// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"
#include "robot/check/robot_scene.h"

#include <memory>

namespace spherule {

// Upper bound, up to rounding, of how far from the world's origin any point of the workload's trees
// can be, in any configuration, in metres: the length along the chain, or the obstacle's reach.
double scene_reach(const Workload& workload);

// What engines in single precision add to each radius. With v = 2^-24 and S the reach: a centre
// that is rounded, and one that is moved by a matrix and a shift that are, err by less than 2 v S
// and 12 v S (in each coordinate 1 v S for each of: centre, matrix, shift, three products and sums;
// times the root of three); a rotation that is the product of two rounded ones by 6 v S more.
// Squares, sums and differences change where a pair counts as touching by less than 6 v S. Twice
// the sum: what the root sphere that a body is tested with in front loses is no more than that.
double single_precision_pad(double reach);

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
