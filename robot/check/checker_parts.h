// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What a RobotChecker and its scratch consist of.

#include "base/error.h"
#include "base/threads.h"
#include "robot/check/body_pairs.h"
#include "robot/check/lane_check.h"
#include "robot/check/robot_checker.h"
#include "robot/check/static_trees.h"
#include "robot/model/joint_positions.h"
#include "robot/model/kinematics.h"
#include "robot/model/robot_model.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace spherule {

struct RobotChecker::Parts {
  struct Named {
    CheckedBody::Kind kind;
    std::string name;
  };

  Parts(RobotModel model, const RobotCheckerOptions& options, internal::BodyPairs all,
        std::vector<Named> body_names, std::vector<Named> obstacle_names)
      : robot(std::move(model)),
        enforces_limits(options.enforce_limits),
        shortest(robot),
        pairs(std::move(all)),
        bodies(std::move(body_names)),
        obstacles(std::move(obstacle_names)) {
    if (enforces_limits) require_limits(robot);
    const internal::RobotPlanSource source = internal::make_plan_source(pairs);
    lanes.emplace(pairs, source, options.instructions);
    if (pairs.static_tree_pairs_begin() == pairs.pairs().size()) return;
    static_trees.emplace(pairs, source, options.instructions);
  }
  // `lanes` and `static_trees` refer to `pairs`.
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  // Whether neither `static_trees` nor BodyPairs::in_filter_range() refuses numbers that are not
  // finite.
  bool requires_finite() const {
    return enforces_limits || (!static_trees && pairs.static_tree_pairs_begin() == 0);
  }

  RobotModel robot;
  bool enforces_limits;
  ShortestMotion shortest;
  // All pairs. Those from pairs.static_tree_pairs_begin() on are of static trees: `static_trees`
  // tests them in configurations.
  internal::BodyPairs pairs;
  std::optional<internal::LaneCheck> lanes;  // of these
  std::optional<internal::StaticTrees> static_trees;
  std::vector<Named> bodies;     // of CheckedPiece::body
  std::vector<Named> obstacles;  // of pairs.obstacles()
};

struct RobotChecker::Scratch::Memory {
  Memory(std::shared_ptr<const Parts> parts, const internal::LaneCheck& check)
      : owner(std::move(parts)), lanes(check) {}

  std::shared_ptr<const Parts> owner;
  internal::LaneCheck::Scratch lanes;
  internal::BodyPairs::Scratch pairs{};
  std::optional<internal::StaticTrees::Scratch> static_trees{};
  std::vector<double> motion_end{};  // of ContinuousMotion::kShortest
};

}  // namespace spherule

// Many configurations of a robot, which lie one behind the other, and an answer to each.

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
// share_work() does: on at most one thread for each scratch. Throws Error, too,
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
