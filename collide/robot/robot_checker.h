// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mechanism_check.h"
#include "collide/robot/robot_model.h"
#include "spheretree/pose.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace spherule {

// A link's trees and an obstacle that need not be tested, by their indices.
struct UntestedPair {
  int link = 0;
  std::size_t obstacle = 0;
};

struct PlacedTree {
  std::shared_ptr<const SphereTree> tree;
  Pose world_from_tree;
};

struct RobotCheckerOptions {
  Pose world_from_root{};
  std::vector<UntestedPair> untested{};
  InstructionSet instructions = best_instruction_set();
};

// Does any link of a robot touch an obstacle? Made once for a robot and standing obstacles, then
// asked for many configurations.
//
// The answer is exactly the one of collides() for each link's trees and each obstacle, under the
// poses that forward_kinematics() computes; so G4 and G5 hold with respect to these poses, and no
// instruction set changes an answer. Links of the robot against each other are no matter of this
// class. It keeps the robot and the trees alive; immutable, threads may share it, each with a
// scratch of its own.
class RobotChecker {
 public:
  // Throws Error for a missing tree or an index out of range.
  RobotChecker(RobotModel robot, std::vector<PlacedTree> obstacles,
               const RobotCheckerOptions& options = {});

  // What a query writes to; no query allocates once it is warm.
  class Scratch {
   public:
    explicit Scratch(const RobotChecker& checker) : memory_(*checker.check_) {}

   private:
    friend class RobotChecker;
    MechanismCheck::Scratch memory_;
    std::vector<Pose> world_from_link_;
  };

  // Throws Error for a configuration of the wrong size or with a number that is not finite, and as
  // forward_kinematics() does for one that leads out of all bounds. Positions beyond 100 (radians
  // or units of length) are answered as exactly, but slowly.
  bool collides(std::span<const double> configuration, Scratch& scratch) const;

 private:
  struct Body {
    std::shared_ptr<const SphereTree> tree;
    std::size_t link;
  };

  // What robot_collides() says of the pairs that are tested.
  bool collides_exactly(std::span<const double> configuration, Scratch& scratch) const;

  RobotModel robot_;
  std::vector<PlacedTree> obstacles_;
  Pose world_from_root_;
  std::vector<Body> bodies_;  // that variables move, the last link first
  std::vector<MechanismPair> pairs_;
  bool always_ = false;  // a link that stands with the root touches
  std::optional<MechanismCheck> check_;
};

}  // namespace spherule
