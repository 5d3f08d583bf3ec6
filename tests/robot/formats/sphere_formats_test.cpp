// SPDX-License-Identifier: BSD-3-Clause
#include "robot/formats/sphere_formats.h"

#include "base/files.h"
#include "robot/formats/sphere_documents.h"
#include "tests/robot/formats/sphere_sets.h"
#include "tests/support/effort.h"
#include "tests/support/temp_dir.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace spherule {
namespace {

namespace fs = std::filesystem;
using test::TempDir;

constexpr SphereFormat kWritten[] = {SphereFormat::kUrdf,   SphereFormat::kSrdf,
                                     SphereFormat::kCurobo, SphereFormat::kXrdf,
                                     SphereFormat::kFoam,   SphereFormat::kSpherule};

class SphereFormats : public ::testing::Test {
 protected:
  SphereFileContext context_for(const RobotSpheres& spheres) {
    SphereFileContext context;
    context.urdf = folder_.write("robot.urdf", urdf_text(spheres.links));
    context.base_link = spheres.links.front().link;
    context.tool_link = spheres.links.back().link;
    context.joint_names = {"joint 1", "yes", "j#3"};
    context.joint_positions = {0.5, -1.3};
    return context;
  }

  fs::path file(const std::string& name) const { return folder_.path() / name; }

