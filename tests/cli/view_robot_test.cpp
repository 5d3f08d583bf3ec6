// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/cli/robot_fixtures.h"
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
  json scene(const std::string& arguments) {
    expect_exit(0, "view " + arguments + " -o page.html");
    return scene_of(read("page.html"));
  }
};

TEST_F(ViewRobotTest, JointsAsTheFileSays) {
  const json robot = scene("arm.urdf").at("robot");
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
  const json postures = scene("arm.urdf --poses path.csv --degrees").at("robot").at("postures");
  EXPECT_EQ(postures.at("lines"), json({2, 4}));
  const std::vector<float> positions = floats_of(postures.at("positions"));
  ASSERT_EQ(positions.size(), 4u);
  EXPECT_NEAR(positions[0], 1.5707963, 1e-6);
  EXPECT_NEAR(positions[1], 0.1, 1e-6);
  EXPECT_NEAR(positions[2], 1.0471976, 1e-6);
  write_box("box.stl", {1, 1, 1});
  expect_refusal("view box.stl --poses path.csv -o box.html", "its URDF must be");
}

TEST_F(ViewRobotTest, MeshesAndSpheresHangOnTheirLinks) {
  const json items = scene("arm.urdf arm.yml --geometry collision,visual").at("items");
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
  const Outcome audit = expect_exit(1, "audit-robot arm.urdf arm.yml --json");
  write("audit.json", audit.out);
  const json items = scene("arm.urdf arm.yml audit.json --leaks").at("items");
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
  const Outcome audit = expect_exit(1, "audit-robot arm.urdf arm.yml --view page.html");
  EXPECT_TRUE(has(audit.out, "page: page.html ("));
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
  expect_refusal("audit-robot arm.urdf arm.yml --view arm.yml", "arm.yml");
}

TEST_F(ViewRobotTest, ACoverWritesItsPage) {
  expect_said(0, "robot arm.urdf -o out --max-error 0.05 --effort 0 --view page.html",
              "page: page.html (");
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
  const json items = scene("arm.urdf more.yml --ignore-unknown-links").at("items");
  EXPECT_EQ(items.at(1).at("parts").size(), 1u);
  EXPECT_TRUE(has(items.at(1).at("facts").get<std::string>(), "1 link of the file left out"));
}

TEST_F(ViewRobotTest, BadInput) {
  write("tool.yml", "collision_spheres:\n  tool:\n  - center: [0, 0, 0]\n    radius: 0.2\n");
  write("part.json", R"({"links": [{"link": "base", "certificate": {"covered": "yes"}}]})");
  expect_refusals(
      {{"view arm.yml -o page.html", "its URDF must be named too"},
       {{"view", "arm.urdf", "tool.yml", "-o", "page.html"},
        "tool.yml: has spheres of 1 link that the robot has not got: 'tool', and of no other"},
       {"view arm.urdf part.json -o page.html", "part.json: "},
       {"view arm.urdf --package here -o page.html", "--package"}});
  EXPECT_FALSE(exists("page.html"));
}

// What the page of `check --view` carries.

// The sphere and the wall of the fixture touch where the hand is so near.
constexpr double kReach = 0.0505;

class ViewCheckTest : public CheckTest {
 protected:
  json page_of(int exit_code, const std::string& more) {
    expect_said(exit_code, command(more + " --view page.html"), "page: page.html (");
    return scene_of(read("page.html"));
  }
};

