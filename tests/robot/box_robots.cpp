// SPDX-License-Identifier: BSD-3-Clause
#include "tests/robot/box_robots.h"

#include "tests/robot/robots.h"
#include "tests/support/zoo.h"

#include <cmath>
#include <memory>
#include <string>
#include <utility>

namespace spherule::test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

bool overlap(const AlignedBox3d& a, const Pose& of_a, const AlignedBox3d& b, const Pose& of_b,
             double margin) {
  const Matrix3d& axes_a = of_a.matrix();
  const Matrix3d& axes_b = of_b.matrix();
  const Vector3d half_a = (0.5 * a.sizes()).array() - margin;
  const Vector3d half_b = (0.5 * b.sizes()).array() - margin;
  const Vector3d way = of_a * a.center() - of_b * b.center();
  const auto separates = [&](const Vector3d& axis) {
    if (axis.norm() < 1e-9) return false;
    const double reach = half_a.dot((axes_a.transpose() * axis).cwiseAbs()) +
                         half_b.dot((axes_b.transpose() * axis).cwiseAbs());
    return std::abs(axis.dot(way)) > reach;
  };
  for (int i = 0; i < 3; ++i) {
    if (separates(axes_a.col(i)) || separates(axes_b.col(i))) return false;
    for (int j = 0; j < 3; ++j) {
      if (separates(axes_a.col(i).cross(axes_b.col(j)))) return false;
    }
  }
  return true;
}

AlignedBox3d random_box(Random& random) {
  const Vector3d center = random.point(0.3);
  const Vector3d half(random.between(0.02, 0.1), random.between(0.02, 0.1),
                      random.between(0.02, 0.4));
  return {center - half, center + half};
}

}  // namespace

void BoxRobot::add_boxes(int link, std::vector<AlignedBox3d> of_link) {
  TriangleMesh mesh;
  for (const AlignedBox3d& box : of_link) mesh = joined(mesh, box_mesh(box.min(), box.max()));
  boxes.resize(model.links().size());
  boxes[static_cast<std::size_t>(link)] = std::move(of_link);
  bodies.push_back({.link = link, .mesh = std::make_shared<const SolidMesh>(mesh)});
}

AlignedBox3d cube_at(const Vector3d& center) {
  return {center.array() - 0.1, center.array() + 0.1};
}

BoxRobot post_and_bar(const Joint& turn, double height) {
  BoxRobot robot{RobotModel("post")};
  robot.model.add_link("bar", "post", turn);
  robot.add_boxes(0, {cube_at({1.0, 0.0, 0.0})});
  robot.add_boxes(1, {{Vector3d(0.0, -0.02, -height), Vector3d(2.0, 0.02, height)}});
  return robot;
}

BoxRobot random_box_robot(Random& random, int joints, bool branching, bool mimics) {
  BoxRobot robot{RobotModel("link_0")};
  for (int i = 0; i < joints; ++i) {
    const int parent = branching ? random.whole(0, i) : i;
    Joint joint;
    joint.name = "joint_" + std::to_string(i);
    constexpr JointType kTypes[] = {JointType::kRevolute, JointType::kRevolute,
                                    JointType::kPrismatic, JointType::kContinuous,
                                    JointType::kFixed};
    joint.type = kTypes[random.whole(0, 4)];
    joint.parent_from_joint = random.pose(0.6);
    joint.axis = random.point(3.0);
    const double size = joint.type == JointType::kPrismatic ? 0.5 : 2.5;
    joint.lower = random.between(-size, 0.0);
    joint.upper = random.between(0.0, size);
    robot.model.add_link("link_" + std::to_string(i + 1), "link_" + std::to_string(parent), joint);
  }
  if (mimics) add_random_mimics(random, robot.model, 1.0);
  for (int link = 0; link <= joints; ++link) {
    std::vector<AlignedBox3d> boxes{random_box(random)};
    if (random.whole(0, 1) == 0) boxes.push_back(random_box(random));
    robot.add_boxes(link, std::move(boxes));
  }
  return robot;
}

BoxRobot two_turning_bars(double height) {
  BoxRobot robot{RobotModel("base")};
  for (const char* const name : {"first", "second"}) {
    robot.model.add_link(name, "base", turning(-1.0, 1.0, std::string(name) + "_turns"));
  }
  for (const int link : {1, 2}) {
    const double low = height + 0.03 * (link - 1);
    robot.add_boxes(link, {{Vector3d(0.2, -0.01, low), Vector3d(0.6, 0.01, low + 0.02)}});
  }
  return robot;
}

bool boxes_touch(const BoxRobot& robot, int first, int second, std::span<const Pose> poses,
                 double margin) {
  const auto a = static_cast<std::size_t>(first);
  const auto b = static_cast<std::size_t>(second);
  for (const AlignedBox3d& of_a : robot.boxes[a]) {
    for (const AlignedBox3d& of_b : robot.boxes[b]) {
      if (overlap(of_a, poses[a], of_b, poses[b], margin)) return true;
    }
  }
  return false;
}

}  // namespace spherule::test