  TempDir folder_;
};

using Buffers = std::map<std::string, double>;
using Pairs = std::set<std::pair<std::string, std::string>>;
Pairs pairs_of(const RobotSpheres& spheres) {
  Pairs pairs;
  for (const DisabledPair& pair : spheres.self_collision_ignore) {
    pairs.insert(std::minmax(pair.link_a, pair.link_b));
  }
  return pairs;
}

TEST_F(SphereFormats, EveryFormatReadsBackBitForBit) {
  test::Random random(11);
  for (int round = 0; round < test::effort(12, 3); ++round) {
    const RobotSpheres spheres = random_spheres(random, 1 + random.index(60));
    const SphereFileContext context = context_for(spheres);
    for (const SphereFormat format : kWritten) {
      SCOPED_TRACE(std::string(name_of(format)) + ", round " + std::to_string(round));
      write_robot_spheres(spheres, format, context, file("out"));
      const SphereFormatFile read = read_robot_spheres(file("out"));
      EXPECT_EQ(read.format, format);
      EXPECT_EQ(difference(read.spheres.links, spheres.links), "");
      const bool keeps_none = format == SphereFormat::kUrdf || format == SphereFormat::kFoam;
      EXPECT_EQ(pairs_of(read.spheres), keeps_none ? Pairs() : pairs_of(spheres));
      const bool keeps_buffers = !keeps_none && format != SphereFormat::kSrdf;
      EXPECT_EQ(read.spheres.self_collision_buffer,
                keeps_buffers ? spheres.self_collision_buffer : Buffers());
      EXPECT_EQ(read.spheres.switched_off, 0u);
      const std::string bytes = read_file(file("out"));
      write_robot_spheres(spheres, format, context, file("out"));
      EXPECT_EQ(bytes, read_file(file("out")));
    }
  }
}

TEST_F(SphereFormats, OurOwnFormatMarksAnInterruptedSearch) {
  test::Random random(12);
  RobotSpheres spheres = random_spheres(random, 4);
  const SphereFileContext context = context_for(spheres);
  for (const bool interrupted : {false, true}) {
    spheres.interrupted = interrupted;
    write_robot_spheres(spheres, SphereFormat::kSpherule, context, file("out"));
    EXPECT_EQ(read_robot_spheres(file("out")).spheres.interrupted, interrupted);
    EXPECT_EQ(read_file(file("out")).find("interrupted") != std::string::npos, interrupted);
  }
}

TEST_F(SphereFormats, BuffersForAllAndForEach) {
  RobotSpheres spheres{.robot = "r", .links = {{"a", {{{1, 2, 3}, 0.5}}}, {"b", {}}}};
  spheres.collision_buffer = -0.003;
  const SphereFileContext context = context_for(spheres);
  write_robot_spheres(spheres, SphereFormat::kCurobo, context, file("c.yml"));
  EXPECT_EQ(read_robot_spheres(file("c.yml")).spheres.collision_buffer, -0.003);
  write_robot_spheres(spheres, SphereFormat::kXrdf, context, file("x.xrdf"));
  const std::map<std::string, double> each = {{"a", -0.003}, {"b", -0.003}};
  EXPECT_EQ(read_robot_spheres(file("x.xrdf")).spheres.collision_buffers, each);
  spheres.collision_buffers = {{"a", 0.25}};
  for (const auto format : {SphereFormat::kCurobo, SphereFormat::kXrdf, SphereFormat::kSpherule}) {
    write_robot_spheres(spheres, format, context, file("out"));
    EXPECT_EQ(read_robot_spheres(file("out")).spheres.collision_buffers, spheres.collision_buffers);
  }
}

TEST_F(SphereFormats, JsonIsWhatOthersParse) {
  const RobotSpheres spheres{.robot = "r", .links = {{"a \"b\"", {{{1, 2.5, -3}, 0.125}}}}};
  write_robot_spheres(spheres, SphereFormat::kFoam, {}, file("foam.json"));
  const auto foam = nlohmann::json::parse(read_file(file("foam.json")));
  const auto& level = foam.at("a \"b\"").at(0);
  EXPECT_EQ(level.at("spheres").at(0).at("origin"), nlohmann::json({1.0, 2.5, -3.0}));
  EXPECT_EQ(level.at("spheres").at(0).at("radius"), 0.125);
  for (const char* key : {"mean", "best", "worst"}) EXPECT_TRUE(level.at(key).is_null());
  write_robot_spheres(spheres, SphereFormat::kSpherule, {}, file("own.json"));
  const auto own = nlohmann::json::parse(read_file(file("own.json")));
  EXPECT_EQ(own.at("format"), "spherule-robot-spheres");
  EXPECT_EQ(own.at("version"), 1);
  EXPECT_EQ(own.at("links").at(0).at("spheres").at(0).at("radius"), 0.125);
}

TEST_F(SphereFormats, NumbersInYamlAndXmlHaveNoExponent) {
  const RobotSpheres spheres{.robot = "r", .links = {{"a", {{{1e-7, 1e15, -5e-324}, 4e-9}}}}};
  for (const auto format :
       {SphereFormat::kUrdf, SphereFormat::kSrdf, SphereFormat::kCurobo, SphereFormat::kXrdf}) {
    write_robot_spheres(spheres, format, context_for(spheres), file("out"));
    const std::string text = read_file(file("out"));
    EXPECT_NE(text.find("0.0000001"), std::string::npos) << text;
    EXPECT_NE(text.find("1000000000000000.0"), std::string::npos) << text;
    EXPECT_EQ(text.find("e-0"), std::string::npos) << text;
    EXPECT_EQ(text.find("e+"), std::string::npos) << text;
    EXPECT_NE(text.find("0.000000004"), std::string::npos) << text;
  }
}

TEST_F(SphereFormats, CuroboHasWhatItsUsersNeed) {
  RobotSpheres spheres{
      .robot = "r", .links = {{"base", {{{0, 0, 0}, 1}}}, {"arm", {{{0, 0, 0}, 1}}}, {"bare", {}}}};
  spheres.self_collision_ignore = {{"arm", "base", "Adjacent"}};
  write_robot_spheres(spheres, SphereFormat::kCurobo, context_for(spheres), file("r.yml"));
  const std::string text = read_file(file("r.yml"));
  for (const char* part :
       {"robot_cfg:\n  kinematics:\n", "urdf_path: ", "base_link: base\n", "ee_link: bare\n",
        "collision_link_names: [base, arm]\n", "      bare: []\n",
        // cuRobo searches for a pair under the link that comes first.
        "self_collision_ignore:\n      base: [arm]  # Adjacent: arm\n",
        "collision_sphere_buffer: 0.0\n", "joint_names: [\"joint 1\", \"yes\", \"j#3\"]\n",
        "retract_config: [0.5, -1.3, 0.0]\n"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

TEST_F(SphereFormats, UrdfKeepsTheRestAndFindsItsMeshes) {
  const RobotSpheres spheres{.robot = "r", .links = {{"a", {{{1, 2, 3}, 0.5}}}}};
  fs::create_directory(file("out"));
  const auto urdf = folder_.write("r.urdf", R"(<?xml version="1.0"?>
    <!-- head --><robot name="r" xmlns:x="y"><link name="a"><inertial/>
    <visual><geometry><mesh filename="m/a.dae"/></geometry></visual>
    <visual><geometry><mesh filename="file://m/b.dae"/></geometry></visual>
    <visual><geometry><mesh filename="file:///m/c.dae"/></geometry></visual>
    <collision><geometry><box size="1 1 1"/></geometry></collision><visual name="last"/></link>
    <link name="b"><collision><geometry><mesh filename="package://p/b.stl"/></geometry></collision>
    </link><joint name="j" type="revolute"><parent link="a"/><child link="b"/></joint></robot>)");
  write_robot_spheres(spheres, SphereFormat::kUrdf, {.urdf = urdf}, file("out/s.urdf"));
  const std::string text = read_file(file("out/s.urdf"));
  EXPECT_NE(text.find("<!-- head -->"), std::string::npos);
  EXPECT_NE(text.find("xmlns:x=\"y\""), std::string::npos);
  EXPECT_NE(text.find("filename=\"../m/a.dae\""), std::string::npos) << text;
  EXPECT_NE(text.find("filename=\"file://../m/b.dae\""), std::string::npos) << text;
  EXPECT_NE(text.find("filename=\"file:///m/c.dae\""), std::string::npos) << text;
  EXPECT_NE(text.find("filename=\"package://p/b.stl\""), std::string::npos);
  EXPECT_EQ(text.find("<box"), std::string::npos);
  EXPECT_LT(text.find("<sphere"), text.find("last"));  // where the old one was
  const SphereFormatFile read = read_robot_spheres(file("out/s.urdf"));
  EXPECT_EQ(difference(read.spheres.links, spheres.links), "");
  EXPECT_EQ(read.spheres.other_shapes, 1u);
  write_robot_spheres(spheres, SphereFormat::kUrdf, {.urdf = urdf}, file("here.urdf"));
  EXPECT_NE(read_file(file("here.urdf")).find("filename=\"m/a.dae\""), std::string::npos);
}

// A sphere of a link on a fixed joint that turns: the sphere read contains the sphere meant, whose
// centre an oracle of 50 digits knows.
TEST_F(SphereFormats, SpheresOnFixedJointsAreMovedOutward) {
  using Real = boost::multiprecision::cpp_bin_float_50;
  test::Random random(13);
  for (int round = 0; round < test::effort(5000, 300); ++round) {
    const double size = std::pow(10.0, random.between(-8, 8));
    const Sphere sphere{random.direction() * size * random.unit(), random.unit() * 0.01 * size};
    const Eigen::Vector3d angles = random.direction() * random.between(0, 8);
    const Eigen::Vector3d shift = random.direction() * size * random.unit();
    const Sphere moved = internal::moved_sphere(sphere, angles, shift);
    Real x = sphere.center.x(), y = sphere.center.y(), z = sphere.center.z();
    const auto turn = [](Real& a, Real& b, double angle) {
      const Real c = cos(Real(angle)), s = sin(Real(angle)), a_new = c * a - s * b;
      b = s * a + c * b;
      a = a_new;
    };
    turn(y, z, angles.x());
    turn(z, x, angles.y());
    turn(x, y, angles.z());
    const Real dx = x + shift.x() - moved.center.x(), dy = y + shift.y() - moved.center.y(),
               dz = z + shift.z() - moved.center.z();
    const Real off = sqrt(dx * dx + dy * dy + dz * dz);
    ASSERT_LE(off + sphere.radius, Real(moved.radius)) << round;
    ASSERT_LE(moved.radius - sphere.radius, 1e-13 * size) << round;
  }
}

TEST_F(SphereFormats, SpheresThatAreLinksBelongToTheParent) {
  const std::string text = R"(<robot name="r"><link name="a"><visual><geometry>
    <mesh filename="a.stl"/></geometry></visual></link><link name="b_sphere1"/>
    <link name="a_sphere1"><collision><geometry><sphere radius="0.5"/></geometry></collision></link>
    <link name="a_sphere2"><collision><origin xyz="1 0 0"/><geometry><sphere radius="0.25"/>
    </geometry></collision></link>
    <link name="a_spherex"><collision><geometry><sphere radius="7"/></geometry></collision></link>
    <joint name="1" type="fixed"><parent link="a"/><child link="a_sphere1"/>
    <origin xyz="1 2 3" rpy="1 1 1"/></joint>
    <joint name="2" type="fixed"><parent link="a"/><child link="a_sphere2"/>
    <origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/></joint>
    <joint name="3" type="fixed"><parent link="a"/><child link="a_spherex"/></joint></robot>)";
  const auto path = folder_.write("m.urdf", text);
  const RobotSpheres read = read_robot_spheres(path).spheres;
  ASSERT_EQ(read.links.size(), 3u);  // a, b_sphere1, a_spherex
  ASSERT_EQ(read.links[0].spheres.size(), 2u);
  EXPECT_EQ(read.links[0].spheres[0], (Sphere{{1, 2, 3}, 0.5}));  // exact
  const Sphere& turned = read.links[0].spheres[1];
  EXPECT_LT((turned.center - Eigen::Vector3d(0, 1, 1)).norm(), 1e-14);
  EXPECT_GT(turned.radius, 0.25);
  EXPECT_LT(turned.radius, 0.25 + 1e-13);
  EXPECT_EQ(read.links[2].link, "a_spherex");
  // Written, they are spheres of the link, and their links and joints are gone.
  RobotSpheres changed = read;
  changed.links.resize(1);
  write_robot_spheres(changed, SphereFormat::kUrdf, {.urdf = path}, file("w.urdf"));
  EXPECT_EQ(read_file(file("w.urdf")).find("a_sphere1"), std::string::npos);
  EXPECT_EQ(difference(read_robot_spheres(file("w.urdf")).spheres.links, read.links), "");
}

}  // namespace
}  // namespace spherule
