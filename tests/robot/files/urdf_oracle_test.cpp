// SPDX-License-Identifier: BSD-3-Clause
#include "base/files.h"
#include "robot/files/urdf.h"
#include "robot/model/kinematics.h"
#include "tests/robot/files/kdl_robot.h"
#include "tests/robot/files/random_urdf.h"
#include "tests/support/effort.h"
#include "tests/support/models.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>
#include <variant>
#include <vector>

// What published robots have that URDF does not know, or that has no extent.

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

// The kinematics of robots that were read from files, against KDL.

namespace spherule::test {
namespace {

std::string name_of_variable(const RobotModel& robot, int variable) {
  const int joint = robot.variable_joints()[static_cast<std::size_t>(variable)];
  return robot.joints()[static_cast<std::size_t>(joint)].name;
}

void compare_with_kdl(const std::filesystem::path& urdf, Random& random, int configurations) {
  const RobotDescription robot = read_urdf(urdf);
  const KdlRobot kdl(urdf);
  ASSERT_EQ(robot.model.links().size(), kdl.links().size());
  ASSERT_EQ(static_cast<std::size_t>(robot.model.variable_count()), kdl.variables().size());
  for (int i = 0; i < configurations; ++i) {
    std::vector<double> configuration;
    std::map<std::string, double> by_name;
    for (int k = 0; k < robot.model.variable_count(); ++k) {
      configuration.push_back(i == 0 ? 0.0 : random.between(-3.0, 3.0));
      by_name[name_of_variable(robot.model, k)] = configuration.back();
    }
    std::vector<Pose> poses;
    forward_kinematics(robot.model, configuration, poses);
    const auto expected = kdl.poses(by_name);
    for (std::size_t link = 0; link < poses.size(); ++link) {
      const Eigen::Isometry3d& pose = expected.at(robot.model.links()[link].name);
      const double size = 1.0 + pose.translation().norm();
      ASSERT_LE((poses[link].matrix() - pose.linear()).cwiseAbs().maxCoeff(), 1e-11);
      ASSERT_LE((poses[link].translation() - pose.translation()).norm(), 1e-11 * size)
          << robot.model.links()[link].name;
    }
  }
}

TEST(UrdfKinematics, AgreesWithKdlOnRandomRobots) {
  Random random(61);
  const TempDir folder;
  for (int i = 0; i < effort(200, 20); ++i) {
    const std::string urdf = random_urdf(random, static_cast<int>(random.index(15)));
    SCOPED_TRACE(urdf);
    compare_with_kdl(folder.write("robot_" + std::to_string(i) + ".urdf", urdf), random, 5);
    if (HasFatalFailure()) return;
  }
}

TEST(UrdfKinematics, AgreesWithKdlOnRealRobots) {
  const auto models = models_dir();
  if (!models) GTEST_SKIP() << "SPHERULE_MODELS names no folder";
  Random random(62);
  std::set<std::string> read;
  for (const auto& robot : std::filesystem::directory_iterator(*models / "robots")) {
    for (const auto& file : std::filesystem::directory_iterator(robot)) {
      if (file.path().extension() != ".urdf") continue;
      SCOPED_TRACE(file.path());
      compare_with_kdl(file.path(), random, 50);
      read.insert(file.path().stem());
    }
  }
  for (const char* name : {"irb4400l_30_243", "fr3_collision", "franka_panda", "panda_collision"}) {
    EXPECT_TRUE(read.contains(name)) << name;
  }
}

}  // namespace
}  // namespace spherule::test

// What is read from URDF files, against urdfdom.

