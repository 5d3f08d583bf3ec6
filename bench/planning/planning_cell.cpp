// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/planning_cell.h"

#include "collide/robot/allowed_collisions.h"
#include "collide/robot/robot_scene.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace spherule {

RobotChecker make_robot_checker(const Workload& workload) {
  RobotModel robot = workload.robot;
  const auto link_name = [&](const Body& body) -> const std::string& {
    return workload.robot.links()[static_cast<std::size_t>(body.link)].name;
  };
  for (const Body& body : workload.bodies) robot.attach(link_name(body), body.part.tree);
  AllowedCollisions allowed(robot);
  for (const Link& first : robot.links()) {
    for (const Link& second : robot.links()) {
      if (first.name != second.name) allowed.allow(first.name, second.name);
    }
  }
  RobotScene scene(robot);
  scene.set_allowed_collisions(allowed);
  for (const Obstacle& obstacle : workload.obstacles) {
    scene.add(obstacle.part.name, obstacle.part.tree, obstacle.world_from_part);
    for (const Body& body : workload.bodies) {
      if (!is_tested(body, obstacle)) scene.allow_contact(link_name(body), obstacle.part.name);
    }
  }
  return scene.snapshot();
}

bool collides(Checker& checker, const ArmPositions& positions) {
  std::uint8_t verdict = 0;
  checker.check({&positions, 1}, {&verdict, 1});
  return verdict != 0;
}

}  // namespace spherule
