// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Why pairs of links are tested against each other, or not.
//
// @code{.cpp}
// #include <spherule/robot/check/pair_status.h>
// #include <spherule/spheretree/build.h>
// #include <cassert>
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

#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/link_pairs.h"

#include <memory>
#include <optional>
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

}  // namespace spherule
