// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/scenes/program.h"
#include "robot/model/kinematics.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace spherule {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Of sine and cosine, by which rounding may miss that the wrist or the arm is stretched: as far off
// is the place that is reached.
constexpr double kStretched = 1e-12;
constexpr double kAtReach = 1e-12;

// What turns the arm's plane (x forwards, z up) by axes 2 and 3 at position zero.
struct ArmShape {
  Vector2d shoulder;   // from the root to axis 2
  Vector2d upper_arm;  // to axis 3
  Vector2d forearm;    // to the wrist's centre
};

bool is_joint(const Joint& joint, const Vector3d& axis) {
  return joint.type == JointType::kRevolute && joint.axis == axis && joint.mimics < 0 &&
         joint.parent_from_joint.matrix() == Matrix3d::Identity() &&
         joint.parent_from_joint.translation().y() == 0.0;
}

ArmShape shape_of(const RobotModel& robot) {
  const std::array<Vector3d, kJoints> axes = {Vector3d::UnitZ(), Vector3d::UnitY(),
                                              Vector3d::UnitY(), Vector3d::UnitX(),
                                              Vector3d::UnitY(), Vector3d::UnitX()};
  const auto origin = [&](std::size_t i) {
    return robot.joints()[i].parent_from_joint.translation();
  };
  bool fits = robot.joints().size() == kJoints;
  for (std::size_t i = 0; fits && i < kJoints; ++i) fits = is_joint(robot.joints()[i], axes[i]);
  fits = fits && origin(0).x() == 0.0 && origin(4).isZero(0.0) && origin(5).isZero(0.0);
  if (!fits) throw Error("robot", "is not an arm with axes z y y x y x and a spherical wrist");
  const auto in_plane = [](const Vector3d& v) { return Vector2d(v.x(), v.z()); };
  return {in_plane(origin(0) + origin(1)), in_plane(origin(2)), in_plane(origin(3))};
}

// From z towards x, as a turn about y goes.
double angle_of(const Vector2d& v) {
  return std::atan2(v.x(), v.y());
}

Vector2d turned(const Vector2d& v, double angle) {
  return {std::cos(angle) * v.x() + std::sin(angle) * v.y(),
          -std::sin(angle) * v.x() + std::cos(angle) * v.y()};
}

double within_a_turn(double angle) {
  return std::remainder(angle, 2.0 * std::numbers::pi);
}

// Adds the postures of the wrist: `forearm_from_flange` is a turn about x, y and x again.
void add_wrists(ArmPositions positions, const Matrix3d& forearm_from_flange,
                std::vector<ArmPositions>& postures) {
  const Matrix3d& r = forearm_from_flange;
  const double sine = std::hypot(r(1, 0), r(2, 0));
  if (sine < kStretched) {
    positions[4] = r(0, 0) > 0.0 ? 0.0 : std::numbers::pi;
    positions[3] = 0.0;
    positions[5] = std::atan2(-r(1, 2), r(1, 1));
    postures.push_back(positions);
    return;
  }
  for (const double side : {1.0, -1.0}) {
    positions[3] = std::atan2(side * r(1, 0), -side * r(2, 0));
    positions[4] = side * std::atan2(sine, r(0, 0));
    positions[5] = std::atan2(side * r(0, 1), side * r(0, 2));
    postures.push_back(positions);
  }
}

}  // namespace

std::vector<ArmPositions> inverse_kinematics_branches(const RobotModel& robot,
                                                      const Pose& world_from_flange) {
  const ArmShape arm = shape_of(robot);
  const Pose world_from_wrist = world_from_flange * link6_from_flange().inverse();
  const Vector3d wrist = world_from_wrist.translation();
  const double upper = arm.upper_arm.norm();
  const double fore = arm.forearm.norm();
  std::vector<ArmPositions> postures;
  for (const double side : {1.0, -1.0}) {
    ArmPositions positions{};
    positions[0] = std::atan2(side * wrist.y(), side * wrist.x());
    const Vector2d reach =
        Vector2d(side * std::hypot(wrist.x(), wrist.y()), wrist.z()) - arm.shoulder;
    const double cosine =
        (reach.squaredNorm() - upper * upper - fore * fore) / (2.0 * upper * fore);
    if (!(std::abs(cosine) <= 1.0 + kAtReach)) continue;
    const double bent = std::acos(std::clamp(cosine, -1.0, 1.0));
    const double straight = angle_of(arm.upper_arm) - angle_of(arm.forearm);
    for (const double bend : {1.0, -1.0}) {
      const double elbow = straight + bend * bent;
      const double shoulder =
          angle_of(reach) - angle_of(arm.upper_arm + turned(arm.forearm, elbow));
      positions[1] = within_a_turn(shoulder);
      positions[2] = within_a_turn(elbow);
      const Matrix3d world_from_forearm =
          (Eigen::AngleAxisd(positions[0], Vector3d::UnitZ()) *
           Eigen::AngleAxisd(positions[1] + positions[2], Vector3d::UnitY()))
              .toRotationMatrix();
      add_wrists(positions, world_from_forearm.transpose() * world_from_wrist.matrix(), postures);
    }
  }
  return postures;
}

bool is_within_limits(const RobotModel& robot, const ArmPositions& positions) {
  for (std::size_t i = 0; i < kJoints; ++i) {
    const Joint& joint = robot.joints()[i];
    if (!(positions[i] >= joint.lower && positions[i] <= joint.upper)) return false;
  }
  return true;
}

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
