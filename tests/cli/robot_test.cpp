// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/urdf.h"
#include "robot/formats/sphere_formats.h"
#include "spheretree/check.h"
#include "spheretree/tree_file.h"
#include "tests/cli/command_test_support.h"
#include "tests/robot/cover/cover_oracle.h"
#include "tests/support/effort.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <signal.h>
#include <string>
#include <thread>
#include <variant>
#include <vector>

namespace spherule {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using SpheresOfLinks = std::map<std::string, std::vector<Sphere>>;

// A mesh in metres and a mirrored one in millimetres, a cylinder, a sphere, and a link with
// nothing.
constexpr const char* kRobot = R"(<?xml version="1.0"?>
<robot name="arm_1">
  <link name="base">
    <visual><geometry><box size="0.3 0.2 0.1"/></geometry></visual>
    <collision><geometry><mesh filename="package://parts/base.stl"/></geometry></collision>
  </link>
  <link name="upper arm">
    <collision><origin xyz="0 0.1 0.2" rpy="0.3 0 1"/>
      <geometry><cylinder radius="0.05" length="0.3"/></geometry></collision>
    <collision><origin xyz="0 0.1 0"/>
      <geometry><mesh filename="lug.stl" scale="0.001 -0.001 0.002"/></geometry></collision>
  </link>
  <link name="flange"/>
  <link name="finger">
    <collision><origin xyz="0.02 0 0"/><geometry><sphere radius="0.04"/></geometry></collision>
  </link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper arm"/>
    <origin xyz="0 0 0.1"/><axis xyz="0 0 1"/><limit lower="0.5" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="fix" type="fixed"><parent link="upper arm"/><child link="flange"/></joint>
  <joint name="grip" type="prismatic"><parent link="flange"/><child link="finger"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="0.1" effort="1" velocity="1"/></joint>
</robot>
)";

class RobotTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("arm.urdf", kRobot);
    fs::create_directory(folder_ / "parts");
    write_box("parts/base.stl", {0.3, 0.2, 0.1});
    write_box("lug.stl", {50, 40, 30});
  }

  // `spherule robot` with what makes it quick, and `more`.
  std::vector<std::string> command(const std::vector<std::string>& more,
                                   const char* proofs = "none") const {
    std::vector<std::string> line = {
        "robot", "arm.urdf",  "-o",          "out",        "--max-error", "0.06",     "--effort",
        "0",     "--package", "parts=parts", "--postures", "100",         "--proofs", proofs};
    line.insert(line.end(), more.begin(), more.end());
    return line;
  }

  std::vector<std::string> files_in(const std::string& folder) const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / folder)) {
      names.insert(entry.path().filename().string());
    }
    return {names.begin(), names.end()};
  }

  RobotSpheres read_back(const std::string& file) const {
    return read_robot_spheres(folder_ / "out" / file).spheres;
  }
};

// Links that have some.
SpheresOfLinks by_link(const RobotSpheres& spheres) {
  SpheresOfLinks result;
  for (const LinkSpheres& link : spheres.links) {
    if (!link.spheres.empty()) result[link.link] = link.spheres;
  }
  return result;
}

std::set<std::pair<std::string, std::string>> ignored(const RobotSpheres& spheres) {
  std::set<std::pair<std::string, std::string>> pairs;
  for (const DisabledPair& pair : spheres.self_collision_ignore) {
    pairs.insert(std::minmax(pair.link_a, pair.link_b));
  }
  return pairs;
}

void expect_covered(const std::vector<Sphere>& spheres, const Pose& pose,
                    const Primitive& primitive, test::Random& random) {
  for (int k = 0; k < 3000; ++k) {
    const test::WidePoint p = test::move(pose, test::point_of(primitive, random));
    test::Wide outside = 1;
    for (const Sphere& sphere : spheres) {
      outside = std::min(outside,
                         (p - sphere.center.cast<test::Wide>()).norm() - test::Wide(sphere.radius));
    }
    ASSERT_LE(outside, 0);
  }
}

