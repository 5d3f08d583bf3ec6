// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/robot_model.h"

#include <cstddef>
#include <cstdint>
#include <ompl/base/State.h>
#include <ompl/base/StateSpace.h>
#include <span>

namespace spherule {

// The robot's joints between their limits, in radians, for OMPL. `seed` alone decides what its
// samplers draw. Motions that are sampled are so at most `step` apart, in the measure of the space
// (the length of the vector of joint positions).
ompl::base::StateSpacePtr make_joint_space(const RobotModel& robot, std::uint32_t seed,
                                           double step);

// Of a state of such a space of so many joints.
std::span<const double> positions_of(const ompl::base::State* state, std::size_t joints);

}  // namespace spherule