namespace spherule::test::urdf_oracle_test {
namespace {

namespace fs = std::filesystem;

Eigen::Vector3d vector_of(const urdf::Vector3& v) {
  return {v.x, v.y, v.z};
}

void expect_pose(const Pose& pose, const urdf::Pose& expected) {
  const auto& [x, y, z, w] = expected.rotation;
  EXPECT_EQ(pose.translation(), vector_of(expected.position));
  EXPECT_LE((pose.rotation().coeffs() - Eigen::Vector4d(x, y, z, w)).norm(), 1e-15);
}

void expect_joint(const RobotModel& robot, const Joint& joint, const urdf::Joint& expected) {
  SCOPED_TRACE(expected.name);
  static const std::map<int, JointType> types = {{urdf::Joint::FIXED, JointType::kFixed},
                                                 {urdf::Joint::REVOLUTE, JointType::kRevolute},
                                                 {urdf::Joint::PRISMATIC, JointType::kPrismatic},
                                                 {urdf::Joint::CONTINUOUS, JointType::kContinuous}};
  ASSERT_EQ(joint.type, types.at(expected.type));
  EXPECT_EQ(robot.links()[static_cast<std::size_t>(joint.parent_link)].name,
            expected.parent_link_name);
  EXPECT_EQ(robot.links()[static_cast<std::size_t>(joint.child_link)].name,
            expected.child_link_name);
  expect_pose(joint.parent_from_joint, expected.parent_to_joint_origin_transform);
  if (joint.type == JointType::kFixed) return;
  EXPECT_LE((joint.axis - vector_of(expected.axis).normalized()).norm(), 1e-15);
  if (joint.type != JointType::kContinuous) {
    EXPECT_EQ(joint.lower, expected.limits->lower);
    EXPECT_EQ(joint.upper, expected.limits->upper);
  }
  ASSERT_EQ(joint.mimics >= 0, expected.mimic != nullptr);
  if (joint.mimics < 0) return;
  const Joint& other = robot.joints()[static_cast<std::size_t>(joint.mimics)];
  EXPECT_EQ(other.name, expected.mimic->joint_name);
  if (other.mimics >= 0) return;  // the factors of chains are compared with KDL
  EXPECT_EQ(joint.multiplier, expected.mimic->multiplier);
  EXPECT_EQ(joint.offset, expected.mimic->offset);
}

void expect_geometry(const LinkShape& shape, const urdf::Geometry& expected) {
  if (expected.type == urdf::Geometry::MESH) {
    const auto& mesh = static_cast<const urdf::Mesh&>(expected);
    EXPECT_EQ(std::get<MeshFile>(shape.geometry).path.filename(),
              fs::path(mesh.filename).filename());
    EXPECT_EQ(std::get<MeshFile>(shape.geometry).scale, vector_of(mesh.scale));
    return;
  }
  const auto& solid = std::get<Primitive>(shape.geometry);
  if (expected.type == urdf::Geometry::BOX) {
    EXPECT_EQ(std::get<Box>(solid).size, vector_of(static_cast<const urdf::Box&>(expected).dim));
  } else if (expected.type == urdf::Geometry::SPHERE) {
    EXPECT_EQ(std::get<SolidSphere>(solid).radius,
              static_cast<const urdf::Sphere&>(expected).radius);
  } else {
    const auto& cylinder = static_cast<const urdf::Cylinder&>(expected);
    EXPECT_EQ(std::get<Cylinder>(solid).radius, cylinder.radius);
    EXPECT_EQ(std::get<Cylinder>(solid).length, cylinder.length);
  }
}

template <class Shapes>
std::size_t expect_shapes(const std::vector<LinkShape>& shapes, const Shapes& expected) {
  EXPECT_EQ(shapes.size(), expected.size());
  for (std::size_t i = 0; i < std::min(shapes.size(), expected.size()); ++i) {
    EXPECT_EQ(shapes[i].name, expected[i]->name);
    expect_pose(shapes[i].link_from_shape, expected[i]->origin);
    expect_geometry(shapes[i], *expected[i]->geometry);
  }
  return shapes.size();
}

// The number of shapes that were compared. Of white space in a number or a vector, urdfdom knows
// one blank between two numbers.
std::size_t compare_with_urdfdom(const fs::path& file) {
  std::string text = std::regex_replace(read_file(file), std::regex("[ \n\t]+"), " ");
  text = std::regex_replace(text, std::regex("=' ([0-9]+) '"), "='$1'");
  const urdf::ModelInterfaceSharedPtr expected = urdf::parseURDF(text);
  if (!expected) {
    ADD_FAILURE() << "urdfdom does not read it";
    return 0;
  }
  const RobotDescription robot = read_urdf(file, {.require_visual_meshes = false});
  EXPECT_EQ(robot.name, expected->getName());
  EXPECT_EQ(robot.model.links()[0].name, expected->getRoot()->name);
  EXPECT_EQ(robot.model.links().size(), expected->links_.size());
  EXPECT_EQ(robot.model.joints().size(), expected->joints_.size());
  for (const Joint& joint : robot.model.joints()) {
    expect_joint(robot.model, joint, *expected->joints_.at(joint.name));
  }
  std::size_t shapes = 0;
  for (const LinkDescription& link : robot.links) {
    SCOPED_TRACE(link.name);
    shapes += expect_shapes(link.visual, expected->links_.at(link.name)->visual_array);
    shapes += expect_shapes(link.collision, expected->links_.at(link.name)->collision_array);
  }
  return shapes;
}

TEST(UrdfOracle, AgreesWithUrdfdomOnRandomRobots) {
  Random random(63);
  const TempDir folder;
  std::size_t shapes = 0;
  for (int i = 0; i < effort(200, 20) && !::testing::Test::HasFailure(); ++i) {
    const std::string urdf = random_urdf(random, static_cast<int>(random.index(15)));
    SCOPED_TRACE(urdf);
    shapes += compare_with_urdfdom(folder.write("robot_" + std::to_string(i) + ".urdf", urdf));
  }
  EXPECT_GT(shapes, 20U);
}

TEST(UrdfOracle, AgreesWithUrdfdomOnRealRobots) {
  const auto models = models_dir();
  if (!models) GTEST_SKIP() << "SPHERULE_MODELS names no folder";
  std::set<std::string> read;
  std::size_t shapes = 0;
  for (const auto& file : fs::recursive_directory_iterator(*models / "robots")) {
    if (file.path().extension() != ".urdf") continue;
    SCOPED_TRACE(file.path());
    shapes += compare_with_urdfdom(file.path());
    read.insert(file.path().stem());
  }
  for (const char* name : {"irb4400l_30_243", "fr3_collision", "franka_panda", "panda_collision"}) {
    EXPECT_TRUE(read.contains(name)) << name;
  }
  EXPECT_GT(shapes, 50U);
}

}  // namespace
}  // namespace spherule::test::urdf_oracle_test
