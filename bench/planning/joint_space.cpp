// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/joint_space.h"

#include <cstddef>
#include <memory>
#include <ompl/base/spaces/RealVectorStateSpace.h>

namespace spherule {
namespace {

namespace ob = ompl::base;

class SeededSampler : public ob::RealVectorStateSampler {
 public:
  SeededSampler(const ob::StateSpace* space, std::uint32_t seed)
      : ob::RealVectorStateSampler(space) {
    rng_.setLocalSeed(seed);
  }
};

}  // namespace

ob::StateSpacePtr make_joint_space(const RobotModel& robot, std::uint32_t seed, double step) {
  const auto joints = static_cast<unsigned>(robot.variable_count());
  const auto space = std::make_shared<ob::RealVectorStateSpace>(joints);
  ob::RealVectorBounds bounds(joints);
  for (std::size_t i = 0; i < joints; ++i) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(robot.variable_joints()[i])];
    bounds.low[i] = joint.lower;
    bounds.high[i] = joint.upper;
  }
  space->setBounds(bounds);
  space->setLongestValidSegmentFraction(step / space->getMaximumExtent());
  space->setStateSamplerAllocator([seed](const ob::StateSpace* sampled) {
    return std::make_shared<SeededSampler>(sampled, seed);
  });
  return space;
}

std::span<const double> positions_of(const ob::State* state, std::size_t joints) {
  return {state->as<ob::RealVectorStateSpace::StateType>()->values, joints};
}

}  // namespace spherule