TEST_F(RobotTest, WritesEveryFormatSoThatItReadsBack) {
  const Outcome result = run(command({}, "boxes"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // No progress bar: not a terminal.
  EXPECT_EQ(result.err,
            "spherule: warning: in the zero posture finger and base touch, by their meshes, too\n");
  EXPECT_EQ(files_in("out"),
            (std::vector<std::string>{"arm_1.base.tree", "arm_1.curobo.yml", "arm_1.finger.tree",
                                      "arm_1.foam.json", "arm_1.pairs", "arm_1.report.json",
                                      "arm_1.spheres.json", "arm_1.spheres.urdf", "arm_1.srdf",
                                      "arm_1.upper arm.tree", "arm_1.xrdf"}));

  const RobotSpheres spheres = read_back("arm_1.spheres.json");
  EXPECT_EQ(spheres.robot, "arm_1");
  const SpheresOfLinks links = by_link(spheres);
  ASSERT_EQ(links.size(), 3U);
  for (const char* file :
       {"arm_1.spheres.urdf", "arm_1.srdf", "arm_1.curobo.yml", "arm_1.xrdf", "arm_1.foam.json"}) {
    EXPECT_EQ(by_link(read_back(file)), links) << file;
  }
  const std::set<std::pair<std::string, std::string>> neighbours = {{"base", "upper arm"},
                                                                    {"finger", "upper arm"}};
  for (const char* file : {"arm_1.srdf", "arm_1.curobo.yml", "arm_1.xrdf"}) {
    EXPECT_EQ(ignored(read_back(file)), neighbours) << file;
  }
  for (const auto& [link, of_link] : links) {
    const SphereTree tree = load_tree(folder_ / "out" / ("arm_1." + link + ".tree"));
    EXPECT_TRUE(check(tree).valid);
    EXPECT_EQ(std::vector(tree.spheres().begin(), tree.spheres().end()), of_link);
  }

  // The spherized URDF is a robot: the same joints, spheres only.
  const RobotDescription robot = read_urdf(folder_ / "arm.urdf", {{{"parts", folder_ / "parts"}}});
  const RobotDescription spherized =
      read_urdf(folder_ / "out" / "arm_1.spheres.urdf", {{{"parts", folder_ / "parts"}}});
  ASSERT_EQ(spherized.links.size(), robot.links.size());
  EXPECT_EQ(spherized.model.variable_count(), 2);
  for (const LinkDescription& link : spherized.links) {
    const auto found = links.find(link.name);
    EXPECT_EQ(link.collision.size(), found == links.end() ? 0 : found->second.size()) << link.name;
  }

  // The exact primitives, and the exact meshes, which are boxes.
  test::Random random(1);
  const std::vector<LinkShape>& arm = robot.links[1].collision;
  expect_covered(links.at("upper arm"), arm[0].link_from_shape,
                 std::get<Primitive>(arm[0].geometry), random);
  expect_covered(links.at("upper arm"), Pose::from_translation({0.025, 0.08, 0.03}),
                 Box{{0.05, 0.04, 0.06}}, random);
  expect_covered(links.at("base"), Pose::from_translation({0.15, 0.1, 0.05}), Box{{0.3, 0.2, 0.1}},
                 random);
  expect_covered(links.at("finger"), Pose::from_translation({0.02, 0, 0}), SolidSphere{0.04},
                 random);
}

TEST_F(RobotTest, TellsInTableJsonAndReportWhatIsProved) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const Outcome table = run(command({"--format", "json"}));
  ASSERT_EQ(table.exit_code, 0) << table.err;
  EXPECT_EQ(files_in("out"), (std::vector<std::string>{"arm_1.report.json", "arm_1.spheres.json"}));
  EXPECT_NE(table.out.find("upper arm"), std::string::npos) << table.out;
  EXPECT_NE(table.out.find("flange     no collision geometry"), std::string::npos) << table.out;
  EXPECT_NE(table.out.find("total"), std::string::npos) << table.out;

  const std::string spheres = read("out/arm_1.spheres.json");
  const Outcome again = run(command({"--json", "--format", "json", "--threads", "1"}));
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read("out/arm_1.spheres.json"), spheres) << "equal bytes";
  const json summary = json::parse(again.out);
  EXPECT_EQ(summary.at("robot"), "arm_1");
  EXPECT_EQ(summary.at("geometry"), "collision");
  EXPECT_EQ(summary.at("total").at("covered"), true);
  EXPECT_EQ(summary.at("total").at("links"), 3);
  EXPECT_TRUE(summary.at("total").at("not_proved").empty());
  ASSERT_EQ(summary.at("links").size(), 4U);
  const SpheresOfLinks links = by_link(read_back("arm_1.spheres.json"));
  std::size_t count = 0;
  for (const json& link : summary.at("links")) {
    const auto found = links.find(link.at("link"));
    if (found == links.end()) {
      EXPECT_EQ(link.at("sphere_count"), 0);
      EXPECT_FALSE(link.contains("certificate"));
      continue;
    }
    EXPECT_EQ(link.at("sphere_count"), found->second.size());
    const json& certificate = link.at("certificate");
    EXPECT_EQ(certificate.at("covered"), true);
    EXPECT_EQ(certificate.at("uncovered_depth").at(1), 0.0);
    EXPECT_LE(certificate.at("protrusion_over_simplified_max"), 0.06 * (1 + 1e-9));
    EXPECT_EQ(link.at("options").at("min-external"), 0.24);
    count += found->second.size();
  }
  EXPECT_EQ(summary.at("total").at("sphere_count"), count);

  // The report has what judges of the simplification need.
  ASSERT_EQ(run(command({"--format", "json", "--external-spheres"})).exit_code, 0);
  const json report = read_json("out/arm_1.report.json");
  for (const json& link : report.at("links")) {
    if (link.at("sphere_count") == 0) continue;
    const json& solid = link.at("simplified_solid");
    EXPECT_EQ(solid.at("min_external_diameter"), 0.24);
    EXPECT_EQ(solid.at("external_spheres").size(), solid.at("external_sphere_count"));
  }
}

