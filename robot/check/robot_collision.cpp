// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/robot_collision.h"

#include "base/error.h"
#include "robot/check/body_pairs.h"
#include "robot/check/robot_scene.h"
#include "robot/cover/alarm_sample.h"
#include "robot/model/joint_positions.h"
#include "robot/model/kinematics.h"
#include "robot/pairs/link_pieces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <random>
#include <utility>

namespace spherule {

std::vector<PairStatus> pair_statuses(const RobotModel& robot, const AllowedCollisions& allowed,
                                      std::shared_ptr<const LinkPairs> proofs) {
  RobotScene scene(robot);
  scene.set_allowed_collisions(allowed);
  scene.set_link_pairs(proofs);
  std::vector<PairStatus> result;
  const std::vector<Link>& links = robot.links();
  for (std::size_t first = 0; first < links.size(); ++first) {
    for (std::size_t second = first + 1; second < links.size(); ++second) {
      if (links[first].trees.empty() || links[second].trees.empty()) continue;
      PairStatus& status = result.emplace_back();
      status.first = static_cast<int>(first);
      status.second = static_cast<int>(second);
      status.reason = scene.reason(links[first].name, links[second].name);
      const LinkPair* const pair =
          proofs == nullptr ? nullptr : proofs->find(status.first, status.second);
      if (pair == nullptr) continue;
      status.verdict = pair->verdict;
      status.free_share = pair->boxes.free_share();
    }
  }
  return result;
}

std::string_view kind_of(const PairStatus& status) {
  if (status.reason != AllowedReason::kTested || !status.verdict) return name_of(status.reason);
  return *status.verdict == PairVerdict::kTouching ? "can touch" : name_of(*status.verdict);
}

SampledCollisions sample_collisions(const RobotModel& robot, const AllowedCollisions& allowed,
                                    const SampleCollisionsOptions& options) {
  if (options.configurations == 0) throw Error("sample", "it has no configurations");
  require_limits(robot);
  std::vector<internal::CheckedPiece> pieces;
  std::vector<std::vector<int>> pieces_of(robot.links().size());
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    for (const auto& tree : robot.links()[link].trees) {
      pieces_of[link].push_back(static_cast<int>(pieces.size()));
      pieces.push_back({.tree = tree, .link = static_cast<int>(link)});
    }
  }
  SampledCollisions result{options.configurations, {}};
  std::vector<internal::CheckedPair> pairs;
  std::vector<std::size_t> end_of;  // of each pair of links, among those of pieces
  for (std::size_t first = 0; first < pieces_of.size(); ++first) {
    for (std::size_t second = first + 1; second < pieces_of.size(); ++second) {
      const SampledPair pair{static_cast<int>(first), static_cast<int>(second)};
      if (allowed.allows(pair.first, pair.second)) continue;
      if (pieces_of[first].empty() || pieces_of[second].empty()) continue;
      for (const int a : pieces_of[first]) {
        for (const int b : pieces_of[second]) pairs.push_back({a, b, false});
      }
      result.pairs.push_back(pair);
      end_of.push_back(pairs.size());
    }
  }
  const std::size_t tested = pairs.size();
  const internal::BodyPairs checked(robot, Pose(), std::move(pieces), {}, std::move(pairs), tested);
  internal::BodyPairs::Scratch scratch;
  std::mt19937_64 bits(options.seed);
  std::vector<double> configuration(static_cast<std::size_t>(robot.variable_count()));
  for (std::size_t n = 0; n < options.configurations; ++n) {
    internal::draw_configuration(robot, bits, configuration);
    checked.place(configuration, scratch);
    std::size_t i = 0;
    for (std::size_t pair = 0; pair < result.pairs.size(); ++pair) {
      bool touched = false;
      for (; i < end_of[pair]; ++i) touched = touched || checked.touches(i, scratch);
      result.pairs[pair].touched += touched ? 1 : 0;
    }
  }
  for (SampledPair& pair : result.pairs) {
    if (pair.touched == 0) pair.reason = AllowedReason::kNever;
    if (pair.touched == options.configurations) pair.reason = AllowedReason::kAlways;
  }
  return result;
}

void allow_sampled(const SampledCollisions& sampled, AllowedCollisions& allowed) {
  for (const SampledPair& pair : sampled.pairs) {
    if (pair.reason != AllowedReason::kTested) allowed.allow(pair.first, pair.second, pair.reason);
  }
}

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
    if (!std::isfinite(joint.upper)) return 0.0;
    const double margin = kMargin * (joint.upper - joint.lower);
    const bool is_within = joint.lower + margin < 0.0 && 0.0 < joint.upper - margin;
    return is_within ? 0.0 : 0.5 * (joint.lower + joint.upper);
  });
}

std::vector<VariablePosition> positions_of(const GroupState& state, const RobotModel& robot) {
  std::vector<VariablePosition> result;
  for (const JointState& joint : state.joints) {
    const auto& variables = robot.variable_joints();
    const auto found = std::find(variables.begin(), variables.end(), robot.find_joint(joint.joint));
    if (found == variables.end() || joint.position.size() != 1) continue;
    result.push_back({static_cast<std::size_t>(found - variables.begin()), joint.position.front()});
  }
  return result;
}

std::vector<NamedPosture> group_postures(const RobotModel& robot,
                                         const SemanticDescription& semantics) {
  std::vector<NamedPosture> result;
  for (const GroupState& state : semantics.group_states) {
    NamedPosture posture{state.group + "/" + state.name, zero_posture(robot).configuration};
    for (const auto& [variable, position] : positions_of(state, robot)) {
      posture.configuration[variable] = position;
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
