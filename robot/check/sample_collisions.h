// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Which links of a robot touch in sampled configurations?
//
// @code{.cpp}
// #include <spherule/robot/check/sample_collisions.h>
// #include <spherule/spheretree/build.h>
// #include <cassert>
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

#include "robot/model/robot_model.h"
#include "robot/pairs/allowed_collisions.h"

#include <cstddef>
#include <cstdint>
#include <vector>

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
