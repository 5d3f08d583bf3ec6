// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Where a robot's links are in a configuration.
//
// @code{.cpp}
// #include <spherule/robot/model/kinematics.h>
// #include <cassert>
// #include <numbers>
//
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// std::vector<spherule::Pose> world_from_link;
// spherule::forward_kinematics(robot, std::vector{std::numbers::pi}, world_from_link);
// const Eigen::Vector3d tip = world_from_link[1] * Eigen::Vector3d(1, 0, 0);
// assert((tip - Eigen::Vector3d(-1, 0, 0)).norm() < 1e-14);
// assert(spherule::kinematics_error_bound(robot, 1.0) < 1e-12);
// @endcode

#include "robot/model/robot_model.h"

#include <span>
#include <vector>

namespace spherule {

// The largest magnitude of a joint's position, in radians or metres, for which bounds of errors are
// proved.
inline constexpr double kLargestJointPosition = 100.0;

// Poses world_from_link of all links, in the order of RobotModel::links(), for a configuration of
// variable_count() positions (radians or metres; limits are not enforced) and a placed root.
// `world_from_link` is resized and reused, so that a warm call does not allocate.
// `world_from_root` must not be an element of it.
// Throws Error for a configuration of the wrong size or with a number that is not finite, and for
// one that moves a link beyond kMaxCoordinate from the world's origin.
void forward_kinematics(const RobotModel& robot, std::span<const double> configuration,
                        std::vector<Pose>& world_from_link, const Pose& world_from_root = {});

// Bound on the distance between a point at distance at most `reach` from a link's frame mapped by
// the computed pose and by the exact mechanism (the joints exactly as the model stores them), in
// metres, for any configuration with joint positions of at most kLargestJointPosition in
// magnitude and a root at distance at most `root_distance` from the world's origin. The error
// budget stands in kinematics.cpp.
double kinematics_error_bound(const RobotModel& robot, double reach, double root_distance = 0.0);

}  // namespace spherule
