// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/robot_edges/arm.h"
#include "bench/robot_edges/arm_scenes.h"
#include "bench/robot_edges/configurations.h"
#include "bench/robot_edges/counts.h"
#include "bench/robot_edges/edges.h"
#include "bench/robot_edges/fcl_arm.h"
#include "bench/robot_edges/flat_arm.h"
#include "bench/studies/random_numbers.h"
#include "robot/check/robot_checker.h"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace spherule {

// The queries in one scene.
class Course {
 public:
  // Keeps referring to both.
  Course(const Arm& arm, const AllowedCollisions& allowed, const ArmScene& scene);

  // Whose ends are free to both.
  std::vector<Edge> draw(std::size_t count, RandomNumbers& random);

  // The methods take turns at runs of edges; each sees an edge as often as there are rounds.
  Counts measure(std::span<const Edge> edges);

  // So many configurations, anywhere within the limits or on a path, by each method in turns.
  ConfigurationTimes measure_configurations(std::size_t count, bool is_path, RandomNumbers& random);

 private:
  bool is_free(const Configuration& at) { return checker_.check_config(at, scratch_); }

  RobotChecker checker_;
  RobotChecker::Scratch scratch_;
  RobotChecker confirmed_;
  RobotChecker::Scratch confirmed_scratch_;
  FlatArm flat_;
  bool has_mesh_;
  FclArm obbrss_;
  FclArm obb_;
  std::vector<std::unique_ptr<ArmChecker>> bullet_{};  // none if Bullet is not there
  std::vector<ArmChecker*> peers_;                     // all of these
};

}  // namespace spherule
