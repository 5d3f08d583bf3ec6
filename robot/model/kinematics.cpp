// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/kinematics.h"

#include "base/error.h"
#include "base/rounding.h"
#include "robot/model/joint_positions.h"
#include "robot/model/link_paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace spherule {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Error budget of forward_kinematics and kinematics_error_bound, u = 2^-53, to first order.
//
// The exact mechanism has the joints as stored: parent_from_joint is the pose of its quaternion and
// translation, the axis is axis / |axis|. Errors of a quaternion are vector norms relative to its
// length; an error e turns a rotation by at most 2 e in the operator norm. The length itself has
// no meaning (a Pose is q / norm(q)) and stays within 1 +- 40 u n over n joints.
//
//   joint: half the angle is exact; sine and cosine of the C library err by less than 2 units in
//     the last place, 4 u (glibc: below 1 for every argument), in both parts 5.7 u; the axis times
//     the sine 1 u; the axis has a length of 1 +- 4 u: 4 u. Together 10.7 u.
//   products: a component is a sum of four products, in any order 4 u |p| |q|; four of them: 8 u.
//     Two products a joint: 16 u.
//   So a joint adds 26.7 u, and the rotation n joints from the root errs by at most 54 u n; where
//   the root's own quaternion had to be normalised, 4 u = 8 u of rotation more.
//   translation: a step by v (the joint's origin, or a prismatic motion) is matrix * v, with the
//     rotation's error, 60 u for the entries (kRotationEntryError), 5.2 u for rounding and, for a
//     prismatic motion, 1 u for axis * q and 4 u for the axis' length: (54 n + 8 + 71) u |v|. Each
//     sum adds u |t| with |t| at most the distance D of the root plus the length L of the chain so
//     far; there are at most two a joint.
//   A point at distance `reach` is turned with the last link: (54 n + 8) u reach.
// With L the sum of the steps' lengths (100 m for a prismatic motion), over n joints
//     (54 n + 8) u reach + (54 n + 79) u L + 2 n u (D + L).
//   mimics: a position that errs by e (mimic_error()) turns what lies beyond the joint, at most
//     reach + L from it, by e, or shifts it by e.
double chain_bound(double joints, double length, double reach, double root_distance) {
  return kUnitRoundoff * ((60.0 * joints + 10.0) * reach + (60.0 * joints + 85.0) * length +
                          4.0 * joints * root_distance);
}

// The joint's own rotation is composed first: it does not wait for the parent's, which is the chain
// of operations that the time of a long mechanism depends on.
Pose move(const Pose& world_from_parent, const Quaterniond& parent_rotation, const Joint& joint,
          double position) {
  const Quaterniond at_zero = joint.parent_from_joint.rotation();
  const Vector3d& origin = joint.parent_from_joint.translation();
  if (joint.turns()) {
    const double sine = std::sin(0.5 * position);
    const double cosine = std::cos(0.5 * position);
    const Quaterniond turn(cosine, joint.axis.x() * sine, joint.axis.y() * sine,
                           joint.axis.z() * sine);
    return Pose(parent_rotation * (at_zero * turn), world_from_parent * origin);
  }
  const Pose world_from_joint(parent_rotation * at_zero, world_from_parent * origin);
  if (joint.type == JointType::kFixed) return world_from_joint;
  return Pose(world_from_joint.rotation(), world_from_joint * Vector3d(joint.axis * position));
}

}  // namespace

void forward_kinematics(const RobotModel& robot, std::span<const double> configuration,
                        std::vector<Pose>& world_from_link, const Pose& world_from_root) {
  if (configuration.size() != static_cast<std::size_t>(robot.variable_count())) {
    throw Error("configuration", "it has " + std::to_string(configuration.size()) +
                                     " numbers where the robot has " +
                                     std::to_string(robot.variable_count()) + " variables");
  }
  for (const double position : configuration) {
    if (!std::isfinite(position)) throw Error("configuration", "a position is not finite");
  }
  world_from_link.resize(robot.links().size());
  world_from_link[0] = world_from_root;
  const Quaterniond root_rotation = unit_rotation(world_from_root.rotation());
  for (const Joint& joint : robot.joints()) {
    const auto parent = static_cast<std::size_t>(joint.parent_link);
    world_from_link[static_cast<std::size_t>(joint.child_link)] = move(
        world_from_link[parent], parent == 0 ? root_rotation : world_from_link[parent].rotation(),
        joint, joint.position(configuration));
  }
}

