// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/trajectory_review.h"

#include "robot/model/joint_limits.h"
#include "robot/model/shortest_motion.h"

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace spherule {
namespace {

constexpr double kWholeTurn = 2.0 * std::numbers::pi;
// Limits are given in few digits, too, and degrees that are rounded may be beyond them.
constexpr double kLimitRounding = 1e-2;

// Whose position a number of a configuration is.
const Joint& leader_of(const RobotModel& robot, std::size_t variable) {
  return robot.joints()[static_cast<std::size_t>(robot.variable_joints()[variable])];
}

// Continuous joints make a few turns at most.
bool is_plausible(const Joint& joint, double angle, double turns) {
  if (!has_limits(joint)) return std::abs(angle) <= turns * kWholeTurn;
  return joint.lower - kLimitRounding <= angle && angle <= joint.upper + kLimitRounding;
}

// Motions of which a continuous joint's `counts(step, shorter)`.
template <class Counts>
TurningMotions turning_motions(const RobotModel& robot, const Trajectory& trajectory,
                               Counts counts) {
  TurningMotions found;
  for (std::size_t i = 0; i + 1 < trajectory.size(); ++i) {
    const std::span<const double> from = trajectory.configuration(i);
    const std::span<const double> to = trajectory.configuration(i + 1);
    for (std::size_t k = 0; k < trajectory.width; ++k) {
      const Joint& joint = leader_of(robot, k);
      if (joint.type != JointType::kContinuous) continue;
      const double step = to[k] - from[k];
      const double shorter = nearest_turn(from[k], to[k]) - from[k];
      if (!counts(step, shorter)) continue;
      if (++found.count == 1) {
        found.line = trajectory.lines[i];
        found.to_line = trajectory.lines[i + 1];
        found.joint = joint.name;
        found.step = step;
        found.shorter = shorter;
      }
      break;
    }
  }
  return found;
}

}  // namespace

OutsideLimits outside_limits(const RobotModel& robot, const Trajectory& trajectory) {
  OutsideLimits found;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const std::span<const double> configuration = trajectory.configuration(i);
    const Joint* const joint = joint_outside_limits(robot, configuration);
    if (joint == nullptr || ++found.count > 1) continue;
    found.line = trajectory.lines[i];
    found.joint = joint->name;
    found.turns = joint->turns();
    found.position = joint->position(configuration);
    found.lower = joint->lower;
    found.upper = joint->upper;
  }
  return found;
}

DegreesGuess guess_degrees(const RobotModel& robot, const Trajectory& trajectory) {
  DegreesGuess guess;
  bool is_large = false;
  bool fits = true;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const std::span<const double> configuration = trajectory.configuration(i);
    for (std::size_t k = 0; k < trajectory.width; ++k) {
      const Joint& joint = leader_of(robot, k);
      const double value = configuration[k];
      if (!joint.turns() || value == 0.0) continue;
      ++guess.angles;
      is_large = is_large || std::abs(value) > kWholeTurn;
      fits = fits && is_plausible(joint, value * kRadiansPerDegree, 2.0);
      if (is_plausible(joint, value, 1.0) || ++guess.beyond > 1) continue;
      guess.line = trajectory.lines[i];
      guess.joint = joint.name;
      guess.value = value;
    }
  }
  guess.looks_so = is_large && fits && guess.beyond > 0 && 4 * guess.beyond >= guess.angles;
  return guess;
}

TurningMotions more_than_half_a_turn(const RobotModel& robot, const Trajectory& trajectory) {
  return turning_motions(robot, trajectory,
                         [](double step, double shorter) { return step != shorter; });
}

TurningMotions half_a_turn(const RobotModel& robot, const Trajectory& trajectory) {
  constexpr double kNear = 1e-4;
  return turning_motions(robot, trajectory, [](double, double shorter) {
    return std::abs(shorter) >= std::numbers::pi - kNear;
  });
}

}  // namespace spherule
