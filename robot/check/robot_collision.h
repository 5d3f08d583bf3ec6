// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Self-collision, for reports: why pairs of links are tested against each other or not, which of
// them touch in sampled configurations, and what touches in named ones.

#include "robot/files/robot_description.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/link_pairs.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {

// What is known of two links of a robot, wherever the limits let its joints be.
struct PairStatus {
  int first = 0;  // indices of links, the smaller one first
  int second = 0;
  // Why they are not tested against each other, or not everywhere, as RobotScene::reason().
  AllowedReason reason = AllowedReason::kTested;
  // What is proved, whatever the reason; none of links that no joint moves against each other, and
  // without proofs.
  std::optional<PairVerdict> verdict = std::nullopt;
  double free_share = 0.0;  // proved free, of the volume of the joints' ranges
};

// The status of every two links that carry spheres, in the order of their indices. `proofs` of the
// robot, or null. Throws Error as RobotScene does for what is of another robot.
std::vector<PairStatus> pair_statuses(const RobotModel& robot, const AllowedCollisions& allowed,
                                      std::shared_ptr<const LinkPairs> proofs);

// The status in a word or two, for people: the reason or, of pairs that are tested everywhere,
// "can touch", "unknown" or, without proofs, "tested".
std::string_view kind_of(const PairStatus& status);

// How configurations are sampled.
struct SampleCollisionsOptions {
  std::size_t configurations = 10000;  // drawn evenly between the joint limits
  std::uint64_t seed = 1;
};

// How often two links touched.
struct SampledPair {
  int first = 0;  // the smaller index
  int second = 0;
  std::size_t touched = 0;                        // in so many configurations
  AllowedReason reason = AllowedReason::kTested;  // kNever, kAlways, or neither
};

// What sampling found.
struct SampledCollisions {
  std::size_t configurations = 0;
  std::vector<SampledPair> pairs;  // all that were tested, in order
};

// Counts how often links touch whose pair `allowed` does not hold already: what MoveIt's setup
// assistant does. It is a sample: a pair that never touched in it may touch elsewhere, and what is
// then allowed because of it is no longer proved free. Turning joints without limits are drawn from
// a whole turn. Equal for equal input and seed. Throws Error for no configurations.
SampledCollisions sample_collisions(const RobotModel& robot, const AllowedCollisions& allowed,
                                    const SampleCollisionsOptions& options = {});

// Allows what never touched, and what always did.
void allow_sampled(const SampledCollisions& sampled, AllowedCollisions& allowed);

// A configuration of a robot that has a name.
struct NamedPosture {
  std::string name;
  std::vector<double> configuration{};
};

// Where all variables are zero, or the limit that is nearest to it.
NamedPosture zero_posture(const RobotModel& robot);

// Where each variable is zero, or, if that is beyond its limits or within a tenth of its range of
// one, in the middle between them.
NamedPosture rest_posture(const RobotModel& robot);

// What a state says of a variable.
struct VariablePosition {
  std::size_t variable = 0;
  double position = 0.0;
};
// What is about joints that the robot has not got, that do not move or follow others, or about
// several numbers for one joint, is passed over.
std::vector<VariablePosition> positions_of(const GroupState& state, const RobotModel& robot);

// The states of a semantic description's groups by positions_of(), "GROUP/STATE", the other joints
// as in zero_posture().
std::vector<NamedPosture> group_postures(const RobotModel& robot,
                                         const SemanticDescription& semantics);

// Two links whose spheres touch in a posture.
struct PostureContact {
  std::string posture;
  std::string first;
  std::string second;
  double overlap_depth = 0.0;    // of the deepest two spheres, in metres
  bool do_meshes_touch = false;  // their bodies, insides counted
  bool is_proved_free = false;   // in a free box of the proofs
};

// What touches in postures, of the links that `allowed` does not allow to: by the spheres that the
// robot's links carry. `proofs` of the robot and its bodies, or null. Throws Error as RobotScene
// and forward_kinematics() do.
std::vector<PostureContact> contacts_in(std::span<const NamedPosture> postures,
                                        const RobotModel& robot, std::span<const LinkBody> bodies,
                                        const AllowedCollisions& allowed,
                                        std::shared_ptr<const LinkPairs> proofs);

}  // namespace spherule
