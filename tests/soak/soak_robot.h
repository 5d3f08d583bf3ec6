// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/check/robot_scene.h"
#include "tests/soak/exact_oracle.h"
#include "tests/soak/random_scene.h"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace spherule {

struct SoakObstacle {
  std::shared_ptr<const SphereTree> tree;
  Pose world_from_tree;
};

// A random robot among obstacles. Its first joint shifts all of it, so that it can be brought to
// any gap.
class SoakRobot {
 public:
  explicit SoakRobot(SceneRandom& random);

  const RobotModel& robot() const { return robot_; }
  // Its links are tested against the obstacles alone.
  RobotScene scene() const;

  std::vector<double> anywhere(SceneRandom& random) const;
  // Sets the first joint so that the least gap is `gap`, but for rounding; false if the robot
  // passes the obstacles at these positions of the others.
  bool bring_to_gap(std::vector<double>& configuration, double gap);

  // Whether a link touches an obstacle, in exact arithmetic, under the poses of
  // forward_kinematics(), for which the answers are promised.
  bool touches(std::span<const double> configuration);
  // The least gap there, and (for collisions) the largest slack of a pair.
  GapBounds gap(std::span<const double> configuration);
  double slack(std::span<const double> configuration);

 private:
  // Calls use(tree, pose, obstacle) for every pair, until it returns true.
  template <class Use>
  bool any_pair(std::span<const double> configuration, Use use);

  std::vector<SoakObstacle> obstacles_;
  Eigen::Vector3d direction_;  // of the first joint
  RobotModel robot_;
  std::vector<Sphere> static_, movers_;
  std::vector<Pose> world_from_link_;
  ExactOracle oracle_;
};

}  // namespace spherule