TEST_F(RobotTest, InterruptedSearchWritesWhatIsProvedOfEveryLink) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  for (int milliseconds = 500;; milliseconds *= 2) {
    ASSERT_LT(milliseconds, 100000);
    const pid_t process =
        start({"robot", "arm.urdf", "-o", "out", "--max-error", "0.015", "--effort", "1000000",
               "--package", "parts=parts", "--proofs", "none", "--format", "json"});
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    kill(process, SIGTERM);
    const Outcome outcome = finish(process);
    ASSERT_EQ(outcome.exit_code, -SIGTERM) << outcome.out << outcome.err;
    if (!exists("out/arm_1.report.json")) continue;  // no link was begun yet
    EXPECT_NE(outcome.err.find("spherule: interrupted: "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.out.find(" *\n"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("\n* interrupted: the search"), std::string::npos) << outcome.out;
    break;
  }
  const json report = read_json("out/arm_1.report.json");
  EXPECT_EQ(report.at("interrupted"), true);
  // The search of a simple link may be done before.
  std::size_t interrupted = 0;
  for (const json& link : report.at("links")) {
    interrupted += link.contains("interrupted") ? 1 : 0;
    EXPECT_TRUE(link.contains("certificate") || !link.contains("interrupted")) << link.at("link");
  }
  EXPECT_GT(interrupted, 0U);
  for (const char* file : {"out/arm_1.report.json", "out/arm_1.spheres.json"}) {
    const std::string told = run({"info", file}).out;
    EXPECT_NE(told.find("\ninterrupted: the search"), std::string::npos) << told;
  }
  EXPECT_EQ(report.at("total").at("covered"), true);
  EXPECT_EQ(report.at("total").at("links"), 3);
  EXPECT_EQ(run({"audit-robot", "arm.urdf", "out/arm_1.spheres.json", "--max-error", "0.015",
                 "--package", "parts=parts"})
                .exit_code,
            0);
}

TEST_F(RobotTest, WeldingShutsACrackInMillimetresOrMetres) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  std::string text = read("lug.stl");
  const std::string corner = "vertex 50 40 30";
  ASSERT_NE(text.find(corner), std::string::npos);
  text.replace(text.find(corner), corner.size(), "vertex 50.00001 40 30");
  write("lug.stl", text);
  const Outcome open = run(command({"--format", "json"}));
  EXPECT_EQ(open.exit_code, 0) << open.err;
  EXPECT_NE(open.err.find("link upper arm: its mesh is open"), std::string::npos) << open.err;
  EXPECT_NE(open.err.find("(--weld) shuts them"), std::string::npos) << open.err;
  const auto without = read_json("out/arm_1.report.json").at("links").at(1);
  EXPECT_TRUE(without.at("certificate").at("volume_ratio").is_null());

  const Outcome shut = run(command({"--format", "json", "--weld", "1e-7"}));
  EXPECT_EQ(shut.exit_code, 0) << shut.err;
  EXPECT_EQ(shut.err.find("its mesh is open"), std::string::npos) << shut.err;
  const auto welded = read_json("out/arm_1.report.json").at("links").at(1);
  EXPECT_TRUE(welded.at("certificate").at("volume_ratio").is_number());
  EXPECT_GE(welded.at("vertex_error"), 1e-8) << "the vertices moved";

  expect_refusal(command({"--weld", "-1"}), "--weld");
}

