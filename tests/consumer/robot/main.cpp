// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <spherule/robot/files/urdf.h>
#include <spherule/robot/model/kinematics.h>

// Reads an arm and turns it by a quarter: it then points along y.
int main() {
  const spherule::RobotDescription robot = spherule::read_urdf(URDF);
  std::vector<spherule::Pose> world_from_link;
  spherule::forward_kinematics(robot.model, std::vector<double>{1.5707963267948966},
                               world_from_link);
  const Eigen::Vector3d hand = world_from_link[1] * Eigen::Vector3d(1.0, 0.0, 0.0);
  std::cout << robot.name << " reaches " << hand.transpose() << "\n";
  return (hand - Eigen::Vector3d(0.0, 1.0, 0.0)).norm() < 1e-12 ? 0 : 1;
}
