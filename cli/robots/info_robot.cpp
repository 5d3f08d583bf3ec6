// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/info_robot.h"

#include "cli/files/warnings.h"
#include "cli/text/print.h"
#include "robot/files/srdf.h"
#include "robot/files/urdf.h"
#include "robot/formats/sphere_formats.h"

#include <algorithm>
#include <sstream>

namespace spherule {
namespace {

std::size_t count_joints(const RobotModel& robot, JointType type) {
  const auto joints = robot.joints();
  return static_cast<std::size_t>(std::count_if(
      joints.begin(), joints.end(), [&](const Joint& joint) { return joint.type == type; }));
}

std::string describe_joint(const Joint& joint) {
  std::ostringstream text;
  text << "  " << one_line(joint.name);
  if (joint.type == JointType::kContinuous) {
    text << ": continuous";
  } else {
    text << ": " << joint.lower << " to " << joint.upper << (joint.turns() ? " rad" : " m");
  }
  text << "\n";
  return text.str();
}

std::size_t count_spheres(const std::vector<LinkSpheres>& links) {
  std::size_t count = 0;
  for (const LinkSpheres& link : links) count += link.spheres.size();
  return count;
}

}  // namespace

std::string describe_urdf(const std::string& file) {
  const RobotDescription robot = read_urdf(
      file, {.packages = {}, .require_visual_meshes = false, .require_collision_meshes = false});
  std::size_t visual = 0;
  std::size_t collision = 0;
  for (const LinkDescription& link : robot.links) {
    visual += link.visual.empty() ? 0 : 1;
    collision += link.collision.empty() ? 0 : 1;
  }
  std::ostringstream text;
  text << "robot: " << one_line(robot.name) << "\n"
       << "links: " << robot.links.size() << ", " << collision << " with collision geometry, "
       << visual << " with visual geometry\n"
       << "joints: " << robot.model.joints().size() << ", "
       << count_joints(robot.model, JointType::kFixed)
       << " fixed; numbers of a configuration: " << robot.model.variable_count() << "\n";
  for (const Joint& joint : robot.model.joints()) {
    if (joint.moves() && joint.mimics < 0) text << describe_joint(joint);
  }
  return text.str();
}

std::string describe_srdf(const std::string& file) {
  const SemanticDescription semantics = read_srdf(file);
  std::ostringstream text;
  text << "SRDF of robot: " << one_line(semantics.robot_name) << "\n"
       << "groups: " << semantics.groups.size()
       << ", named states: " << semantics.group_states.size()
       << ", end effectors: " << semantics.end_effectors.size() << "\n"
       << "disabled pairs of links: " << semantics.disabled_pairs.size() << "\n"
       << "spheres: " << count_spheres(semantics.sphere_approximations) << "\n";
  return text.str();
}

std::string describe_robot_spheres(const std::string& file) {
  const SphereFormatFile read = read_robot_spheres(file);
  const RobotSpheres& spheres = read.spheres;
  std::ostringstream text;
  text << "spheres of a robot (" << name_of(read.format) << ")"
       << (spheres.robot.empty() ? "" : ": " + one_line(spheres.robot)) << "\n"
       << "spheres: " << count_spheres(spheres.links) << " on " << spheres.links.size()
       << " links\n";
  if (spheres.interrupted) text << kInterruptedSearch << "\n";
  for (const LinkSpheres& link : spheres.links) {
    text << "  " << one_line(link.link) << ": " << link.spheres.size() << "\n";
  }
  if (spheres.switched_off > 0) text << "switched off: " << spheres.switched_off << "\n";
  if (!spheres.self_collision_ignore.empty()) {
    text << "pairs of links left out: " << spheres.self_collision_ignore.size() << "\n";
  }
  return text.str();
}

}  // namespace spherule
