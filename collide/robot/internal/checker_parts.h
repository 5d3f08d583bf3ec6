// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What a RobotChecker and its scratch consist of.

#include "collide/robot/internal/body_pairs.h"
#include "collide/robot/robot_checker.h"
#include "collide/robot/robot_tree_checker.h"
#include "spheretree/rounding.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spherule {

namespace internal {

// Of both together; no less than that.
inline double padding_sum(double first, double second) {
  return first == 0.0 || second == 0.0 ? first + second : add_up(first, second);
}

}  // namespace internal

struct RobotChecker::Parts {
  struct Named {
    CheckedBody::Kind kind;
    std::string name;
  };

  RobotModel robot;
  bool enforces_limits = false;
  // All pairs; those behind pairs.tested() are of standing trees, and tested by `standing`.
  internal::BodyPairs pairs;
  std::optional<RobotTreeChecker> standing{};
  std::vector<Named> bodies{};     // of CheckedPiece::body
  std::vector<Named> obstacles{};  // of pairs.obstacles()
};

struct RobotChecker::Scratch::Memory {
  std::shared_ptr<const Parts> owner;
  internal::BodyPairs::Memory pairs{};
  std::optional<RobotTreeChecker::Scratch> standing{};
};

}  // namespace spherule
