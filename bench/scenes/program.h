// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/scenes/work_cell_parts.h"
#include "geometry/pose.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace spherule {

// All postures that bring the flange to a place, in closed form (Pieper 1968): the arm forwards or
// backwards, the elbow on either side, the wrist turned over or not. Up to eight, each position in
// [-pi, pi], joint limits not checked; where the wrist is stretched, one of the two that fall
// together there. The place is met up to the rounding of some operations in double. Throws Error
// for a robot whose axes are not z y y x y x with the last three through one point, as those of
// make_robot() are.
std::vector<ArmPositions> inverse_kinematics_branches(const RobotModel& robot,
                                                      const Pose& world_from_flange);

// Limits included.
bool is_within_limits(const RobotModel& robot, const ArmPositions& positions);

// Joint positions are multiples of 2^-20 radians (one micrometre at a metre's reach): rounding
// hides what the library's sine and cosine do in their last bits, so that every machine gets the
// same.
ArmPositions on_joint_grid(const ArmPositions& positions);

// Damped least squares (Wampler 1986) from a start, so that a sequence of near targets gives a
// continuous motion: positions on the grid that bring the flange within 5 micrometres and 5e-6
// radians of the target, joint limits kept; nothing where 200 steps do not get there.
std::optional<ArmPositions> solve_inverse_kinematics(const RobotModel& robot,
                                                     const Pose& world_from_flange,
                                                     const ArmPositions& start);

// A place and a direction for the wire's end, in the workpiece's frame.
struct WireTarget {
  Eigen::Vector3d position;
  Eigen::Vector3d direction;  // unit, into the metal
};

// How far the wire's end is kept off a point of the metal, along the mean of its normals: farther
// in the crotch of a seam, for the nozzle. Metres.
double standoff(const SeamPoint& point);

// Of a seam's lowest point that is welded (see seam_point()), where the nozzle still has room.
inline constexpr double kLowestSeamAngle = 0.35;

// Runs of the torch over the workpiece, each with `length` targets: across the joint along two
// seams, along a pipe, around a pipe's rim; with weave, tilt and tack points. Always the same.
std::vector<std::vector<WireTarget>> make_weld_passes(std::size_t length);

inline constexpr std::size_t kProgramSize = 15178;  // collision checks of the paper's experiment

// Where table and workpiece stand in the robot's base frame.
Pose world_from_table();
Pose world_from_workpiece();

struct Program {
  std::vector<ArmPositions> configurations;
  // 1 for those in which the wire is at the metal, on a pass: the paper's critical section.
  std::vector<std::uint8_t> is_critical;
};

// The weld program of the work cell, in the order in which the robot runs it: from home over the
// workpiece, down to a seam, along it a few millimetres off with weave and tilt, up and home again,
// for passes over the joint's seams, along the pipes and around their rims. In places the wire is
// pushed on to the metal (tack points); between some passes the torch is taken to a station behind
// the fixture post by a move that does not mind the post, so that forearm and wrist hit it.
// Continuous, within the joint limits, the same numbers on every machine (see on_joint_grid()).
// Throws Error if a target is out of reach.
Program make_program(const Pose& flange_from_wire);

// The same configurations in an order without coherence (seeded, the same on every machine).
std::vector<ArmPositions> shuffled(std::vector<ArmPositions> program, std::uint64_t seed);

}  // namespace spherule
