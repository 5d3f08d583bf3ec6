// SPDX-License-Identifier: BSD-3-Clause
#include "cli/robots/turn_review.h"

#include "cli/files/in_file.h"
#include "cli/text/message.h"
#include "robot/model/shortest_motion.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace spherule {

Trajectory ends_of_motions(const RobotModel& robot, const Trajectory& trajectory) {
  const ShortestMotion shortest(robot);
  Trajectory ends = trajectory;
  std::vector<double> room;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const std::span<const double> end =
        shortest.end_of(trajectory.configuration(i - 1), trajectory.configuration(i), room);
    std::copy(end.begin(), end.end(),
              ends.positions.begin() + static_cast<std::ptrdiff_t>(i * trajectory.width));
  }
  return ends;
}

std::string angle_text(double radians, bool in_degrees) {
  std::ostringstream text;
  if (in_degrees) {
    text << radians / kRadiansPerDegree << " degrees";
  } else {
    text << radians << " rad";
  }
  return text.str();
}

std::string describe(const TurningMotions& turning, bool in_degrees) {
  std::ostringstream text;
  text << turning.count << (turning.count == 1 ? " motion turns" : " motions turn")
       << " a continuous joint by more than half a turn, the first from line " << turning.line
       << " to line " << turning.to_line << ": joint " << one_line(turning.joint) << " by "
       << angle_text(turning.step, in_degrees);
  return text.str();
}

TurnReview review_turns(const std::string& urdf, const TrajectoryArguments& arguments,
                        ContinuousMotion motion, const RobotModel& robot,
                        const Trajectory& trajectory) {
  const ShortestMotion shortest(robot);
  if (!shortest.has_turns()) return {};
  TurnReview review{.continuous = motion, .turning = more_than_half_a_turn(robot, trajectory)};
  const std::string& file = arguments.file;
  if (review.continuous == ContinuousMotion::kAsGiven) {
    if (review.turning.count == 0) return review;
    warn(file + ": " + describe(review.turning, arguments.is_in_degrees) +
         "; that way is proved: OMPL and many controllers go the shorter one, which "
         "--continuous shortest proves");
    return review;
  }
  blame_file(urdf, [&] { shortest.require(); });
  const TurningMotions half = half_a_turn(robot, trajectory);
  if (half.count == 0) return review;
  warn(file + ": of " + std::to_string(half.count) + (half.count == 1 ? " motion" : " motions") +
       " no way is clearly the shorter one, because a continuous joint turns by half a turn, the "
       "first from line " +
       std::to_string(half.line) + " to line " + std::to_string(half.to_line) + ": joint " +
       half.joint + "; a controller may go the other way than what is proved");
  return review;
}

}  // namespace spherule
