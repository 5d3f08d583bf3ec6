// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The paper's work cell: its models, and the weld program.

#include "geometry/pose.h"
#include "geometry/triangle_mesh.h"
#include "robot/model/robot_model.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace spherule {

inline constexpr double kTableHeight = 0.75;      // of the top's upper face above the floor
inline constexpr double kWorkpieceHeight = 0.16;  // of the pipes' axes above the top

// A weld table in metres, the middle of its top above the origin of the floor: a top with bores,
// legs, three stands that carry the pipes of the workpiece, and a fixture post with a clamp arm on
// the robot's left (the robot stands in the direction of -x and looks along +x).
TriangleMesh make_table();

// A bent MIG weld torch in the frame of the flange it is mounted on (x out of the flange), in
// metres: adapter with screw holes, shock sensor, body, swan neck in the xz plane, open gas nozzle,
// contact tip and wire. 4,318 triangles, as the torch of the paper has.
TriangleMesh make_torch();

// The end of the wire: z points along the wire, out of the torch; the torch's body lies on the side
// of +x.
Pose flange_from_wire();

// Three pipes of 40 mm (bore 34 mm) that meet in one joint at 120 degrees, in metres: their axes
// leave the origin in the xy plane, pipe 0 along +x, the next ones counter-clockwise. One closed
// solid of 1,942 triangles, hollow throughout, open at the three ends, mitred along three seams.
inline constexpr double kPipeRadius = 0.020;
inline constexpr double kPipeBoreRadius = 0.017;
inline constexpr double kPipeLength = 0.26;  // from the joint's centre to the end

TriangleMesh make_workpiece();

// Direction of a pipe's axis.
Eigen::Vector3d pipe_axis(int pipe);

// A point of the outer surface with the outward normals of the one or two pipes that meet in it.
struct SeamPoint {
  Eigen::Vector3d point;
  Eigen::Vector3d normal_a;
  Eigen::Vector3d normal_b;
};

// The seam between pipe `pipe` and the next one, from the crotch (angle 0) to the top of the joint
// (angle pi / 2), where all three seams meet.
SeamPoint seam_point(int pipe, double angle);

// The rim at a pipe's end, by the angle from the horizontal; both normals are the pipe's.
SeamPoint rim_point(int pipe, double angle);

// A pipe's surface at a distance from the centre, by the angle from the horizontal.
SeamPoint pipe_point(int pipe, double distance, double angle);

inline constexpr int kJoints = 6;
using ArmPositions = std::array<double, kJoints>;  // radians

// A six-axis industrial robot with the joint origins, axes and limits of the ABB IRB 4400L-30/2.43,
// in metres and radians: links base_link, link_1 .. link_6, without trees.
RobotModel make_robot();

// From link_6 to the mounting face of a tool; x points out of the flange.
Pose link6_from_flange();

// The links as solids in their frames, in the order of make_robot().links(), in metres: housings
// with ribs, flanges and screw holes as closed shells that overlap, of about the size of the real
// ones. 6,825 triangles in all, as the robot of the paper has.
std::array<TriangleMesh, kJoints + 1> make_robot_links();

// Joint positions are multiples of 2^-20 radians (one micrometre at a metre's reach): rounding
// hides what the library's sine and cosine do in their last bits, so that every machine gets the
// same.
ArmPositions on_joint_grid(const ArmPositions& positions);

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
