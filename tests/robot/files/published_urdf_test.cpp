// SPDX-License-Identifier: BSD-3-Clause
// What published robots have that URDF does not know, or that has no extent.

#include "robot/files/urdf.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <string>
#include <variant>

namespace spherule::test::published_urdf {
namespace {

std::string robot_of(const std::string& in_link) {
  return "<robot name='r'><link name='base'>" + in_link + "</link></robot>";
}

std::string joint_of(const std::string& type, const std::string& in_joint) {
  return "<robot name='r'><link name='base'/><link name='arm'/><joint name='elbow' type='" + type +
         "'><parent link='base'/><child link='arm'/>" + in_joint + "</joint></robot>";
}

RobotDescription read_text(const std::string& text) {
  const TempDir folder;
  return read_urdf(folder.write("robot.urdf", text));
}

// A point of contact and a flat box are held by what is read; what stands for no shape is not seen.
TEST(PublishedUrdf, WidensShapesWithoutExtent) {
  const RobotDescription robot = read_text(robot_of(R"(
      <visual> <geometry> <box size="0 0 0"/> </geometry> </visual>
      <visual> <geometry> <sphere radius="0.0"/> </geometry> </visual>
      <visual> <geometry> <box size="1 0 2"/> </geometry> </visual>
      <visual> <geometry> <sphere radius="1e-6"/> </geometry> </visual>
      <collision> <origin xyz="1 2 3"/> <geometry> <sphere radius="0"/> </geometry> </collision>
      <collision> <geometry> <cylinder radius="0" length="0"/> </geometry> </collision>)"));
  const LinkDescription& link = robot.links[0];
  ASSERT_EQ(link.visual.size(), 2U);
  const auto solid = [](const LinkShape& shape) { return std::get<Primitive>(shape.geometry); };
  EXPECT_EQ(std::get<Box>(solid(link.visual[0])).size, Eigen::Vector3d(1, 1e-6, 2));
  EXPECT_EQ(std::get<SolidSphere>(solid(link.visual[1])).radius, 1e-6);
  ASSERT_EQ(link.collision.size(), 2U);
  EXPECT_EQ(std::get<SolidSphere>(solid(link.collision[0])).radius, 1e-6);
  EXPECT_EQ(link.collision[0].link_from_shape.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(std::get<Cylinder>(solid(link.collision[1])).radius, 1e-6);
  EXPECT_EQ(std::get<Cylinder>(solid(link.collision[1])).length, 1e-6);
}

// Where published robots have more than URDF knows.
TEST(PublishedUrdf, LeavesOutWhatMeansNothing) {
  EXPECT_EQ(
      read_text(joint_of("continuous", "<axis rpy='0 0 0' xyz='0 1 0'/>")).model.joints()[0].axis,
      Eigen::Vector3d::UnitY());
  EXPECT_EQ(read_text(joint_of("fixed", "<axis xzy='0 0 1'/>")).model.joints().size(), 1U);
  const RobotDescription robot = read_text(robot_of(
      "<collision><geometry><sphere radius='1'/><drake:declare_convex/></geometry></collision>"
      "<visual><geometry><sphere radius='2'/><material name='grey'/></geometry></visual>"));
  EXPECT_EQ(robot.links[0].collision.size(), 1U);
  EXPECT_EQ(robot.links[0].visual.size(), 1U);
}

}  // namespace
}  // namespace spherule::test::published_urdf
