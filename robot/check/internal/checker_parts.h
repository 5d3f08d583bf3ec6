// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What a RobotChecker and its scratch consist of.

#include "robot/check/internal/body_pairs.h"
#include "robot/check/internal/lane_check.h"
#include "robot/check/internal/static_trees.h"
#include "robot/check/robot_checker.h"
#include "robot/model/shortest_motion.h"

#include <memory>
#include <optional>
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
        lanes(pairs, options.instructions),
        bodies(std::move(body_names)),
        obstacles(std::move(obstacle_names)) {
    if (pairs.static_tree_pairs_begin() == pairs.pairs().size()) return;
    static_trees.emplace(pairs, options.instructions);
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
  internal::LaneCheck lanes;  // of these
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