double kinematics_error_bound(const RobotModel& robot, double reach, double root_distance) {
  // Of the chain to each link; a parent comes before its children.
  struct Chain {
    double joints = 0.0;
    double length = 0.0;
    double turned = 0.0;  // by errors of positions
    double shifted = 0.0;
  };
  std::vector<Chain> chains(robot.links().size());
  double bound = 0.0;
  for (const Joint& joint : robot.joints()) {
    Chain chain = chains[static_cast<std::size_t>(joint.parent_link)];
    chain.joints += 1.0;
    chain.length += joint.parent_from_joint.translation().norm();
    if (joint.type == JointType::kPrismatic) chain.length += kLargestJointPosition;
    (joint.turns() ? chain.turned : chain.shifted) += internal::mimic_error(joint);
    bound = std::max(bound, chain_bound(chain.joints, chain.length, reach, root_distance) +
                                chain.turned * (reach + chain.length) + chain.shifted);
    chains[static_cast<std::size_t>(joint.child_link)] = chain;
  }
  return bound;
}

// The rounding that G6 charges. With |from| and |to| at most 100, at most n = 32 turns are taken
// off. The double kTurn is within 2.5e-16 of 2 pi, which n turns multiply to 8e-15. The product is
// not rounded, and the difference, below 128 in magnitude, by at most half a unit in its last
// place, 7.2e-15. Together less than kTurnError.
double nearest_turn(double from, double to) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double step = to - from;
  if (std::abs(step) <= std::numbers::pi) return to;
  return std::fma(-std::round(step / kTurn), kTurn, to);
}

ShortestMotion::ShortestMotion(const RobotModel& robot)
    : turns_(static_cast<std::size_t>(robot.variable_count()), 0) {
  const auto leader_of = [&](const Joint& joint) -> const Joint& {
    const int leader = robot.variable_joints()[static_cast<std::size_t>(joint.variable)];
    return robot.joints()[static_cast<std::size_t>(leader)];
  };
  for (const Joint& joint : robot.joints()) {
    if (!joint.moves() || leader_of(joint).type != JointType::kContinuous) continue;
    turns_[static_cast<std::size_t>(joint.variable)] = 1;
    has_turns_ = true;
    if (joint.type == JointType::kContinuous && is_periodic(joint)) continue;
    if (!refused_.empty()) continue;
    refused_ = joint.name;
    leader_ = leader_of(joint).name;
  }
}

void ShortestMotion::require() const {
  if (refused_.empty()) return;
  throw Error("joint " + refused_,
              "it follows the continuous joint " + leader_ +
                  ", but is not continuous itself with a whole multiplier, so that a motion by the "
                  "shorter way would not bring it to where it is stated to be");
}

std::span<const double> ShortestMotion::end_of(std::span<const double> from,
                                               std::span<const double> to,
                                               std::vector<double>& end) const {
  if (from.size() != turns_.size() || to.size() != turns_.size()) {
    throw Error("configuration", "the ends of a motion have another size than the robot's");
  }
  if (!has_turns_) return to;
  end.assign(to.begin(), to.end());
  for (std::size_t i = 0; i < end.size(); ++i) {
    if (turns(i)) end[i] = nearest_turn(from[i], to[i]);
  }
  return end;
}

const Joint* joint_without_limits(const RobotModel& robot) {
  for (const int index : robot.variable_joints()) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(index)];
    if (joint.type != JointType::kContinuous && !has_limits(joint)) return &joint;
  }
  return nullptr;
}

void require_limits(const RobotModel& robot) {
  if (const Joint* const joint = joint_without_limits(robot)) {
    throw Error("joint " + joint->name,
                "it has no limits, which are needed here: correct its <limit> in the URDF");
  }
}

JointPositions::JointPositions(const RobotModel& robot) : has_mimics_(robot.has_mimics()) {
  for (const Joint& joint : robot.joints()) {
    if (joint.moves()) moving_.push_back(joint);
  }
}

JointPositions::Scratch JointPositions::scratch_for(std::size_t configurations) const {
  if (!has_mimics_) return {};
  return {std::vector<double>(configurations * moving_.size())};
}

std::span<const double> JointPositions::computed(std::span<const double> configuration,
                                                 Scratch& scratch, std::size_t place) const {
  const std::span<double> positions =
      std::span(scratch.positions).subspan(place * moving_.size(), moving_.size());
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    positions[i] = moving_[i].position(configuration);
  }
  return positions;
}

}  // namespace spherule
