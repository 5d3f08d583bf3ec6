// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Engines that check the spheres of a workload: ours, and others.

#include "bench/checkers/workload.h"
#include "collide/search/instruction_set.h"
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

// The same spheres as FCL shapes: one DynamicAABBTreeCollisionManager holds the moving spheres
// (moved and updated for every configuration), one each obstacle's; manager against manager.
std::unique_ptr<Checker> make_fcl_sphere_checker(const Workload& workload);

// The same spheres in Bullet (single precision, as Debian packages it): a btCompoundShape of
// btSphereShapes for each body and obstacle, its dynamic AABB tree rebuilt from the top down, which
// Bullet's own insertion one by one falls behind of, margins zero. Radii are padded by what
// rounding costs, so that no contact is missed.
enum class BulletQuery {
  // btCollisionWorld::contactPairTest for each pair whose boxes overlap: the interface that Bullet
  // offers. It finds all contacts of a pair: there is no way to stop it at the first.
  kContactPairTest,
  // The two compounds' trees, walked in the order and with the box test of Bullet's own algorithm
  // for compounds, with a plain test of two spheres at the leaves, until the first contact: faster
  // than what a user can have from Bullet.
  kTrees,
};

std::unique_ptr<Checker> make_bullet_sphere_checker(const Workload& workload, BulletQuery query);

// The same spheres without a hierarchy, scanned in single precision by the widest vectors that the
// machine has: what a user of a list of spheres would write, as well as we can. Forward kinematics
// in double, with sines and cosines side by side. Radii are padded by what rounding costs, so that
// no contact is missed.
enum class FlatScan {
  // All pairs of each body's and each obstacle's spheres, to the first contact.
  kAllPairs,
  // The sphere around each body goes first, against the sphere around the obstacle and against each
  // of its spheres; what is left is compared with all spheres of the body.
  kSpheresInFront,
};

// Throws Error for a robot with more than 8 variables or a joint that shifts, for more than 32
// obstacles, and for instructions that this machine has not got.
std::unique_ptr<Checker> make_flat_scan_checker(
    const Workload& workload, FlatScan scan, InstructionSet instructions = best_instruction_set());

}  // namespace spherule
