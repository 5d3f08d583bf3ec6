// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/cli/view_scene.h"
#include "tests/support/effort.h"

#include <cmath>

namespace spherule {
namespace {

using nlohmann::json;

// A box that turns and one that slides, twice as far as a third follows.
constexpr const char* kArm = R"(<?xml version="1.0"?>
<robot name="arm">
  <link name="base">
    <visual><geometry><cylinder radius="0.2" length="0.4"/></geometry></visual>
    <collision><geometry><box size="0.4 0.4 0.2"/></geometry></collision>
  </link>
  <link name="boom"><collision><origin xyz="0.4 0 0"/>
    <geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
  <link name="left"/>
  <link name="right"/>
  <joint name="hip" type="revolute"><parent link="base"/><child link="boom"/>
    <origin xyz="0.1 0.2 0.3" rpy="0 0 1.5707963267948966"/><axis xyz="0 2 0"/>
    <limit lower="1" upper="2" effort="1" velocity="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="boom"/><child link="left"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="0.1" effort="1" velocity="1"/></joint>
  <joint name="follow" type="prismatic"><parent link="boom"/><child link="right"/>
    <axis xyz="1 0 0"/><limit lower="-0.05" upper="0" effort="1" velocity="1"/>
    <mimic joint="slide" multiplier="-0.5" offset="0.01"/></joint>
</robot>)";

class ViewRobotTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("arm.urdf", kArm);
    write("arm.yml",
          "collision_spheres:\n"
          "  base:\n  - center: [0, 0, 0]\n    radius: 0.31\n"
          "  boom:\n  - center: [0.4, 0, 0]\n    radius: 0.2\n");
  }
  json scene(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "view");
    arguments.insert(arguments.end(), {"-o", "page.html"});
    const Outcome view = run(arguments);
    EXPECT_EQ(view.exit_code, 0) << view.err;
    return scene_of(read("page.html"));
  }
};

TEST_F(ViewRobotTest, JointsAsTheFileSays) {
  const json robot = scene({"arm.urdf"}).at("robot");
  EXPECT_EQ(robot.at("name"), "arm");
  ASSERT_EQ(robot.at("links").size(), 4u);
  const json& joints = robot.at("joints");
  ASSERT_EQ(joints.size(), 3u);
  const json& hip = joints[0];
  EXPECT_EQ(hip.at("name"), "hip");
  EXPECT_EQ(hip.at("type"), "revolute");
  EXPECT_EQ(hip.at("axis"), json({0.0, 1.0, 0.0}));
  EXPECT_EQ(hip.at("lower"), 1.0);
  EXPECT_EQ(hip.at("upper"), 2.0);
  const std::vector<double> origin = hip.at("origin");
  const std::vector<double> expected = {0.1, 0.2, 0.3, 0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)};
  for (std::size_t i = 0; i < 7; ++i) EXPECT_NEAR(origin[i], expected[i], 1e-12) << i;
  EXPECT_EQ(robot.at("variables"), json({0, 1}));
  EXPECT_EQ(joints[2].at("variable"), 1);
  EXPECT_EQ(joints[2].at("multiplier"), -0.5);
  EXPECT_EQ(joints[2].at("offset"), 0.01);
  EXPECT_EQ(joints[1].at("multiplier"), 1.0);
  for (const json& link : robot.at("links")) {
    const int joint = link.at("joint");
    if (joint < 0) {
      EXPECT_EQ(link.at("name"), "base");
    } else {
      EXPECT_EQ(joints[static_cast<std::size_t>(joint)].at("parent"), joint == 0 ? 0 : 1);
    }
  }
}

TEST_F(ViewRobotTest, PosturesOfAFile) {
  write("path.csv", "slide,hip\n0.1,90\n\n0.05,60\n");
  const json postures =
      scene({"arm.urdf", "--poses", "path.csv", "--degrees"}).at("robot").at("postures");
  EXPECT_EQ(postures.at("lines"), json({2, 4}));
  const std::vector<float> positions = floats_of(postures.at("positions"));
  ASSERT_EQ(positions.size(), 4u);
  EXPECT_NEAR(positions[0], 1.5707963, 1e-6);
  EXPECT_NEAR(positions[1], 0.1, 1e-6);
  EXPECT_NEAR(positions[2], 1.0471976, 1e-6);
  write_box("box.stl", {1, 1, 1});
  expect_refusal({"view", "box.stl", "--poses", "path.csv", "-o", "box.html"}, "its URDF must be");
}

TEST_F(ViewRobotTest, MeshesAndSpheresHangOnTheirLinks) {
  const json items = scene({"arm.urdf", "arm.yml", "--geometry", "collision,visual"}).at("items");
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[0].at("name"), "collision geometry");
  ASSERT_EQ(items[0].at("parts").size(), 2u);
  EXPECT_EQ(items[0].at("parts")[1].at("link"), 1);
  EXPECT_EQ(items[0].at("shown"), true);
  // The far corner of the boom, in the frame of its link.
  const auto corners = floats_of(items[0].at("parts")[1].at("positions"));
  float furthest = 0.0F;
  for (std::size_t i = 0; i < corners.size(); i += 3) furthest = std::max(furthest, corners[i]);
  EXPECT_NEAR(furthest, 0.8F, 1e-6F);
  EXPECT_EQ(items[1].at("name"), "visual geometry");
  EXPECT_EQ(items[1].at("parts").size(), 1u);
  EXPECT_EQ(items[1].at("shown"), false);
  EXPECT_EQ(items[2].at("kind"), "tree");
  const json& boom = items[2].at("parts")[1];
  EXPECT_EQ(boom.at("link"), 1);
  EXPECT_EQ(floats_of(boom.at("levels").back()), (std::vector<float>{0.4F, 0.0F, 0.0F, 0.2F}));
}

