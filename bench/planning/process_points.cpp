// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/process_points.h"

#include "base/error.h"
#include "bench/scenes/inverse_kinematics.h"
#include "bench/scenes/program.h"
#include "bench/scenes/spherical_wrist.h"
#include "bench/scenes/weld_pass.h"
#include "robot/model/kinematics.h"
#include "tests/support/turn_between.h"

#include <Eigen/Geometry>

#include <numbers>

namespace spherule {
namespace {

using Eigen::Vector3d;

constexpr double kMostError = 1e-5;  // metres, and an entry of the rotation matrix
constexpr std::size_t kSeams = 3;

// The wire's end at a point of a seam, the wire between the seam's normal and the vertical, as in
// the weld program.
Pose world_from_wire(const SeamPoint& seam, double angle) {
  const Vector3d normal = (seam.normal_a + seam.normal_b).normalized();
  const Vector3d away = (normal + 2.0 * Vector3d::UnitZ()).normalized();
  const Eigen::Quaterniond turn = turn_between(Vector3d::UnitZ(), -away) *
                                  Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
  return world_from_workpiece() * Pose(turn, seam.point + standoff(seam) * normal);
}

void require_reached(const RobotModel& robot, const ArmPositions& positions,
                     const Pose& flange_from_wire, const Pose& target,
                     std::vector<Pose>& world_from_link) {
  forward_kinematics(robot, positions, world_from_link);
  const Pose wire = world_from_link.back() * link6_from_flange() * flange_from_wire;
  if ((wire.translation() - target.translation()).norm() > kMostError ||
      (wire.matrix() - target.matrix()).cwiseAbs().maxCoeff() > kMostError) {
    throw Error("process points", "a posture does not reach its place");
  }
}

}  // namespace

ProcessPoints make_process_points(const RobotModel& robot, const Pose& flange_from_wire,
                                  std::size_t points, std::size_t angles) {
  ProcessPoints result{.points = points, .angles = angles};
  const Pose wire_from_flange = flange_from_wire.inverse();
  std::vector<Pose> world_from_link;
  for (std::size_t i = 0; i < points; ++i) {
    const std::size_t pipe = i * kSeams / points;
    const double along = static_cast<double>(i * kSeams % points) / static_cast<double>(points);
    const SeamPoint seam =
        seam_point(static_cast<int>(pipe),
                   kLowestSeamAngle + (0.5 * std::numbers::pi - kLowestSeamAngle) * along);
    for (std::size_t k = 0; k < angles; ++k) {
      const Pose target = world_from_wire(
          seam, 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(angles));
      for (const ArmPositions& exact :
           inverse_kinematics_branches(robot, target * wire_from_flange)) {
        ++result.postures;
        const ArmPositions positions = on_joint_grid(exact);
        if (!is_within_limits(robot, positions)) continue;
        require_reached(robot, positions, flange_from_wire, target, world_from_link);
        result.configurations.push_back(positions);
        result.point_of.push_back(i);
      }
    }
  }
  return result;
}

}  // namespace spherule
