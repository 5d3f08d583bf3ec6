// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/pairs/link_pairs.h"
#include "tests/support/random.h"

#include <Eigen/Geometry>

#include <span>
#include <vector>

namespace spherule::test {

// A robot whose links are boxes along the axes of their frames, one or two each, as meshes.
struct BoxRobot {
  RobotModel model;
  std::vector<std::vector<Eigen::AlignedBox3d>> boxes{};  // of every link
  std::vector<LinkBody> bodies{};

  // Gives a link a box; two boxes of a link become one mesh of two closed surfaces.
  void add_boxes(int link, std::vector<Eigen::AlignedBox3d> of_link);
};

// With edges of 0.2 about a centre.
Eigen::AlignedBox3d cube_at(const Eigen::Vector3d& center);

// Joints of all types with limits, mimics where `mimics`, rods and blocks as links.
BoxRobot random_box_robot(Random& random, int joints, bool branching, bool mimics);

// A post of half-width 0.1 at x = 1, which is the base, and a bar from the origin up to x = 2, 0.02
// to each side and up to `height` up and down, that turns about z.
BoxRobot post_and_bar(const Joint& turn, double height = 0.05);

// Two bars, links 1 and 2, along x, one above the other, that turn about the z axis of the base;
// the lower one begins at this height. They touch in no configuration.
BoxRobot two_turning_bars(double height);

// Whether solid boxes of two links have a point in common, by the separating axes of boxes, under
// poses of all links; boxes are shrunk by `margin` on each side first. Nothing of it is shared with
// the library.
bool boxes_touch(const BoxRobot& robot, int first, int second, std::span<const Pose> poses,
                 double margin = 0.0);

}  // namespace spherule::test
