// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenes/robot.h"

#include <string>

namespace spherule {
namespace {

using Eigen::Vector3d;

struct JointRow {
  Vector3d origin;  // in the parent link's frame
  Vector3d axis;
  double lower;
  double upper;
};

// The figures of ABB's robot, as the ROS-Industrial description of it states them.
const JointRow kRows[kJoints] = {
    {{0.0, 0.0, 0.0}, Vector3d::UnitZ(), -2.87979, 2.87979},
    {{0.2, 0.0, 0.68}, Vector3d::UnitY(), -1.2217, 1.658},
    {{0.0, 0.0, 0.89}, Vector3d::UnitY(), -1.0472, 1.1345},
    {{1.38, 0.0, 0.15}, Vector3d::UnitX(), -3.49, 3.49},
    {{0.0, 0.0, 0.0}, Vector3d::UnitY(), -2.0944, 2.0944},
    {{0.0, 0.0, 0.0}, Vector3d::UnitX(), -6.9813, 6.9813},
};

}  // namespace

RobotModel make_robot() {
  RobotModel robot("base_link");
  std::string parent = "base_link";
  for (int i = 0; i < kJoints; ++i) {
    const JointRow& row = kRows[i];
    const std::string number = std::to_string(i + 1);
    const std::string link = "link_" + number;
    robot.add_link(link, parent,
                   {.name = "joint_" + number,
                    .type = JointType::kRevolute,
                    .parent_from_joint = Pose::from_translation(row.origin),
                    .axis = row.axis,
                    .lower = row.lower,
                    .upper = row.upper});
    parent = link;
  }
  return robot;
}

Pose link6_from_flange() {
  return Pose::from_translation({0.14, 0.0, 0.0});
}

}  // namespace spherule
