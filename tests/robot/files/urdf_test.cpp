// SPDX-License-Identifier: BSD-3-Clause
// What a URDF file says, and what is no URDF file.

#include "base/error.h"
#include "robot/files/robot_description.h"
#include "robot/model/joint_positions.h"
#include "robot/model/kinematics.h"
#include "tests/robot/refusals.h"
#include "tests/support/effort.h"
#include "tests/support/temp_dir.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <locale>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace spherule::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOneSphere = "<geometry><sphere radius='1'/></geometry>";

std::string robot_of(const std::string& elements) {
  return "<robot name='r'>" + elements + "</robot>";
}

// A base, and an arm on a joint.
std::string arm_of(const std::string& type, const std::string& in_joint) {
  return robot_of("<link name='base'/><link name='arm'/><joint name='elbow' type='" + type +
                  "'><parent link='base'/><child link='arm'/>" + in_joint + "</joint>");
}

std::string link_of(const std::string& in_link) {
  return robot_of("<link name='base'>" + in_link + "</link>");
}

RobotDescription read_text(const std::string& text, const UrdfOptions& options = {}) {
  const TempDir folder;
  return read_urdf(folder.write("robot.urdf", text), options);
}

const auto read_file = [](const fs::path& file) { read_urdf(file); };

TEST(ReadUrdf, ReadsJointsOfAllTypes) {
  const RobotDescription robot = read_text(R"(
      <robot name="tool">
        <link name="c"/> <link name="b"/> <link name="a"/> <link name="base"/> <link name="d"/>
        <joint name="z first" type="revolute">
          <origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/>
          <axis xyz="0 3 4"/> <limit lower="-1" upper="2" effort="0" velocity="0"/>
          <parent link="base"/> <child link="a"/>
        </joint>
        <joint name="k" type="continuous"> <parent link="a"/> <child link="b"/> </joint>
        <joint name="a last" type="prismatic">
          <axis xyz="0 0 1"/> <limit upper="0.5"/>
          <parent link="base"/> <child link="c"/>
        </joint>
        <joint name="f" type="fixed"> <axis xyz="0 0 0"/> <parent link="c"/> <child link="d"/>
          <mimic joint="nothing"/>
        </joint>
      </robot>)");
  EXPECT_EQ(robot.name, "tool");
  std::vector<std::string> links;
  for (const Link& link : robot.model.links()) links.push_back(link.name);
  EXPECT_EQ(links, (std::vector<std::string>{"base", "a", "b", "c", "d"}));
  ASSERT_EQ(robot.links.size(), 5U);
  EXPECT_EQ(robot.links[3].name, "c");
  const auto& joints = robot.model.joints();
  EXPECT_EQ(joints[0].name, "z first");
  EXPECT_EQ(joints[0].type, JointType::kRevolute);
  EXPECT_TRUE(joints[0].axis.isApprox(Eigen::Vector3d(0, 0.6, 0.8)));
  EXPECT_EQ(joints[0].lower, -1.0);
  EXPECT_EQ(joints[0].upper, 2.0);
  EXPECT_EQ(joints[0].parent_from_joint.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE((joints[0].parent_from_joint.matrix() * Eigen::Vector3d::UnitX())
                  .isApprox(Eigen::Vector3d::UnitY()));
  EXPECT_EQ(joints[1].type, JointType::kContinuous);
  EXPECT_EQ(joints[1].axis, Eigen::Vector3d::UnitX());
  EXPECT_EQ(joints[1].upper, std::numbers::pi);
  EXPECT_EQ(joints[2].type, JointType::kPrismatic);
  EXPECT_EQ(joints[2].lower, 0.0);
  EXPECT_EQ(joints[2].upper, 0.5);
  EXPECT_EQ(joints[3].type, JointType::kFixed);
  EXPECT_EQ(robot.model.variable_count(), 3);
}

TEST(ReadUrdf, ReadsShapes) {
  const TempDir folder;
  fs::create_directories(folder.path() / "meshes");
  const fs::path mesh = folder.write("meshes/a b.stl", "");
  const fs::path file = folder.write("robot.urdf", link_of(R"(
      <inertial/>
      <visual name="look"> <material/> <origin xyz="0 0 1"/>
        <geometry> <mesh filename="meshes/a b.stl" scale="0.001 0.001 -1"/> </geometry> </visual>
      <collision> <geometry> <box size="1 2 3"/> </geometry> </collision>
      <collision name="round"> <geometry> <cylinder length="4" radius="5"/> </geometry>
      </collision>
      <collision> <geometry> <sphere radius="6"/> </geometry> </collision>)"));
  const RobotDescription robot = read_urdf(file);
  ASSERT_EQ(robot.links.size(), 1U);
  const LinkDescription& link = robot.links[0];
  ASSERT_EQ(link.visual.size(), 1U);
  EXPECT_EQ(link.visual[0].name, "look");
  EXPECT_EQ(link.visual[0].link_from_shape.translation(), Eigen::Vector3d(0, 0, 1));
  const auto& look = std::get<MeshFile>(link.visual[0].geometry);
  EXPECT_TRUE(fs::equivalent(look.path, mesh));
  EXPECT_EQ(look.scale, Eigen::Vector3d(0.001, 0.001, -1.0));
  ASSERT_EQ(link.collision.size(), 3U);
  const auto solid = [&](std::size_t i) { return std::get<Primitive>(link.collision[i].geometry); };
  EXPECT_EQ(std::get<Box>(solid(0)).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(link.collision[1].name, "round");
  EXPECT_EQ(std::get<Cylinder>(solid(1)).length, 4.0);
  EXPECT_EQ(std::get<Cylinder>(solid(1)).radius, 5.0);
  EXPECT_EQ(std::get<SolidSphere>(solid(2)).radius, 6.0);
}

// The file that a URDF's name of a mesh means, seen from the folder.
std::string found_mesh(const TempDir& folder, const std::string& urdf, const std::string& name,
                       const UrdfOptions& options = {}) {
  const fs::path file = folder.write(
      urdf, link_of("<visual><geometry><mesh filename='" + name + "'/></geometry></visual>"));
  const RobotDescription robot = read_urdf(file, options);
  const fs::path path = std::get<MeshFile>(robot.links[0].visual[0].geometry).path;
  return fs::relative(path, folder.path()).string();
}

TEST(ReadUrdf, FindsMeshes) {
  const TempDir folder;
  fs::create_directories(folder.path() / "src/arm/urdf");
  fs::create_directories(folder.path() / "src/tool/meshes");
  folder.write("src/arm/package.xml", "<package><name>the_arm</name></package>");
  folder.write("src/tool/package.xml", "<package><name>tool</name></package>");
  for (const char* name : {"src/arm/a.stl", "src/tool/meshes/b.stl", "src/arm/urdf/c.stl"}) {
    folder.write(name, "");
  }
  const auto find = [&](const std::string& name, const UrdfOptions& options = {}) {
    return found_mesh(folder, "src/arm/urdf/robot.urdf", name, options);
  };
  EXPECT_EQ(find("c.stl"), "src/arm/urdf/c.stl");
  EXPECT_EQ(find("../a.stl"), "src/arm/a.stl");
  EXPECT_EQ(find("file://" + (folder.path() / "src/arm/a.stl").string()), "src/arm/a.stl");
  EXPECT_EQ(find("package://the_arm/a.stl"), "src/arm/a.stl");
  EXPECT_EQ(find("package://the_arm/urdf/c.stl"), "src/arm/urdf/c.stl");
  EXPECT_EQ(find("package://tool/meshes/b.stl"), "src/tool/meshes/b.stl");
  EXPECT_EQ(find("package:///tool/meshes/b.stl"), "src/tool/meshes/b.stl");
  EXPECT_EQ(find("package:////the_arm/a.stl"), "src/arm/a.stl");
  const UrdfOptions given{
      .packages = {{"x", folder.path() / "src"}, {"tool", folder.path() / "src/arm"}}};
  EXPECT_EQ(find("package://x/tool/meshes/b.stl", given), "src/tool/meshes/b.stl");
  EXPECT_EQ(find("package://tool/a.stl", given), "src/arm/a.stl");
  for (const char* missing :
       {"d.stl", "package://arm/a.stl", "package://the_arm/b.stl", "package://the_arm",
        "package://", "package:///", "package:///x", "model://x/a.stl", "../urdf"}) {
    EXPECT_THROW(find(missing), Error) << missing;
  }
}

// As what follows package:// and file:// in ROS, which hands it to a reader of URLs. A path is
// none.
TEST(ReadUrdf, FindsFilesWhoseUrlsEscapeCharacters) {
  const TempDir folder;
  fs::create_directories(folder.path() / "the arm");
  folder.write("package.xml", "<package><name>p</name></package>");
  for (const char* name : {"the arm/a b.stl", "c%20d.stl", "c d.stl", "e%2.stl"}) {
    folder.write(name, "");
  }
  const auto find = [&](const std::string& name) { return found_mesh(folder, "robot.urdf", name); };
  EXPECT_EQ(find("package://p/the%20arm/a%20b.stl"), "the arm/a b.stl");
  EXPECT_EQ(find("package://p/the arm/%61 b.stl"), "the arm/a b.stl");
  EXPECT_EQ(find("file://" + folder.path().string() + "/the%20arm/a%20b.stl"), "the arm/a b.stl");
  EXPECT_EQ(find("package://p/c%20d.stl"), "c%20d.stl");
  EXPECT_EQ(find("package://p/e%2.stl"), "e%2.stl");
  for (const char* missing : {"the%20arm/a%20b.stl", "package://p/the%20arm/a%2", "package://p/%",
                              "package://p/c d.stl%00", "package://p/c%2gd.stl"}) {
    EXPECT_THROW(find(missing), Error) << missing;
  }
}

// A point of contact and a flat box are held by what is read; what stands for no shape is not seen.
TEST(ReadUrdf, WidensShapesWithoutExtent) {
  const RobotDescription robot = read_text(link_of(R"(
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
TEST(ReadUrdf, LeavesOutWhatMeansNothing) {
  EXPECT_EQ(
      read_text(arm_of("continuous", "<axis rpy='0 0 0' xyz='0 1 0'/>")).model.joints()[0].axis,
      Eigen::Vector3d::UnitY());
  EXPECT_EQ(read_text(arm_of("fixed", "<axis xzy='0 0 1'/>")).model.joints().size(), 1U);
  const RobotDescription robot = read_text(link_of(
      "<collision><geometry><sphere radius='1'/><drake:declare_convex/></geometry></collision>"
      "<visual><geometry><sphere radius='2'/><material name='grey'/></geometry></visual>"));
  EXPECT_EQ(robot.links[0].collision.size(), 1U);
  EXPECT_EQ(robot.links[0].visual.size(), 1U);
}

std::string of_version(const std::string& version, std::string text) {
  return text.replace(0, std::string("<robot").size(), "<robot version='" + version + "'");
}

TEST(ReadUrdf, ReadsVersionsAfterTheFirst) {
  for (const char* const version : {"1.0", "1.1", "1.2"}) {
    EXPECT_EQ(read_text(of_version(version, link_of(""))).model.links().size(), 1U);
  }
  // 90 degrees about z, twice as long as a unit quaternion.
  const std::string origin = "<origin xyz='1 2 3' quat_xyzw='0 0 1.4142135623730951 ";
  const std::string turned = origin + "1.4142135623730951'/>";
  const RobotDescription robot = read_text(of_version("1.1", arm_of("fixed", turned)));
  const Pose& pose = robot.model.joints()[0].parent_from_joint;
  EXPECT_EQ(pose.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE((pose.matrix() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-15));
  const std::string shape = "<collision>" + turned + kOneSphere + "</collision>";
  EXPECT_TRUE(
      (read_text(of_version("1.2", link_of(shape))).links[0].collision[0].link_from_shape.matrix() *
       Eigen::Vector3d::UnitX())
          .isApprox(Eigen::Vector3d::UnitY(), 1e-15));
  const RobotDescription limits =
      read_text(of_version("1.2", arm_of("revolute",
                                         "<limit lower='-1' upper='2' effort='1' velocity='1' "
                                         "acceleration='3' deceleration='4' jerk='5'/>")));
  EXPECT_EQ(limits.model.joints()[0].upper, 2.0);
  EXPECT_TRUE(limits.warnings.empty());
  const auto refusal = [](const std::string& version, const std::string& in_joint) {
    return refusal_of(of_version(version, arm_of("fixed", in_joint)), read_file);
  };
  EXPECT_NE(refusal("1.0", turned).find("of URDF 1.1"), std::string::npos);
  EXPECT_NE(refusal("1.1", "<origin quat_xyzw='0 0 0 0'/>").find("no rotation"), std::string::npos);
  EXPECT_NE(refusal("1.1", "<origin quat_xyzw='0 0 1'/>").find("3 numbers"), std::string::npos);
  EXPECT_NE(refusal("1.1", "<origin rpy='0 0 0' quat_xyzw='0 0 0 1'/>").find("both"),
            std::string::npos);
}

TEST(ReadUrdf, ReadsCapsulesByTheLengthOfTheirStraightPart) {
  const RobotDescription robot = read_text(
      link_of("<collision><geometry><capsule radius='0.05' length='0.3'/></geometry></collision>"
              "<collision><geometry><capsule radius='0.05' length='0'/></geometry></collision>"));
  const auto& capsule =
      std::get<Capsule>(std::get<Primitive>(robot.links[0].collision[0].geometry));
  EXPECT_EQ(capsule.radius, 0.05);
  EXPECT_EQ(capsule.length, 0.3);
  EXPECT_EQ(robot.links[0].collision.size(), 2U);
}

// Spheres need no limits.
TEST(ReadUrdf, WarnsOfLimitsThatCannotBeUsed) {
  const std::vector<std::pair<std::string, std::string>> limits = {
      {"", "it has no <limit>"},
      {"<limit lower='1' upper='-1'/>", "its limits are reversed: 1 and -1"},
      {"<limit lower='-inf' upper='inf'/>", "the lower limit '-inf' is no finite number"},
      {"<limit lower='0' upper='1e999'/>", "the upper limit '1e999' is no finite number"},
      {"<limit lower='1,5' upper='2'/>", "the lower limit '1,5' is no finite number"},
      {"<limit lower='' upper='2'/>", "the lower limit '' is no finite number"}};
  for (const auto& [limit, fault] : limits) {
    for (const char* const type : {"revolute", "prismatic"}) {
      const RobotDescription robot = read_text(arm_of(type, limit));
      ASSERT_EQ(robot.warnings.size(), 1U) << limit;
      EXPECT_NE(robot.warnings[0].find("robot.urdf: line 1: joint 'elbow': <joint>: " + fault),
                std::string::npos)
          << robot.warnings[0];
      const Joint& joint = robot.model.joints()[0];
      EXPECT_FALSE(has_limits(joint));
      EXPECT_EQ(joint.lower, -std::numeric_limits<double>::infinity());
      EXPECT_EQ(joint.upper, std::numeric_limits<double>::infinity());
      EXPECT_EQ(reason_of([&] { require_limits(robot.model); }, "joint elbow"),
                "it has no limits, which are needed here: correct its <limit> in the URDF");
    }
  }
  const RobotDescription robot = read_text(arm_of("revolute", "<limit effort='1'/>"));
  EXPECT_TRUE(robot.warnings.empty());
  EXPECT_EQ(robot.model.joints()[0].upper, 0.0);
  require_limits(robot.model);
}

std::vector<Pose> poses_of(const RobotDescription& robot, const std::vector<double>& positions) {
  std::vector<Pose> poses;
  forward_kinematics(robot.model, positions, poses);
  return poses;
}

// x = 1, y = 2 and a quarter of a turn of the joint's frame, which stands at (0, 0, 5).
TEST(ReadUrdf, PlanarJointsAreThreeJoints) {
  const RobotDescription robot =
      read_text(arm_of("planar", "<origin xyz='0 0 5'/><axis xyz='0 0 2'/>"));
  ASSERT_EQ(robot.model.variable_count(), 3);
  ASSERT_EQ(robot.links.size(), 4U);
  EXPECT_EQ(robot.links[1].name, "elbow/x");
  EXPECT_EQ(robot.links[3].name, "arm");
  EXPECT_EQ(robot.model.joints()[2].name, "elbow/theta");
  const std::vector<Pose> poses = poses_of(robot, {1.0, 2.0, 0.5 * std::numbers::pi});
  EXPECT_TRUE((poses[3] * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 5), 1e-15));
  // Across x: the frame's y stays.
  const RobotDescription upright = read_text(arm_of("planar", "<axis xyz='1 0 0'/>"));
  const Pose moved = poses_of(upright, {1.0, 2.0, 0.0}).back();
  EXPECT_TRUE(moved.translation().isApprox(Eigen::Vector3d(0, 2, -1), 1e-15));
  EXPECT_EQ(read_text(arm_of("planar", "")).model.joints()[0].axis, Eigen::Vector3d::UnitX());
}

TEST(ReadUrdf, FloatingJointsAreSixJoints) {
  const RobotDescription robot = read_text(arm_of("floating", "<origin xyz='0 0 5'/>"));
  ASSERT_EQ(robot.model.variable_count(), 6);
  EXPECT_EQ(robot.model.joints()[3].name, "elbow/yaw");
  const std::vector<double> configuration = {1.0, 2.0, 3.0, 0.3, -0.4, 0.5};
  const Pose pose = poses_of(robot, configuration).back();
  EXPECT_EQ(pose.translation(), Eigen::Vector3d(1, 2, 8));
  const Eigen::Matrix3d turned = (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()))
                                     .toRotationMatrix();
  EXPECT_TRUE(pose.matrix().isApprox(turned, 1e-15));
}

TEST(ReadUrdf, TellsTheOrderOfTheFileWhereItIsAnother) {
  const std::string joint = "type='continuous'><parent link='";
  const std::string links = "<link name='a'/><link name='b'/><link name='c'/><link name='d'/>";
  const std::string first = "<joint name='j1' " + joint + "a'/><child link='b'/></joint>";
  const std::string second = "<joint name='j2' " + joint + "a'/><child link='c'/></joint>";
  const std::string below_first = "<joint name='j3' " + joint + "b'/><child link='d'/></joint>";
  EXPECT_TRUE(read_text(robot_of(links + first + below_first + second)).other_joint_order.empty());
  EXPECT_EQ(read_text(robot_of(links + first + second + below_first)).other_joint_order,
            (std::vector<std::string>{"j1", "j2", "j3"}));
}

// Without any package.xml: a folder of the package's name above the file, or in one of these.
TEST(ReadUrdf, FindsPackagesByTheNameOfTheirFolder) {
  const TempDir folder;
  for (const char* name : {"src/my_arm/urdf", "src/my_arm/meshes", "src/tool/meshes"}) {
    fs::create_directories(folder.path() / name);
  }
  for (const char* name : {"src/my_arm/meshes/a.stl", "src/tool/meshes/b.stl"}) {
    folder.write(name, "");
  }
  const auto find = [&](const std::string& name) {
    return found_mesh(folder, "src/my_arm/urdf/robot.urdf", name);
  };
  EXPECT_EQ(find("package://my_arm/meshes/a.stl"), "src/my_arm/meshes/a.stl");
  EXPECT_EQ(find("package://tool/meshes/b.stl"), "src/tool/meshes/b.stl");
  const std::string missing = reason_of([&] { find("package://gripper/meshes/b.stl"); });
  EXPECT_NE(missing.find("--package gripper=FOLDER"), std::string::npos) << missing;
  EXPECT_EQ(missing.find("UrdfOptions"), std::string::npos) << missing;
}

TEST(ReadUrdf, FindsPackagesWhereRosHasThem) {
  const TempDir folder;
  fs::create_directories(folder.path() / "ros1/tool");
  fs::create_directories(folder.path() / "ros2/share/hand");
  fs::create_directories(folder.path() / "robots");
  folder.write("ros1/tool/a.stl", "");
  folder.write("ros2/share/hand/b.stl", "");
  const auto find = [&](const std::string& name) {
    return found_mesh(folder, "robots/robot.urdf", name);
  };
  EXPECT_THROW(find("package://tool/a.stl"), Error);
  setenv("ROS_PACKAGE_PATH", ("/nowhere:" + (folder.path() / "ros1").string()).c_str(), 1);
  setenv("AMENT_PREFIX_PATH", (folder.path() / "ros2").c_str(), 1);
  EXPECT_EQ(find("package://tool/a.stl"), "ros1/tool/a.stl");
  EXPECT_EQ(find("package://hand/b.stl"), "ros2/share/hand/b.stl");
  unsetenv("ROS_PACKAGE_PATH");
  unsetenv("AMENT_PREFIX_PATH");
}

TEST(ReadUrdf, KeepsMeshesThatAreMissingIfTold) {
  const UrdfOptions options{.require_visual_meshes = false};
  const UrdfOptions other{.require_collision_meshes = false};
  const auto shape = [](const std::string& tag, const std::string& name) {
    return link_of("<" + tag + "><geometry><mesh filename='" + name + "'/></geometry></" + tag +
                   ">");
  };
  for (const std::string name : {"x.stl", "package://p/x.stl"}) {
    const RobotDescription robot = read_text(shape("visual", name), options);
    EXPECT_EQ(std::get<MeshFile>(robot.links[0].visual.at(0).geometry).path, fs::path(name));
    EXPECT_THROW(read_text(shape("visual", name)), Error);
    EXPECT_THROW(read_text(shape("collision", name), options), Error);
    EXPECT_THROW(read_text(shape("visual", name), other), Error);
    const RobotDescription seen = read_text(shape("collision", name), other);
    EXPECT_EQ(std::get<MeshFile>(seen.links[0].collision.at(0).geometry).path, fs::path(name));
  }
}

TEST(ReadUrdf, RefusesBadFiles) {
  const std::string limit = "<limit effort='1' velocity='1' lower='-1' upper='1'/>";
  const auto shape = [](const std::string& tag, const std::string& geometry) {
    return link_of("<" + tag + "><geometry>" + geometry + "</geometry></" + tag + ">");
  };
  const std::vector<BadText> files = {
      {"", {"not XML"}},
      {"<robot name='r'>", {"line 1", "not XML"}},
      {"<robot name='r'><link name='a'/>\n<link name='b</robot>", {"not XML"}},
      {std::string("<robot name='r'><link name='a'/></robot>\0", 41), {"zero byte"}},
      {"<model/>", {"no <robot>"}},
      {"<sdf version='1.7'/>", {"no <robot>", "SDF", "made a URDF"}},
      {"<mujoco model='r'/>", {"no <robot>", "MJCF", "made a URDF"}},
      {shape("collision", "<mesh filename='$(find r)/a.stl'/>"), {"line 1", "$(find r)", "xacro"}},
      {"<robot name='r'><link name='a'/></robot><robot name='s'/>", {"more than one root"}},
      {"x<robot name='r'><link name='a'/></robot>", {"line 1", "outside of the root"}},
      {"<robot name='r'><link name='a'/></robot>\nx", {"line 2", "not XML"}},
      {"<robot><link name='a'/></robot>", {"no name"}},
      {robot_of(""), {"line 1", "no <link>"}},
      {"<robot name='r' version='2.0'><link name='a'/></robot>", {"'2.0'", "versions 1.0 to 1.2"}},
      {"<robot name='r' version='1.3'><link name='a'/></robot>", {"'1.3'", "versions 1.0 to 1.2"}},
      {robot_of("<link name='a'/><xacro:macro name='m'/>"), {"xacro"}},
      {link_of("<xacro:shapes/>"), {"xacro"}},
      {robot_of("<link/>"), {"no name"}},
      {robot_of("<link name=''/>"), {"no name"}},
      {robot_of("<link name='a\xFF'/>"), {"UTF-8"}},
      {robot_of("<link name='a\xF0'/>"), {"UTF-8"}},
      {robot_of("<link name='a'/><link name='a'/>"), {"link 'a' is not unique"}},
      {robot_of("<link name='a'/><link name='b'/>"), {"link 'b'", "a root", "link 'a'"}},
      {robot_of("<link name='a'/><link name='b'/><link name='c'/><joint name='j' type='fixed'>"
                "<parent link='a'/><child link='b'/></joint>"
                "<joint name='j' type='fixed'><parent link='b'/><child link='c'/></joint>"),
       {"joint 'j' is not unique"}},
      {robot_of("<link name='a'/><link name='b'/><joint name='j' type='fixed'>"
                "<parent link='a'/><child link='b'/></joint>"
                "<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint>"),
       {"is above itself"}},
      {robot_of("<link name='a'/><link name='b'/><link name='c'/><joint name='j' type='fixed'>"
                "<parent link='c'/><child link='b'/></joint>"
                "<joint name='k' type='fixed'><parent link='b'/><child link='c'/></joint>"),
       {"is above itself"}},
      {robot_of("<link name='a'/><link name='b'/><joint name='j' type='fixed'>"
                "<parent link='a'/><child link='b'/></joint>"
                "<joint name='k' type='fixed'><parent link='a'/><child link='b'/></joint>"),
       {"link 'b'", "two joints", "'j'", "'k'"}},
      {robot_of("<link name='a'/><joint name='j' type='fixed'><parent link='a'/>"
                "<child link='x'/></joint>"),
       {"x", "j", "not found"}},
      {robot_of("<link name='a'/><joint name='j' type='fixed'><parent link='x'/>"
                "<child link='a'/></joint>"),
       {"x", "j", "not found"}},
      {robot_of("<link name='a'/><joint name='j' type='fixed'><child link='a'/></joint>"),
       {"joint 'j'", "no <parent>"}},
      {arm_of("fixed", "<child link='base'/>"), {"joint 'elbow'", "there is one already"}},
      {arm_of("planar", "<axis xyz='0 0 0'/>"), {"elbow", "axis is zero"}},
      {arm_of("floating", "<mimic joint='x'/>"), {"elbow", "planar or floating"}},
      {arm_of("screw", ""), {"elbow", "no known type", "screw"}},
      {arm_of("%s%n", ""), {"elbow", "no known type"}},
      {arm_of("", ""), {"elbow", "no type"}},
      {arm_of("prismatic", "<axis xyz='0 0 0'/>" + limit), {"elbow", "axis is zero"}},
      {arm_of("continuous", "<axis xyz='0 0 0'/>"), {"elbow", "axis is zero"}},
      {arm_of("continuous", "<axis/>"), {"elbow", "<axis>", "no xyz"}},
      {arm_of("continuous", "<axis xyz='0 1 0' rpy='0 0 1'/>"), {"elbow", "<axis>", "rpy"}},
      {arm_of("continuous", "<axis xzy='0 1 0'/>"), {"elbow", "<axis>", "xzy"}},
      {arm_of("continuous", "<axis xyz='0 1'/>"), {"elbow", "<axis>", "2 numbers"}},
      {arm_of("continuous", "<axis xyz='0 1 O'/>"), {"elbow", "'O'", "no finite number"}},
      {arm_of("continuous", "<axis xyz='0 nan 1'/>"), {"elbow", "'nan'"}},
      {arm_of("fixed", "<origin xyz='1 2'/>"), {"elbow", "<origin>", "2 numbers"}},
      {arm_of("fixed", "<origin rpy='1 2 %n'/>"), {"elbow", "'%n'"}},
      {arm_of("fixed", "<origin xyz='1 2 1e16'/>"), {"elbow"}},
      {arm_of("fixed", "<origin xzy='1 2 3'/>"), {"elbow", "xzy"}},
      {arm_of("fixed", "<origin quat_xyzw='0 0 0 1'/>"), {"elbow", "quat_xyzw"}},
      {arm_of("fixed", "<origin/><origin xyz='1 2 3'/>"), {"elbow", "there is one already"}},
      {arm_of("continuous", "<mimic/>"), {"elbow", "<mimic>", "no joint"}},
      {arm_of("continuous", "<mimic joint='x'/>"), {"joint x", "no such joint"}},
      {arm_of("continuous", "<mimic joint='elbow'/>"), {"joint elbow", "mimic itself"}},
      {arm_of("continuous", "<mimic joint='x' multiplier='two'/>"), {"elbow", "'two'"}},
      {arm_of("continuous", "<mimic joint='x' factor='2'/>"), {"elbow", "factor"}},
      {shape("collision", ""), {"base", "<geometry>", "not one shape"}},
      {shape("collision", "<sphere radius='1'/><sphere radius='2'/>"), {"not one shape"}},
      {link_of("<collision/>"), {"base", "<collision>", "no <geometry>"}},
      {link_of("<visual><geometry/></visual>"), {"not one shape"}},
      {link_of(std::string("<collision>") + kOneSphere + kOneSphere + "</collision>"),
       {"there is one already"}},
      {shape("collision", "<cone radius='1' length='1'/>"), {"<cone>", "can be read"}},
      {shape("collision", "<capsule radius='1'/>"), {"<capsule>", "no length"}},
      {shape("collision", "<capsule radius='1' length='-1'/>"), {"link 'base'"}},
      {shape("collision", "<sphere/>"), {"<sphere>", "no radius"}},
      {shape("collision", "<sphere radius='-1e-9'/>"), {"link 'base'"}},
      {shape("collision", "<sphere radius='-1'/>"), {"link 'base'"}},
      {shape("collision", "<sphere radius='1 2'/>"), {"base", "2 numbers"}},
      {shape("collision", "<sphere radius='1' length='2'/>"), {"base", "length"}},
      {shape("collision", "<cylinder radius='1'/>"), {"no length"}},
      {shape("collision", "<box size='1 1 -1'/>"), {"link 'base'"}},
      {shape("collision", "<sphere radius='1'/><other:sphere radius='2'/><box size='1 1 1'/>"),
       {"not one shape"}},
      {shape("collision", "<other:sphere radius='2'/>"), {"not one shape"}},
      {shape("collision", "<box size='1 1'/>"), {"2 numbers"}},
      {shape("visual", "<mesh/>"), {"no filename"}},
      {shape("visual", "<mesh filename='x.stl'/>"), {"link 'base'", "x.stl", "no such file"}},
      {shape("visual", "<mesh filename='x.stl' scale='1 0 1'/>"), {"base", "scale is zero"}},
      {shape("visual", "<mesh filename='package://p/x.stl'/>"), {"base", "package://p"}},
  };
  expect_refusals(files, read_file);
  EXPECT_THROW(read_urdf("no such file.urdf"), Error);
}

// Whatever is wrong stands in line 3, or shows there.
TEST(ReadUrdf, NamesTheLine) {
  const auto joint = [](const std::string& name, const std::string& parent,
                        const std::string& child, const std::string& in_joint = {}) {
    return "<joint name='" + name + "' type='continuous'><parent link='" + parent +
           "'/><child link='" + child + "'/>" + in_joint + "</joint>";
  };
  const auto shape = [](const std::string& solid) {
    return "<link name='b'><collision><geometry>\n" + solid + "</geometry></collision></link>\n";
  };
  for (const std::string& elements :
       {std::string("<link name='a'/>\n<link name='b'/>"),
        std::string("<link name='a'/>\n<link name='a'/>"),
        "<link name='a'/>\n" + joint("j", "a", "x"), "<link name='a'/>\n" + joint("j", "a", "a"),
        "<link name='a'/><link name='b'/>\n" + joint("j", "a", "b", "<axis xyz='0 0 0'/>"),
        "<link name='a'/><link name='b'/>\n" + joint("j", "a", "b", "<origin xyz='0 0 1e16'/>"),
        "<link name='a'/><link name='b'/>\n" + joint("j", "a", "b", "<mimic joint='k'/>"),
        "<link name='a'/><link name='b'/>" + joint("j", "a", "b") + "\n" + joint("k", "a", "b"),
        "<link name='a'/><link name='b'/><link name='c'/>" + joint("j", "a", "b") + "\n" +
            joint("j", "b", "c"),
        shape("<sphere radius='-1'/>"), shape("<mesh filename='x.stl'/>"),
        shape("<mesh filename='x.stl' scale='1 1 0'/>")}) {
    const std::string refusal =
        refusal_of("<?xml version='1.0'?>\n" + robot_of(elements), read_file);
    EXPECT_TRUE(refusal.starts_with("line 3: ")) << refusal;
  }
}

// Deeper than any parser may recurse.
TEST(ReadUrdf, RefusesElementsWithinElements) {
  std::string text;
  for (int i = 0; i < 100000; ++i) text += "<robot name='r'>";
  EXPECT_NE(refusal_of(text, read_file).find("line 1: elements are nested too deep"),
            std::string::npos);
}

// In time that grows nearly as the file does.
TEST(ReadUrdf, TakesADeepChainOfFixedJoints) {
  const int joints = effort(100000, 10000);
  std::string text = "<link name='l0'/>";
  for (int i = 1; i <= joints; ++i) {
    const std::string n = std::to_string(i);
    text += "<link name='l" + n + "'/><joint name='j" + n + "' type='fixed'><parent link='l" +
            std::to_string(i - 1) + "'/><child link='l" + n + "'/></joint>";
  }
  const RobotDescription robot = read_text(robot_of(text));
  EXPECT_EQ(robot.model.links().size(), static_cast<std::size_t>(joints) + 1);
  EXPECT_EQ(robot.model.joints().back().parent_link, joints - 1);
}

class DecimalComma : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

TEST(ReadUrdf, ReadsNumbersInAnyLocale) {
  const std::locale before =
      std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  const RobotDescription robot = read_text(link_of(
      "<visual><origin xyz='0.5 1.5e-3 2'/><geometry><sphere radius='0.25'/></geometry></visual>"));
  std::locale::global(before);
  const LinkShape& shape = robot.links[0].visual[0];
  EXPECT_EQ(shape.link_from_shape.translation(), Eigen::Vector3d(0.5, 1.5e-3, 2.0));
  EXPECT_EQ(std::get<SolidSphere>(std::get<Primitive>(shape.geometry)).radius, 0.25);
}

// Robots whose URDF the program xacro makes: a stand-in for it on the PATH.
class Xacro : public ::testing::Test {
 protected:
  void SetUp() override { path_ = std::getenv("PATH"); }
  void TearDown() override { ::setenv("PATH", path_.c_str(), 1); }

  // Writes this as the program xacro, which is found before any other.
  void install(const std::string& script) {
    fs::create_directory(folder_.path() / "bin");
    const fs::path program = folder_.write("bin/xacro", "#!/bin/sh\n" + script);
    fs::permissions(program, fs::perms::owner_all);
    ::setenv("PATH", (program.parent_path().string() + ":" + path_).c_str(), 1);
  }
  void expect_refusal(const fs::path& file, const std::string& reason) {
    const std::string found = reason_of([&] { read_urdf(file); }, file.string());
    EXPECT_NE(found.find(reason), std::string::npos) << found;
  }

  TempDir folder_;

 private:
  std::string path_;
};

// The script writes what follows the first line of the file it is given.
TEST_F(Xacro, WhatItMakesIsRead) {
  install("tail -n +2 \"$1\"\n");
  const std::string urdf =
      "<robot name='r'><link name='a'><visual><geometry><mesh filename='a.stl'/></geometry>"
      "</visual></link></robot>\n";
  const fs::path file = folder_.write("arm.urdf.xacro", "a line for the script\n" + urdf);
  folder_.write("a.stl", "");
  const RobotDescription robot = read_urdf(file);
  EXPECT_EQ(robot.name, "r");
  // A path from the folder of the file that was named.
  ASSERT_EQ(robot.links.at(0).visual.size(), 1U);
  EXPECT_EQ(read_urdf(fs::relative(file)).name, "r");
}

TEST_F(Xacro, WhatFailsNamesTheFile) {
  const fs::path file = folder_.write("arm.urdf.xacro", "<robot name='r'/>");
  install("exit 3\n");
  expect_refusal(file, "xacro makes no URDF of it (exit code 3)");
  install("kill -TERM $$\n");
  expect_refusal(file, "xacro was ended by a signal");
  install("true\n");
  expect_refusal(file, "not XML");
  ::setenv("PATH", folder_.path().c_str(), 1);
  expect_refusal(file,
                 "needs the program xacro, which makes a URDF of it and cannot be run: No such");
}

}  // namespace
}  // namespace spherule::test
