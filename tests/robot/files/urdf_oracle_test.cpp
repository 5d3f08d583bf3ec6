// SPDX-License-Identifier: BSD-3-Clause
#include "base/files.h"
#include "robot/files/robot_description.h"
#include "robot/model/kinematics.h"
#include "tests/robot/files/random_urdf.h"
#include "tests/robot/robots.h"
#include "tests/support/effort.h"
#include "tests/support/models.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>
#include <kdl/frames.hpp>
#include <kdl/joint.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>
#include <variant>
#include <vector>

// What is read from URDF files, against urdfdom, and the kinematics of these robots, against KDL.

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

KDL::Frame frame_of(const urdf::Pose& pose) {
  const auto& [x, y, z, w] = pose.rotation;
  return {KDL::Rotation::Quaternion(x, y, z, w),
          KDL::Vector(pose.position.x, pose.position.y, pose.position.z)};
}

double position_of(const urdf::ModelInterface& robot, const std::string& joint,
                   const std::map<std::string, double>& positions) {
  const auto& mimic = robot.joints_.at(joint)->mimic;
  if (mimic == nullptr) return positions.at(joint);
  return mimic->multiplier * position_of(robot, mimic->joint_name, positions) + mimic->offset;
}

// The pose of a link, seen from the root.
KDL::Frame pose_of(const urdf::ModelInterface& robot, const std::string& link,
                   const std::map<std::string, double>& positions) {
  const urdf::JointSharedPtr joint = robot.links_.at(link)->parent_joint;
  if (joint == nullptr) return KDL::Frame::Identity();
  const KDL::Vector axis(joint->axis.x, joint->axis.y, joint->axis.z);
  KDL::Joint motion(KDL::Joint::None);
  double position = 0.0;
  if (joint->type != urdf::Joint::FIXED) {
    const bool slides = joint->type == urdf::Joint::PRISMATIC;
    motion = {KDL::Vector::Zero(), axis, slides ? KDL::Joint::TransAxis : KDL::Joint::RotAxis};
    position = position_of(robot, joint->name, positions);
  }
  return pose_of(robot, joint->parent_link_name, positions) *
         frame_of(joint->parent_to_joint_origin_transform) * motion.pose(position);
}

void compare_with_kdl(const RobotModel& robot, const urdf::ModelInterface& expected,
                      Random& random) {
  for (int i = 0; i < 5; ++i) {
    const std::vector<double> configuration =
        random_configuration(random, robot, i == 0 ? 0.0 : 3.0);
    std::map<std::string, double> positions;
    for (const Joint& joint : robot.joints()) {
      if (joint.moves()) positions[joint.name] = joint.position(configuration);
    }
    std::vector<Pose> poses;
    forward_kinematics(robot, configuration, poses);
    for (std::size_t link = 0; link < poses.size(); ++link) {
      const KDL::Frame pose = pose_of(expected, robot.links()[link].name, positions);
      for (int row = 0; row < 3; ++row) {
        ASSERT_NEAR(poses[link].translation()[row], pose.p[row], 1e-11 * (1.0 + pose.p.Norm()))
            << robot.links()[link].name;
        for (int column = 0; column < 3; ++column) {
          ASSERT_NEAR(poses[link].matrix()(row, column), pose.M(row, column), 1e-11);
        }
      }
    }
  }
}

// The number of shapes that were compared. Of white space in a number or a vector, urdfdom knows
// one blank between two numbers.
std::size_t compare(const fs::path& file, Random& random) {
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
  compare_with_kdl(robot.model, *expected, random);
  return shapes;
}

TEST(UrdfOracle, AgreesOnRandomRobots) {
  Random random(63);
  const TempDir folder;
  std::size_t shapes = 0;
  for (int i = 0; i < effort(200, 20) && !::testing::Test::HasFailure(); ++i) {
    const std::string urdf = random_urdf(random, static_cast<int>(random.index(15)));
    SCOPED_TRACE(urdf);
    shapes += compare(folder.write("robot_" + std::to_string(i) + ".urdf", urdf), random);
  }
  EXPECT_GT(shapes, 20U);
}

TEST(UrdfOracle, AgreesOnRealRobots) {
  const auto models = models_dir();
  if (!models) GTEST_SKIP() << "SPHERULE_MODELS names no folder";
  Random random(62);
  std::set<std::string> read;
  std::size_t shapes = 0;
  for (const auto& file : fs::recursive_directory_iterator(*models / "robots")) {
    if (file.path().extension() != ".urdf") continue;
    SCOPED_TRACE(file.path());
    shapes += compare(file.path(), random);
    read.insert(file.path().stem());
  }
  for (const char* name : {"irb4400l_30_243", "fr3_collision", "franka_panda", "panda_collision"}) {
    EXPECT_TRUE(read.contains(name)) << name;
  }
  EXPECT_GT(shapes, 50U);
}

}  // namespace
}  // namespace spherule::test::urdf_oracle_test
