// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/check/robot_scene.h"
#include "tests/support/random.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace spherule::test {

// A random RobotScene, and all that it says is tested, pair by pair, with the public queries for
// two shapes alone.
class CheckerScene {
 public:
  explicit CheckerScene(Random& random);

  const RobotScene& scene() const { return scene_; }
  const RobotModel& robot() const { return scene_.robot(); }
  std::size_t pair_count() const { return pairs_.size(); }

  // Positions that keep every joint, those that mimic others, too, within 100.
  std::vector<double> anywhere(Random& random) const;
  bool in_filter_range(std::span<const double> configuration) const;

  // Whether a pair touches, by the canonical tests under the poses of forward_kinematics().
  bool touches(std::span<const double> configuration);
  // Up to rounding; 0 where they touch.
  double gap(std::span<const double> configuration);
  // What is wrong with the canonical tests of sphere trees, in exact arithmetic; empty if nothing.
  std::string fault_of_trees(std::span<const double> configuration);

  // Between one that is free and one that is not, as near to the contact as doubles tell; nothing
  // if no such two were found.
  struct Border {
    std::vector<double> free;
    std::vector<double> contact;
  };
  std::optional<Border> find_border(Random& random);

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

  RobotModel make_robot(Random& random);
  void make_bodies(Random& random);
  void make_obstacles(Random& random);
  void make_pairs(Random& random);
  ObstacleShape make_shape(Random& random) const;
  std::vector<Tree> inflated(const Body& body, double padding, bool without_region) const;
  bool is_moved(int first, int second) const;
  const Pose& pose_of(int link) const { return world_from_link_[static_cast<std::size_t>(link)]; }
  // What use(tree, pose, other shape, its pose) returns for a pair, as placed last.
  template <class Use>
  auto with_shapes(const Pair& pair, const Use& use) const;

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
