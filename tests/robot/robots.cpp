// SPDX-License-Identifier: BSD-3-Clause
#include "tests/robot/robots.h"

#include "base/error.h"
#include "tests/support/random_scene.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace spherule::test {

Joint sliding(double lower, double upper, std::string name, const Eigen::Vector3d& axis) {
  return {.name = std::move(name),
          .type = JointType::kPrismatic,
          .axis = axis,
          .lower = lower,
          .upper = upper};
}

Joint turning(double lower, double upper, std::string name) {
  return {.name = std::move(name), .type = JointType::kRevolute, .lower = lower, .upper = upper};
}

Joint wheel(std::string name, const Eigen::Vector3d& axis) {
  return {.name = std::move(name), .type = JointType::kContinuous, .axis = axis};
}

RobotModel one_arm(const Joint& joint, const Eigen::Vector3d& center, double radius) {
  RobotModel robot("base");
  robot.add_link("arm", "base", joint);
  robot.attach("arm", one_sphere_tree(center, radius));
  return robot;
}

RobotModel random_robot(Random& random, int joints, bool branching) {
  RobotModel robot("link_0");
  for (int i = 0; i < joints; ++i) {
    const int parent = branching ? random.whole(0, i) : i;
    Joint joint;
    joint.name = "joint_" + std::to_string(i);
    joint.type = static_cast<JointType>(random.whole(0, 2));
    joint.parent_from_joint = random.pose(1.0);
    joint.axis = random.point(3.0);
    joint.lower = -100.0;
    joint.upper = 100.0;
    robot.add_link("link_" + std::to_string(i + 1), "link_" + std::to_string(parent), joint);
  }
  return robot;
}

void add_random_mimics(Random& random, RobotModel& robot, double offset) {
  for (const Joint& joint : std::vector<Joint>(robot.joints())) {
    if (!joint.moves() || random.whole(0, 1) == 0) continue;
    const int last = static_cast<int>(robot.joints().size()) - 1;
    const auto other = static_cast<std::size_t>(random.whole(0, last));
    try {
      robot.mimic(joint.name, robot.joints()[other].name, random.between(-1.0, 1.0),
                  random.between(-offset, offset));
    } catch (const Error&) {
      // It is fixed, or follows this one.
    }
  }
}

std::vector<double> random_configuration(Random& random, const RobotModel& robot, double largest) {
  std::vector<double> configuration;
  for (int i = 0; i < robot.variable_count(); ++i) {
    configuration.push_back(random.between(-largest, largest));
  }
  return configuration;
}

std::vector<double> random_in_ranges(Random& random, const RobotModel& robot) {
  std::vector<double> result;
  for (const int j : robot.variable_joints()) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(j)];
    const double part =
        random.whole(0, 1) == 0 ? random.between(0.0, 1.0) : std::ldexp(random.whole(0, 16), -4);
    double value = joint.lower + (joint.upper - joint.lower) * part;
    if (joint.type == JointType::kContinuous) value += 2.0 * std::numbers::pi * random.whole(-2, 2);
    result.push_back(value);
  }
  return result;
}

}  // namespace spherule::test
