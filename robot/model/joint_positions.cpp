// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/joint_positions.h"

namespace spherule {

JointPositions::JointPositions(const RobotModel& robot) : has_mimics_(robot.has_mimics()) {
  for (const Joint& joint : robot.joints()) {
    if (joint.moves()) moving_.push_back(joint);
  }
}

JointPositions::Scratch JointPositions::scratch_for(std::size_t configurations) const {
  if (!has_mimics_) return {};
  return {std::vector<double>(configurations * moving_.size())};
}

std::span<const double> JointPositions::computed(std::span<const double> configuration,
                                                 Scratch& scratch, std::size_t place) const {
  const std::span<double> positions =
      std::span(scratch.positions).subspan(place * moving_.size(), moving_.size());
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    positions[i] = moving_[i].position(configuration);
  }
  return positions;
}

}  // namespace spherule
