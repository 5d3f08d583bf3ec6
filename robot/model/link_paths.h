// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/kernels/check_plan_source.h"
#include "geometry/sphere.h"
#include "robot/model/kinematics.h"
#include "robot/model/robot_model.h"

#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace spherule::internal {

// The joints between two links, by their indices, from the first link to the second: up to the last
// link that both hang from, and down again.
std::vector<int> joints_between(const RobotModel& robot, int first, int second);
// Of these the ones that move.
std::vector<int> moving_joints(const RobotModel& robot, int first, int second);

enum class Joined {
  kRigidly,     // no joint moves them against each other
  kByOneJoint,  // that moves, directly or past links without spheres
  kFurther,     // neither
};

// How the links of a robot hang together.
class LinkRelations {
 public:
  struct Relation {
    Joined joined = Joined::kRigidly;
    bool are_neighbours = true;  // no link between them has spheres
  };

  // Of a robot that outlives it.
  explicit LinkRelations(const RobotModel& robot);

  // Of one link to every other, by the index of the other. One traversal, linear in the links: a
  // path for each pair makes long chains cubic. `has_spheres` is called with indices of links.
  std::vector<Relation> of(int first, const std::function<bool(int)>& has_spheres) const;

 private:
  const RobotModel& robot_;
  std::vector<std::vector<int>> joints_of_;  // of each link, to its parent and its children
};

// How far two bodies are at most from the axes of the joints between them, whatever these do. The
// proof is in link_paths.cpp; what follows for motions, in collide/kernels/plan_vectors.h.
class PathReach {
 public:
  struct Step {
    int joint = 0;
    bool turns = false;
    double first = 0.0;   // how far points of the first body are from the axis, without shifts
    double second = 0.0;  // of the second one
  };

  // The joints that move one of the two against the other, from the first body to the second; the
  // first body is in a sphere of the frame of its link, the second in another one, or else it
  // stands still. `link_poses` are those of the robot with all joints at zero; a point mapped by
  // them, or a direction times `error`, may be off by `error`.
  PathReach(const RobotModel& robot, std::span<const Pose> link_poses, double error,
            std::span<const int> joints, int first_link, const Sphere& first);
  PathReach(const RobotModel& robot, std::span<const Pose> link_poses, double error,
            std::span<const int> joints, int first_link, const Sphere& first, int second_link,
            const Sphere& second);

  // One for each joint, from the first body on.
  const std::vector<Step>& steps() const { return steps_; }

 private:
  std::vector<Step> steps_;
};

// The moving frames of a robot: one for each joint that moves, its z axis turned into the joint's
// axis, and where every link stands in the frame that carries it. A frame's position is the
// position of its joint (joint_positions()): a variable of the robot, where no joint mimics
// another.
struct MovingFrames {
  explicit MovingFrames(const RobotModel& robot);

  std::vector<PlanSource::Frame> frames;
  std::vector<int> frame_of_link;  // -1: it stands with the root
  std::vector<Pose> frame_from_link;
};

// How exact poses are, of all links.
struct MovingPoseError {
  double error = 0.0;  // how far a point of a link may be from where the canonical poses take it
  // At least twice what bounds all lengths of the robot and the scene, positions of joints up to
  // kLargestJointPosition.
  double size = 0.0;
};

// Of points at most `reach` from their link's frame, as seen from the moving frames. `scene` bounds
// how far obstacles reach, and `root_distance` how far the root is, from the world's origin. It
// holds for motions that are straight in the robot's variables, too, where the frames' variables go
// straight from those of one end to those of the other. Throws Error if these are too large to be
// computed with.
MovingPoseError moving_pose_error(const RobotModel& robot, double reach, double scene,
                                  double root_distance);

// How far the computed position p of a joint is from the exact one, for |p| <=
// kLargestJointPosition = P; zero unless the joint mimics another. With m the multiplier, o the
// offset, q the variable and u = 2^-53, the product errs by u |m q| and the sum by u |p|, and |m q|
// <= P + |o| up to terms of second order, so that the sum is at most u (2 P + |o|); the factor
// covers those terms.
inline double mimic_error(const Joint& joint) {
  if (joint.mimics < 0) return 0.0;
  return 1.001 * kUnitRoundoff * (2.0 * kLargestJointPosition + std::abs(joint.offset));
}

// How far apart two of these can be anywhere on a motion that is straight in the variables, with
// both its ends within P: the exact position m q + o; the computed one, of the exact q or of a q
// that was computed at that place as (1 - t) q_0 + t q_1; and the position on the straight line
// from one end's computed position to the other's, as computed by the same formula or exactly. With
// e = mimic_error(), the line is within e of the exact position, because its ends are; computing a
// place on it errs by 3 u 2 P; and a computed q errs by 3 u (|q_0| + |q_1|), which moves m q + o by
// 6 u (P + |o|), beside e for rounding. All together at most 2 e + u (12 P + 6 |o|) <= 8 e.
inline double mimic_error_on_edges(const Joint& joint) {
  return 8.0 * mimic_error(joint);
}

// How far the position of a joint is, anywhere on such a motion, from where it is on the exact
// motion whose end was computed by nearest_turn(): that moves the variable by kTurnError at most,
// at the end, and less before. Zero where no motion may be meant so.
inline double turn_error(const RobotModel& robot, const Joint& joint) {
  if (!joint.moves() || !is_periodic(joint)) return 0.0;
  const int leader = robot.variable_joints()[static_cast<std::size_t>(joint.variable)];
  const bool leader_turns = robot.joints()[static_cast<std::size_t>(leader)].turns();
  return leader_turns ? std::abs(joint.multiplier) * kTurnError : 0.0;
}

}  // namespace spherule::internal
