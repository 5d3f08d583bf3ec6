// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenes/inverse_kinematics.h"

#include "robot/model/kinematics.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <vector>

namespace spherule {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr int kSteps = 200;
// Metres and radians, before rounding to the grid: far below the grid, so that the result does not
// depend on the way there.
constexpr double kSolved = 1e-12;
constexpr double kAccepted = 5e-6;
constexpr double kDamping = 1e-3;
constexpr double kLongestStep = 0.2;  // radians

// Shift and rotation vector that are lacking from `from` to `to`, in the world's frame.
Vector6d difference(const Pose& from, const Pose& to) {
  Eigen::Quaterniond turn = to.rotation().normalized() * from.rotation().normalized().conjugate();
  if (turn.w() < 0.0) turn.coeffs() *= -1.0;
  const double sine = turn.vec().norm();
  const double scale = sine > 1e-12 ? 2.0 * std::atan2(sine, turn.w()) / sine : 2.0;
  Vector6d result;
  result << to.translation() - from.translation(), scale * turn.vec();
  return result;
}

Matrix6d jacobian(const RobotModel& robot, const std::vector<Pose>& world_from_link,
                  const Eigen::Vector3d& tip) {
  Matrix6d result;
  for (int i = 0; i < kJoints; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const Pose& link = world_from_link[index + 1];
    const Eigen::Vector3d axis = link.matrix() * robot.joints()[index].axis;
    result.col(i) << axis.cross(tip - link.translation()), axis;
  }
  return result;
}

}  // namespace

ArmPositions on_joint_grid(const ArmPositions& positions) {
  ArmPositions result;
  std::transform(positions.begin(), positions.end(), result.begin(),
                 [](double q) { return std::nearbyint(q * 0x1p20) * 0x1p-20; });
  return result;
}

std::optional<ArmPositions> solve_inverse_kinematics(const RobotModel& robot,
                                                     const Pose& world_from_flange,
                                                     const ArmPositions& start) {
  ArmPositions positions = start;
  std::vector<Pose> world_from_link;
  const auto lacking = [&] {
    forward_kinematics(robot, positions, world_from_link);
    return difference(world_from_link.back() * link6_from_flange(), world_from_flange);
  };
  for (int step = 0; step < kSteps; ++step) {
    const Vector6d error = lacking();
    if (error.cwiseAbs().maxCoeff() < kSolved) break;
    const Matrix6d j = jacobian(robot, world_from_link,
                                (world_from_link.back() * link6_from_flange()).translation());
    const Matrix6d damped = j * j.transpose() + kDamping * kDamping * Matrix6d::Identity();
    Vector6d move = j.transpose() * damped.ldlt().solve(error);
    move *= std::min(1.0, kLongestStep / std::max(move.cwiseAbs().maxCoeff(), 1e-30));
    for (int i = 0; i < kJoints; ++i) {
      const auto index = static_cast<std::size_t>(i);
      const Joint& joint = robot.joints()[index];
      positions[index] = std::clamp(positions[index] + move[i], joint.lower, joint.upper);
    }
  }
  positions = on_joint_grid(positions);
  if (lacking().cwiseAbs().maxCoeff() > kAccepted) return std::nullopt;
  return positions;
}

}  // namespace spherule
