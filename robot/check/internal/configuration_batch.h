// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Many configurations of a robot, which lie one behind the other, and an answer to each.

#include "robot/model/internal/shared_work.h"
#include "robot/model/robot_model.h"
#include "spheretree/error.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace spherule::internal {

// The robot's number of variables. Throws Error if there are not as many numbers for every answer.
inline std::size_t require_sizes(const RobotModel& robot, std::span<const double> configurations,
                                 std::span<const std::uint8_t> answers) {
  const auto variables = static_cast<std::size_t>(robot.variable_count());
  if (configurations.size() != answers.size() * variables) {
    throw Error("configurations", std::to_string(configurations.size()) + " numbers for " +
                                      std::to_string(answers.size()) + " answers on a robot with " +
                                      std::to_string(variables) + " variables");
  }
  return variables;
}

// So many neighbouring configurations are taken at a time; fewer than `fewest`, and all of them
// where there is one scratch, are left to the caller's thread, without an allocation.
struct Sharing {
  std::size_t piece;
  std::size_t fewest;
};

// Calls `judge(configurations, scratch, answers)` for all of them, a piece at a time, as
// share_work() does: on a thread for each scratch, of which the caller's is one. Throws Error, too,
// if there is no scratch. The sizes are those of require_sizes().
template <class Scratch, class Judge>
void share_configurations(std::span<const double> configurations, std::size_t variables,
                          const Sharing& sharing, std::span<Scratch> scratches,
                          std::span<std::uint8_t> answers, const Judge& judge) {
  if (scratches.empty()) throw Error("configurations", "there is no scratch to judge them with");
  if (scratches.size() == 1 || answers.size() < sharing.fewest) {
    return judge(configurations, scratches.front(), answers);
  }
  const std::size_t pieces = (answers.size() + sharing.piece - 1) / sharing.piece;
  share_work(pieces, scratches.size(), [&](std::size_t worker, std::size_t piece) {
    const std::size_t first = piece * sharing.piece;
    const std::size_t count = std::min(sharing.piece, answers.size() - first);
    judge(configurations.subspan(first * variables, count * variables), scratches[worker],
          answers.subspan(first, count));
  });
}

}  // namespace spherule::internal