TEST_F(ViewCheckTest, MotionsWithVerdictsContactsAndClearance) {
  write("path.csv", "-1 0\n\n-0.5 0.5\n0.5 0\n1 0\n");
  const json scene = page_of(1, "--edges");
  const json& trajectory = scene.at("trajectory");
  EXPECT_EQ(trajectory.at("motions"), true);
  EXPECT_EQ(trajectory.at("shortest"), false);
  EXPECT_EQ(trajectory.at("verdict"), "collision");
  EXPECT_EQ(trajectory.at("configurations"), 4);
  EXPECT_EQ(trajectory.at("shown"), 4);
  EXPECT_EQ(trajectory.at("verdicts"), "fcf");
  EXPECT_EQ(floats_of(trajectory.at("positions")),
            (std::vector<float>{-1, 0, -0.5F, 0.5F, 0.5F, 0, 1, 0}));
  const std::vector<float> clearance = floats_of(trajectory.at("clearance"));
  ASSERT_EQ(clearance.size(), 4u);
  for (const std::size_t i : {0u, 1u, 2u, 3u}) {
    const double exact = (i % 3 == 0 ? 1.0 : 0.5) - kReach;
    EXPECT_LE(static_cast<double>(clearance[i]), exact);
    EXPECT_NEAR(clearance[i], exact, 1e-6);
  }
  ASSERT_EQ(trajectory.at("points").size(), 1u);
  const json& point = trajectory.at("points")[0];
  const double fraction = point.at(3);
  EXPECT_NEAR(fraction, 0.5 - kReach, 2e-4);
  EXPECT_NEAR(point.at(0).get<double>(), 1.0 + fraction, 1e-6);
  EXPECT_EQ(point.at(1), 3);
  EXPECT_EQ(point.at(2), 4);
  EXPECT_NEAR(floats_of(point.at(4)).at(0), -0.5 + fraction, 1e-6);
  const std::vector<float> contact = floats_of(point.at(5));
  ASSERT_EQ(contact.size(), 12u);
  const json& bodies = trajectory.at("bodies");
  EXPECT_EQ(bodies.at(static_cast<std::size_t>(contact[0])), "hand");
  EXPECT_EQ(bodies.at(static_cast<std::size_t>(contact[1])), "wall");
  EXPECT_NEAR(contact[2], 0.0, 2e-4);
  EXPECT_NEAR(contact[3], 0.0, 1e-3);
  // The hand is link 1 and has one sphere; the wall is a solid.
  EXPECT_EQ(std::vector<float>(contact.begin() + 6, contact.end()),
            (std::vector<float>{1, 0, 0, -1, 0, -1}));
}

TEST_F(ViewCheckTest, ConfigurationsAndHowDeepTheyAre) {
  write("path.csv", "-1 0\n0.03 0\n1 0\n");
  const json scene = page_of(1, {});
  const json& trajectory = scene.at("trajectory");
  EXPECT_EQ(trajectory.at("motions"), false);
  EXPECT_EQ(trajectory.at("verdicts"), "fcf");
  EXPECT_EQ(floats_of(trajectory.at("clearance")).at(1), 0.0F);
  ASSERT_EQ(trajectory.at("points").size(), 1u);
  const json& point = trajectory.at("points")[0];
  EXPECT_EQ(point.at(0), 1);
  EXPECT_EQ(point.at(1), 2);
  EXPECT_TRUE(point.at(4).is_null());
  EXPECT_NEAR(floats_of(point.at(5)).at(2), kReach - 0.03, 1e-6);
}

TEST_F(ViewCheckTest, VerdictsObeyTheLimitsWhereTheseAreEnforced) {
  write("path.csv", "-1 0\n-2.5 0\n-1.5 0\n-1 0\n1 0\n");
  EXPECT_EQ(page_of(0, {}).at("trajectory").at("verdicts"), "fffff");
  EXPECT_EQ(page_of(1, "--enforce-limits").at("trajectory").at("verdicts"), "flfff");
  EXPECT_EQ(page_of(1, "--edges").at("trajectory").at("verdicts"), "fffc");
  EXPECT_EQ(page_of(1, "--edges --enforce-limits").at("trajectory").at("verdicts"), "llfc");
}

