// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tree_checker.h"

#include "collide/robot/robot_checker.h"

#include <memory>
#include <utility>
#include <vector>

namespace spherule {
namespace {

class TreeChecker : public Checker {
 public:
  TreeChecker(const Workload& workload, TreeMode mode)
      : checker_(made_for(workload)), scratch_(checker_), mode_(mode) {}

  void check(std::span<const JointPositions> configurations,
             std::span<std::uint8_t> verdicts) override {
    if (mode_ == TreeMode::kBatch) {
      checker_.collides({configurations.front().data(), configurations.size() * kJoints}, scratch_,
                        verdicts);
      return;
    }
    for (std::size_t i = 0; i < configurations.size(); ++i) {
      verdicts[i] = checker_.collides(configurations[i], scratch_) ? 1 : 0;
    }
  }

 private:
  static RobotChecker made_for(const Workload& workload) {
    RobotModel robot = workload.robot;
    RobotCheckerOptions options;
    std::vector<PlacedTree> obstacles;
    for (const Obstacle& obstacle : workload.obstacles) {
      obstacles.push_back({obstacle.part.tree, obstacle.world_from_part});
    }
    for (const Body& body : workload.bodies) {
      robot.attach(robot.links()[static_cast<std::size_t>(body.link)].name, body.part.tree);
      for (std::size_t i = 0; i < workload.obstacles.size(); ++i) {
        if (!is_tested(body, workload.obstacles[i])) options.untested.push_back({body.link, i});
      }
    }
    return RobotChecker(std::move(robot), std::move(obstacles), options);
  }

  RobotChecker checker_;
  RobotChecker::Scratch scratch_;
  TreeMode mode_;
};

}  // namespace

std::unique_ptr<Checker> make_tree_checker(const Workload& workload, TreeMode mode) {
  return std::make_unique<TreeChecker>(workload, mode);
}

}  // namespace spherule