TEST_F(RobotTest, OptionsOfOneLinkAndOfAnSrdfCount) {
  write("arm.srdf", R"(<robot name="arm_1"><group name="hand"><link name="finger"/></group>
    <disable_collisions link1="finger" link2="base" reason="Never"/>
    <disable_collisions link1="finger" link2="tool of another" reason="Never"/></robot>)");
  const Outcome result =
      run(command({"--json", "--srdf", "arm.srdf", "--format", "srdf,curobo", "--tool-link",
                   "flange", "--link", "finger:max-error=0.03,min-external=0.06,padding=0.005"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json summary = json::parse(result.out);
  EXPECT_EQ(summary.at("links").at(0).at("options").at("max-error"), 0.06);
  const json& finger = summary.at("links").at(3);
  EXPECT_EQ(finger.at("link"), "finger");
  EXPECT_EQ(finger.at("options").at("max-error"), 0.03);
  EXPECT_EQ(finger.at("options").at("min-external"), 0.06);
  EXPECT_EQ(finger.at("options").at("padding"), 0.005);
  EXPECT_LE(finger.at("certificate").at("protrusion_over_simplified_max"), 0.03 * (1 + 1e-9));

  EXPECT_EQ(ignored(read_back("arm_1.curobo.yml")).count({"base", "finger"}), 1U);
  EXPECT_EQ(ignored(read_back("arm_1.curobo.yml")).size(), 3U);
  EXPECT_NE(read("out/arm_1.srdf").find("group name=\"hand\""), std::string::npos);
  EXPECT_NE(read("out/arm_1.curobo.yml").find("ee_link: flange"), std::string::npos)
      << read("out/arm_1.curobo.yml");
  EXPECT_FALSE(by_link(read_back("arm_1.srdf")).empty());
}

TEST_F(RobotTest, BadInputIsRefusedBeforeTheWork) {
  const auto refuse = [&](const std::vector<std::string>& more, const std::string& reason) {
    expect_refusal(command(more), reason);
  };
  expect_refusal({"robot", "none.urdf", "-o", "out"}, "none.urdf");
  expect_refusal({"robot", "arm.urdf", "-o", "out"}, "parts");
  expect_refusal({"robot", "arm.urdf", "-o", "out", "--package", "parts=parts", "--max-error", "0"},
                 "--max-error");
  expect_refusal({"robot", "arm.urdf", "-o", "no/where", "--package", "parts=parts"},
                 "no/where: no such folder");
  expect_refusal({"robot", "arm.urdf", "-o", "lug.stl", "--package", "parts=parts"},
                 "lug.stl: is not a folder");
  const std::string name(300, 'n');
  write("long.urdf", "<robot name=\"r\"><link name=\"" + name +
                         "\"><collision><geometry><box size=\"1 1 1\"/></geometry></collision>"
                         "</link></robot>");
  for (const char* folder : {"out", "."}) {
    expect_refusal({"robot", "long.urdf", "-o", folder, "--max-error", "0.001"},
                   name + ".tree: cannot be written: the name is too long");
  }
  refuse({"--padding", "-1"}, "--padding: must be finite");
  refuse({"--min-external", "nan"}, "--min-external: must be finite");
  refuse({"--geometry", "both"}, "--geometry");
  refuse({"--geometry", "visual", "--link", "finger:padding=1"}, "link 'finger': has options");
  refuse({"--format", "urdf,sdf"}, "--format");
  refuse({"--package", "parts"}, "--package: 'parts' is not NAME=DIR");
  refuse({"--package", "parts=."}, "--package: parts is given twice");
  refuse({"--link", "finger"}, "--link: 'finger' is not NAME:");
  refuse({"--link", "thumb:max-error=1"}, "link 'thumb': the robot has no such link");
  refuse({"--link", "flange:max-error=1"}, "link 'flange': has options and no geometry");
  refuse({"--link", "finger:max-error=x"}, "--link finger: 'x' is not a number");
  refuse({"--link", "finger:max-error=-1"}, "link 'finger' max error: must be positive");
  refuse({"--link", "finger:max-error"}, "'max-error' is not NAME=VALUE");
  refuse({"--link", "finger:radius=1"}, "'radius' is none of max-error");
  refuse({"--link", "finger:padding=-1"}, "--link finger: 'padding=-1': must be at least 0");
  refuse({"--link", "finger:padding=0,padding=0"}, "padding is given twice");
  refuse({"--link", "finger:zones=none.json"}, "none.json");
  refuse({"--tool-link", "thumb"}, "--tool-link: the robot has no link 'thumb'");
  refuse({"--srdf", "lug.stl"}, "lug.stl");
  write("other.yml", "robot_cfg: 3\n");
  refuse({"--curobo", "other.yml"}, "other.yml");
  refuse({"--xrdf", "none.xrdf"}, "none.xrdf");
  fs::remove(folder_ / "other.yml");
  refuse({"--seconds", "1"}, "--seconds");
  refuse({"--threads", "-1"}, "--threads");
  refuse({"--seed", "-1"}, "--seed");
  EXPECT_EQ(files(), (std::vector<std::string>{"arm.urdf", "long.urdf", "lug.stl", "parts"}));

  // In millimetres.
  write("big.urdf", R"(<robot name="big"><link name="base"><collision><geometry>
    <box size="300 200 100"/></geometry></collision></link></robot>)");
  expect_refusal({"robot", "big.urdf", "-o", "out"}, "millimetres");
  EXPECT_FALSE(exists("out"));
}

TEST_F(RobotTest, NothingThatIsReadIsOverwritten) {
  fs::rename(folder_ / "arm.urdf", folder_ / "arm_1.spheres.urdf");
  expect_refusal({"robot", "arm_1.spheres.urdf", "-o", ".", "--package", "parts=parts"},
                 "arm_1.spheres.urdf: is named twice");
  EXPECT_EQ(read("arm_1.spheres.urdf"), kRobot);
  const auto expect_kept = [&](const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> line = {"robot", "arm_1.spheres.urdf", "-o",
                                     "out",   "--package",          "parts=parts"};
    line.insert(line.end(), more.begin(), more.end());
    expect_refusal(line, file + ": is named twice");
  };
  expect_kept("poses.csv", {"--poses", "poses.csv", "--view", "poses.csv"});
  write("z.json", R"({"format":"spherule-zones","version":1,"zones":[
    {"shape":"ball","center":[0,0,0],"radius":0.1,"max_error":0.005}]})");
  expect_kept("./z.json", {"--link", "base:padding=0.01,zones=z.json", "--view", "./z.json"});
  fs::create_directory(folder_ / "out");
  expect_kept("out/arm_1.report.json", {"--view", "out/arm_1.report.json"});
}

}  // namespace
}  // namespace spherule
