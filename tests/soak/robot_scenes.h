// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/check/robot_scene.h"
#include "tests/soak/exact_oracle.h"
#include "tests/soak/random_scene.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {

struct PlacedTree {
  std::shared_ptr<const SphereTree> tree;
  Pose world_from_tree;
};

// A random robot among obstacles. Its first joint shifts all of it, so that it can be brought to
// any gap.
class TreeScene {
 public:
  explicit TreeScene(SoakRandom& random);

  const RobotModel& robot() const { return robot_; }
  // Its links are tested against the obstacles alone.
  RobotScene scene() const;

  std::vector<double> anywhere(SoakRandom& random) const;
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

  std::vector<PlacedTree> obstacles_;
  Eigen::Vector3d direction_;  // of the first joint
  RobotModel robot_;
  std::vector<Sphere> static_, movers_;
  std::vector<Pose> world_from_link_;
  ExactOracle oracle_;
};

// A random RobotScene, and all that it says is tested, pair by pair, with the public queries for
// two shapes alone.
class CheckerScene {
 public:
  explicit CheckerScene(SoakRandom& random);

  const RobotScene& scene() const { return scene_; }
  const RobotModel& robot() const { return scene_.robot(); }
  double size() const { return size_; }
  std::size_t pair_count() const { return pairs_.size(); }

  // Positions that keep every joint, those that mimic others, too, within 100.
  std::vector<double> anywhere(SoakRandom& random) const;
  bool in_filter_range(std::span<const double> configuration) const;

  // Whether a pair touches, by the canonical tests under the poses of forward_kinematics().
  bool touches(std::span<const double> configuration);
  // Up to rounding; 0 where they touch.
  double gap(std::span<const double> configuration);

  // Between one that is free and one that is not, as near to the contact as doubles tell; nothing
  // if no such two were found.
  struct Border {
    std::vector<double> free;
    std::vector<double> contact;
  };
  std::optional<Border> find_border(SoakRandom& random);

 private:
  using Tree = std::shared_ptr<const SphereTree>;
  struct Body {
    std::string name;
    bool is_link;
    int link;  // of carrier_
    std::vector<Tree> trees;
    double padding = 0.0;
    std::vector<BodySphere> region{};  // "part"
  };
  struct Obstacle {
    std::string name;
    ObstacleShape shape;
    Pose world_from_shape;
  };
  // A tree on a link against a tree on another link, or else an obstacle.
  struct Pair {
    Tree tree;
    int link;
    Tree other;
    int other_link;
    std::size_t obstacle;
  };

  RobotModel make_robot(SoakRandom& random);
  void make_bodies(SoakRandom& random);
  void make_obstacles(SoakRandom& random);
  void make_pairs(SoakRandom& random);
  ObstacleShape make_shape(SoakRandom& random) const;
  std::vector<Tree> inflated(const Body& body, double padding, bool without_region) const;
  bool is_moved(int first, int second) const;

  double size_;
  Pose world_from_root_;
  RobotScene scene_;
  RobotModel carrier_;  // with a link for each attached object
  std::vector<Body> bodies_;
  std::vector<Obstacle> obstacles_;
  std::vector<Pair> pairs_;
  std::size_t last_ = 0;  // the pair that touched last
  std::vector<Pose> world_from_link_;
};

}  // namespace spherule::test
