// SPDX-License-Identifier: BSD-3-Clause
#include "tests/robot/robots.h"

#include "base/error.h"

#include <string>

namespace spherule::test {

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

}  // namespace spherule::test