TEST_F(ViewRobotTest, LeaksOfSamplesAndOfAnAudit) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  // From the sphere's centre to the corners of either box.
  const double base = std::sqrt(0.04 + 0.04 + 0.01) - 0.31;
  const double boom = std::sqrt(0.16 + 0.0025 + 0.0025) - 0.2;
  ASSERT_LT(base, 0.0);
  const Outcome audit = run({"audit-robot", "arm.urdf", "arm.yml", "--json"});
  ASSERT_EQ(audit.exit_code, 1) << audit.err;
  write("audit.json", audit.out);
  const json items = scene({"arm.urdf", "arm.yml", "audit.json", "--leaks"}).at("items");
  ASSERT_EQ(items.size(), 4u);
  for (const std::size_t item : {2u, 3u}) {
    EXPECT_EQ(items[item].at("kind"), "leaks");
    for (const json& part : items[item].at("parts")) {
      const auto leaks = floats_of(part.at("levels").at(0));
      if (part.at("link") == 0) {
        EXPECT_TRUE(leaks.empty());
      } else {
        ASSERT_GE(leaks.size(), 4u);
        EXPECT_NEAR(leaks[3], boom, item == 2 ? 0.001 : 1e-6);
      }
    }
  }
  EXPECT_EQ(items[2].at("facts"), "1 of 2 links not proved to be covered");
}

TEST_F(ViewRobotTest, AnAuditWritesItsPage) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const Outcome audit = run({"audit-robot", "arm.urdf", "arm.yml", "--view", "page.html"});
  EXPECT_EQ(audit.exit_code, 1) << audit.err;
  EXPECT_NE(audit.out.find("page: page.html ("), std::string::npos) << audit.out;
  const json items = scene_of(read("page.html")).at("items");
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[0].at("name"), "collision geometry");
  EXPECT_EQ(items[1].at("name"), "arm.yml");
  EXPECT_EQ(items[2].at("facts"), "1 of 2 links not proved to be covered");
  const std::vector<float> leaks = floats_of(items[2].at("parts").at(1).at("levels").at(0));
  ASSERT_GE(leaks.size(), 4u);
  // The deepest sample; the deepest point is a corner.
  const double deepest = std::sqrt(0.16 + 0.0025 + 0.0025) - 0.2;
  EXPECT_LE(leaks[3], deepest + 1e-6);
  EXPECT_GT(leaks[3], deepest - 2e-3);
  expect_refusal({"audit-robot", "arm.urdf", "arm.yml", "--view", "arm.yml"}, "arm.yml");
}

TEST_F(ViewRobotTest, ACoverWritesItsPage) {
  const Outcome cover = run({"robot", "arm.urdf", "-o", "out", "--max-error", "0.05", "--effort",
                             "0", "--view", "page.html"});
  EXPECT_EQ(cover.exit_code, 0) << cover.err;
  EXPECT_NE(cover.out.find("page: page.html ("), std::string::npos) << cover.out;
  const json items = scene_of(read("page.html")).at("items");
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[1].at("name"), "spheres of arm");
  EXPECT_EQ(items[1].at("parts").size(), 2u);
  EXPECT_EQ(items[2].at("facts"), "all links covered (proved)");
}

TEST_F(ViewRobotTest, LinksThatAreNotThereAreCounted) {
  write("more.yml",
        "collision_spheres:\n"
        "  boom:\n  - center: [0.4, 0, 0]\n    radius: 0.2\n"
        "  tool:\n  - center: [0, 0, 0]\n    radius: 0.2\n");
  const json items = scene({"arm.urdf", "more.yml", "--ignore-unknown-links"}).at("items");
  EXPECT_EQ(items.at(1).at("parts").size(), 1u);
  EXPECT_NE(items.at(1).at("facts").get<std::string>().find("1 link of the file left out"),
            std::string::npos);
}

TEST_F(ViewRobotTest, BadInput) {
  write("tool.yml", "collision_spheres:\n  tool:\n  - center: [0, 0, 0]\n    radius: 0.2\n");
  write("part.json", R"({"links": [{"link": "base", "certificate": {"covered": "yes"}}]})");
  expect_refusal({"view", "arm.yml", "-o", "page.html"}, "its URDF must be named too");
  expect_refusal(
      {"view", "arm.urdf", "tool.yml", "-o", "page.html"},
      "tool.yml: has spheres of 1 link that the robot has not got: 'tool', and of no other");
  expect_refusal({"view", "arm.urdf", "part.json", "-o", "page.html"}, "part.json: ");
  expect_refusal({"view", "arm.urdf", "--package", "here", "-o", "page.html"}, "--package");
  EXPECT_FALSE(exists("page.html"));
}

}  // namespace
}  // namespace spherule
