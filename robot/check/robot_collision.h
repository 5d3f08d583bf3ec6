// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Collisions of a robot without a scene: whether a placed robot overlaps a single obstacle, why
// pairs of its links are tested against each other or not, and which of them touch in sampled
// configurations. For more, see RobotScene.
//
// @code{.cpp}
// #include <spherule/robot/check/robot_collision.h>
// #include <spherule/robot/model/kinematics.h>
// #include <spherule/spheretree/build.h>
// #include <cassert>
//
// const std::vector<spherule::Sphere> spheres{{{1, 0, 0}, 0.1}};
// const auto sphere = std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// spherule::RobotModel robot("base");
// robot.attach("base", sphere);
// std::vector<spherule::Pose> world_from_link;
// spherule::forward_kinematics(robot, {}, world_from_link);
// assert(robot_collides(robot, world_from_link, *sphere, {}));
// @endcode

#include "collide/collide.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/link_pairs.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace spherule {

// Whether a tree on any link overlaps a placed obstacle: collides() for each of them, the last link
// first, because the tool at the end of the chain is what usually touches. `world_from_link` as
// forward_kinematics() gives it, one pose for each link; the number is not checked. Links are not
// tested against each other.
bool robot_collides(const RobotModel& robot, std::span<const Pose> world_from_link,
                    const SphereTree& obstacle, const Pose& world_from_obstacle) noexcept;

}  // namespace spherule

// Pairs of links.
//
// @code{.cpp}
// #include <iostream>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 0.1}};
// const auto sphere = std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// for (const char* const link : {"base", "arm"}) robot.attach(link, sphere);
// const spherule::AllowedCollisions allowed(robot);
// const auto statuses = spherule::pair_statuses(robot, allowed, nullptr);
// assert(statuses.size() == 1 && statuses[0].reason == spherule::AllowedReason::kAdjacent);
// std::cout << kind_of(statuses[0]) << "\n";
// @endcode

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

}  // namespace spherule

// Sampled configurations.
//
// @code{.cpp}
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 0.1}};
// const auto sphere = std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// spherule::RobotModel robot("base");
// robot.add_link("plate", "base", {});
// robot.add_link("arm", "base", {.name = "lift", .type = spherule::JointType::kPrismatic,
//                                .lower = 1.0, .upper = 2.0});
// robot.attach("plate", sphere);
// robot.attach("arm", sphere);
// spherule::AllowedCollisions allowed(robot);
// allowed.forbid("plate", "arm");
// const spherule::SampledCollisions sampled =
//     spherule::sample_collisions(robot, allowed, {.configurations = 100});
// assert(sampled.pairs.size() == 1 && sampled.pairs[0].touched == 0);
// spherule::allow_sampled(sampled, allowed);
// assert(allowed.reason(1, 2) == spherule::AllowedReason::kNever);
// @endcode

namespace spherule {

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

}  // namespace spherule
