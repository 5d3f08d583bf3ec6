// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/named_postures.h"

#include "robot/check/robot_scene.h"
#include "robot/model/kinematics.h"
#include "robot/pairs/internal/link_pieces.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace spherule {
namespace {

// Of a joint's range: closer to a limit it is not at rest.
constexpr double kMargin = 0.1;

std::vector<LinkBody> bodies_of(std::span<const LinkBody> bodies, int link) {
  std::vector<LinkBody> result;
  std::copy_if(bodies.begin(), bodies.end(), std::back_inserter(result),
               [&](const LinkBody& body) { return body.link == link; });
  return result;
}

// Each variable where `position` puts its joint.
template <class Position>
NamedPosture posture(const char* name, const RobotModel& robot, Position position) {
  NamedPosture result{name};
  for (const int joint : robot.variable_joints()) {
    result.configuration.push_back(position(robot.joints()[static_cast<std::size_t>(joint)]));
  }
  return result;
}

}  // namespace

NamedPosture zero_posture(const RobotModel& robot) {
  return posture("the zero posture", robot,
                 [](const Joint& joint) { return std::clamp(0.0, joint.lower, joint.upper); });
}

NamedPosture rest_posture(const RobotModel& robot) {
  return posture("the rest posture", robot, [](const Joint& joint) {
    const double margin = kMargin * (joint.upper - joint.lower);
    const bool is_within = joint.lower + margin < 0.0 && 0.0 < joint.upper - margin;
    return is_within ? 0.0 : 0.5 * (joint.lower + joint.upper);
  });
}

std::vector<NamedPosture> group_postures(const RobotModel& robot,
                                         const SemanticDescription& semantics) {
  std::vector<NamedPosture> result;
  for (const GroupState& state : semantics.group_states) {
    NamedPosture posture{state.group + "/" + state.name, zero_posture(robot).configuration};
    for (const JointState& joint : state.joints) {
      const int index = robot.find_joint(joint.joint);
      const auto& variables = robot.variable_joints();
      const auto found = std::find(variables.begin(), variables.end(), index);
      if (index < 0 || found == variables.end() || joint.position.size() != 1) continue;
      posture.configuration[static_cast<std::size_t>(found - variables.begin())] =
          joint.position.front();
    }
    result.push_back(std::move(posture));
  }
  return result;
}

std::vector<PostureContact> contacts_in(std::span<const NamedPosture> postures,
                                        const RobotModel& robot, std::span<const LinkBody> bodies,
                                        const AllowedCollisions& allowed,
                                        std::shared_ptr<const LinkPairs> proofs) {
  RobotScene scene(robot);
  scene.set_allowed_collisions(allowed);
  scene.set_link_pairs(std::move(proofs));
  const RobotChecker checker = scene.snapshot();
  RobotChecker::Scratch scratch(checker);
  std::vector<PostureContact> result;
  std::vector<Pose> poses;
  for (const NamedPosture& posture : postures) {
    forward_kinematics(robot, posture.configuration, poses);
    for (const CheckedContact& contact :
         checker.explain(posture.configuration, scratch, {.proved_free = true})) {
      const int first = robot.find_link(contact.first.name);
      const int second = robot.find_link(contact.second.name);
      const bool do_meshes_touch =
          !contact.is_proved_free &&
          internal::touches(bodies_of(bodies, first), poses[static_cast<std::size_t>(first)],
                            bodies_of(bodies, second), poses[static_cast<std::size_t>(second)],
                            0.0);
      result.push_back({posture.name, contact.first.name, contact.second.name,
                        contact.overlap_depth, do_meshes_touch, contact.is_proved_free});
    }
  }
  return result;
}

}  // namespace spherule