TEST_F(ViewCheckTest, ItsItemsAreTheRobotItsSpheresAndTheScene) {
  write("scan.xyz", "1 1 1\n1 1 2\n");
  write("cell.json", R"({"format": "spherule-scene", "version": 1,
    "robot": {"pose": {"position": [0, 0, 3]}},
    "obstacles": [
      {"name": "wall", "box": {"size": [0.5, 1, 1]}, "pose": {"position": [9, 0, 0]}},
      {"name": "ground", "half_space": {}},
      {"name": "scan", "points": {"file": "scan.xyz", "radius": 0.01}}]})");
  write("path.csv", "0 0\n");
  const json scene = page_of(0, {});
  EXPECT_EQ(scene.at("robot").at("pose"), json({0.0, 0.0, 3.0, 0.0, 0.0, 0.0, 1.0}));
  const json& items = scene.at("items");
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[0].at("checked"), true);
  EXPECT_EQ(floats_of(items[0].at("parts")[0].at("levels").back()),
            (std::vector<float>{0, 0, 0, 0.05F}));
  const json& solids = items[1].at("parts");
  ASSERT_EQ(solids.size(), 2u);
  EXPECT_EQ(solids[0].at("name"), "wall");
  EXPECT_EQ(floats_of(solids[0].at("positions")).size(), 24u);
  for (std::size_t i = 0; i < 24; i += 3) {
    EXPECT_NEAR(std::abs(floats_of(solids[0].at("positions"))[i] - 9.0F), 0.25F, 1e-6F);
  }
  // The square of the ground lies on its surface and reaches around the rest.
  EXPECT_EQ(solids[1].at("name"), "ground");
  EXPECT_EQ(solids[1].at("background"), true);
  const std::vector<float> ground = floats_of(solids[1].at("positions"));
  ASSERT_EQ(ground.size(), 12u);
  for (std::size_t i = 2; i < 12; i += 3) EXPECT_EQ(ground[i], 0.0F);
  EXPECT_LT(ground[0], 1.0F);
  EXPECT_GT(ground[3], 9.25F);
  EXPECT_EQ(items[2].at("parts")[0].at("name"), "scan");
  EXPECT_EQ(floats_of(items[2].at("parts")[0].at("levels")[0]).size(), 8u);
}

// Every third configuration is shown; of what lies between, the worst verdict and its contact.
TEST_F(ViewCheckTest, LongTrajectoriesAreThinnedOut) {
  std::string path;
  for (int i = 0; i <= 20000; ++i) path += i == 7 ? "0.03 0\n" : "1 0\n";
  write("path.csv", path);
  for (const bool edges : {false, true}) {
    const json trajectory = page_of(1, edges ? "--edges" : "").at("trajectory");
    EXPECT_EQ(trajectory.at("configurations"), 20001);
    EXPECT_EQ(trajectory.at("shown"), 6668);
    const std::string verdicts = trajectory.at("verdicts");
    EXPECT_EQ(verdicts.size(), edges ? 6667u : 6668u);
    EXPECT_EQ(verdicts.find('c'), 2u);
    EXPECT_EQ(verdicts.find_last_not_of('f'), 2u);
    ASSERT_EQ(trajectory.at("points").size(), 1u);
    const json& point = trajectory.at("points")[0];
    EXPECT_EQ(point.at(1), edges ? 7 : 8);
    const double at = point.at(0);
    EXPECT_NEAR(at, edges ? 2.0 + (0.95 / 0.97) / 3.0 : 2.0 + 1.0 / 3.0, edges ? 0.02 : 1e-6);
  }
  EXPECT_LT(read("page.html").size(), 2u << 20);
}

TEST_F(ViewCheckTest, TheShorterWayIsShown) {
  write("path.csv", "1 3\n1 -3\n");
  const json trajectory = page_of(0, "--edges --continuous shortest").at("trajectory");
  EXPECT_EQ(trajectory.at("shortest"), true);
  EXPECT_EQ(trajectory.at("verdicts"), "f");
}

TEST_F(ViewCheckTest, GoesWithJsonAndNotOverItsInput) {
  const Outcome outcome = run(command("--json --view page.html"));
  EXPECT_EQ(json::parse(outcome.out).at("verdict"), "free");
  EXPECT_TRUE(exists("page.html"));
  expect_refusal(command("--view path.csv"), "path.csv");
}

}  // namespace
}  // namespace spherule
