// SPDX-License-Identifier: BSD-3-Clause
// A robot among obstacles: its spheres, the scene, and what is proved of a motion
// (docs/cpp_robot.md).
#include <iostream>
#include <memory>
#include <spherule/robot.h>
#include <vector>

using namespace spherule;

int main() {
  const RobotDescription robot = read_urdf(URDF);
  const RobotCover cover = cover_robot(robot, {.max_error = 0.05, .effort = 0});  // metres
  if (!links_not_proved(cover).empty()) return 2;

  RobotScene scene(with_spheres(robot.model, robot_spheres(robot, cover).links));
  scene.add("table", Primitive(Box{{2.0, 2.0, 0.1}}), Pose::from_translation({0.0, 0.0, -0.3}));
  scene.add("post", Primitive(Cylinder{0.05, 2.0}), Pose::from_translation({0.0, 0.8, 0.0}));
  const std::vector<Sphere> gripper = {{{0.1, 0.0, 0.0}, 0.08}};
  scene.attach("gripper", "upper_arm", std::make_shared<const SphereTree>(build_tree(gripper)),
               Pose::from_translation({1.0, 0.0, 0.0}));

  const RobotChecker checker = scene.snapshot();
  RobotChecker::Scratch scratch(checker);  // one for each thread
  const std::vector<double> from = {0.0}, to = {1.8};
  const EdgeResult motion = checker.check_edge(from, to, scratch, {.first = true});
  std::cout << "proved free until " << motion.free_until << " of the way\n";
  if (motion.verdict != Verdict::kCollision) return 1;
  const auto touching = checker.configuration_on_edge(from, to, motion.contact_at);
  for (const CheckedContact& contact : checker.explain(touching, scratch)) {
    std::cout << contact.first.name << " touches " << contact.second.name << ", "
              << contact.overlap_depth << " m deep\n";
  }
  return checker.check_config(from, scratch) ? 0 : 1;
}
