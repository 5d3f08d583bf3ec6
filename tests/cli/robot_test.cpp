// SPDX-License-Identifier: BSD-3-Clause
#include "robot/files/robot_description.h"
#include "robot/formats/sphere_formats.h"
#include "spheretree/sphere_tree.h"
#include "spheretree/tree_file.h"
#include "tests/cli/command_test_support.h"
#include "tests/cli/robot_fixtures.h"
#include "tests/robot/solid_oracle.h"
#include "tests/support/child_process.h"
#include "tests/support/effort.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <signal.h>
#include <variant>

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
  Words command(const Words& more, const char* proofs = "none") const {
    return joined({"robot", "arm.urdf", "-o", "out", "--max-error", "0.06", "--effort", "0",
                   "--package", "parts=parts", "--postures", "100", "--proofs", proofs},
                  more);
  }

  Words files_in(const std::string& folder) const {
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
    ASSERT_LE(outside, 1e-18L);
  }
}

TEST_F(RobotTest, WritesEveryFormatSoThatItReadsBack) {
  const Outcome result = expect_exit(0, command({}, "boxes"));
  // No progress bar: not a terminal.
  EXPECT_EQ(result.err,
            "spherule: warning: in the zero posture finger and base touch, by their meshes, too\n");
  EXPECT_EQ(files_in("out"),
            (Words{"arm_1.base.tree", "arm_1.curobo.yml", "arm_1.finger.tree", "arm_1.foam.json",
                   "arm_1.pairs", "arm_1.report.json", "arm_1.spheres.json", "arm_1.spheres.urdf",
                   "arm_1.srdf", "arm_1.upper arm.tree", "arm_1.xrdf"}));

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
  const Outcome table = expect_exit(0, command("--format json"));
  EXPECT_EQ(files_in("out"), (Words{"arm_1.report.json", "arm_1.spheres.json"}));
  EXPECT_TRUE(has(table.out, "upper arm"));
  EXPECT_TRUE(has(table.out, "flange     no collision geometry"));
  EXPECT_TRUE(has(table.out, "total"));

  const std::string spheres = read("out/arm_1.spheres.json");
  const json summary = expect_json(0, command("--format json --threads 1"));
  EXPECT_EQ(read("out/arm_1.spheres.json"), spheres) << "equal bytes";
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
  expect_exit(0, command("--format json --external-spheres"));
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
  const Outcome outcome = interrupted(
      "robot arm.urdf -o out --max-error 0.015 --effort 1000000 --package parts=parts --proofs "
      "none "
      "--format json",
      SIGTERM, "out/arm_1.report.json");
  EXPECT_TRUE(has(outcome.err, "spherule: interrupted: "));
  EXPECT_TRUE(has(outcome.out, " *\n"));
  EXPECT_TRUE(has(outcome.out, "\n* interrupted: the search"));
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
    EXPECT_TRUE(has(told, "\ninterrupted: the search"));
  }
  EXPECT_EQ(report.at("total").at("covered"), true);
  EXPECT_EQ(report.at("total").at("links"), 3);
  expect_exit(
      0, "audit-robot arm.urdf out/arm_1.spheres.json --max-error 0.015 --package parts=parts");
}

TEST_F(RobotTest, WeldingShutsACrackInMillimetresOrMetres) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  std::string text = read("lug.stl");
  const std::string corner = "vertex 50 40 30";
  ASSERT_TRUE(has(text, corner));
  text.replace(text.find(corner), corner.size(), "vertex 50.00001 40 30");
  write("lug.stl", text);
  const Outcome open = expect_exit(0, command("--format json"));
  EXPECT_TRUE(has(open.err, "link upper arm: its mesh is open"));
  EXPECT_TRUE(has(open.err, "(--weld) shuts them"));
  const auto without = read_json("out/arm_1.report.json").at("links").at(1);
  EXPECT_TRUE(without.at("certificate").at("volume_ratio").is_null());

  const Outcome shut = expect_exit(0, command("--format json --weld 1e-7"));
  EXPECT_FALSE(has(shut.err, "its mesh is open"));
  const auto welded = read_json("out/arm_1.report.json").at("links").at(1);
  EXPECT_TRUE(welded.at("certificate").at("volume_ratio").is_number());
  EXPECT_GE(welded.at("vertex_error"), 1e-8) << "the vertices moved";

  expect_refusal(command("--weld -1"), "--weld");
}

TEST_F(RobotTest, OptionsOfOneLinkAndOfAnSrdfCount) {
  write("arm.srdf", R"(<robot name="arm_1"><group name="hand"><link name="finger"/></group>
    <disable_collisions link1="finger" link2="base" reason="Never"/>
    <disable_collisions link1="finger" link2="tool of another" reason="Never"/></robot>)");
  const json summary =
      expect_json(0, command("--srdf arm.srdf --format srdf,curobo --tool-link flange --link "
                             "finger:max-error=0.03,min-external=0.06,padding=0.005"));
  EXPECT_EQ(summary.at("links").at(0).at("options").at("max-error"), 0.06);
  const json& finger = summary.at("links").at(3);
  EXPECT_EQ(finger.at("link"), "finger");
  EXPECT_EQ(finger.at("options").at("max-error"), 0.03);
  EXPECT_EQ(finger.at("options").at("min-external"), 0.06);
  EXPECT_EQ(finger.at("options").at("padding"), 0.005);
  EXPECT_LE(finger.at("certificate").at("protrusion_over_simplified_max"), 0.03 * (1 + 1e-9));

  EXPECT_EQ(ignored(read_back("arm_1.curobo.yml")).count({"base", "finger"}), 1U);
  EXPECT_EQ(ignored(read_back("arm_1.curobo.yml")).size(), 3U);
  EXPECT_TRUE(has(read("out/arm_1.srdf"), "group name=\"hand\""));
  EXPECT_TRUE(has(read("out/arm_1.curobo.yml"), "ee_link: flange"));
  EXPECT_FALSE(by_link(read_back("arm_1.srdf")).empty());
}

TEST_F(RobotTest, BadInputIsRefusedBeforeTheWork) {
  const std::string cover = "robot arm.urdf --package parts=parts -o ";
  const std::string name(300, 'n');
  const std::string box = "<collision><geometry><box size=\"300 200 100\"/></geometry></collision>";
  write("long.urdf", "<robot name=\"r\"><link name=\"" + name + "\">" + box + "</link></robot>");
  write("big.urdf", "<robot name=\"big\"><link name=\"base\">" + box + "</link></robot>");
  write("other.yml", "robot_cfg: 3\n");
  write("r.srdf", "<robot name=\"r\"/>");
  const std::vector<std::string> before = files();
  expect_refusals(
      {{"robot none.urdf -o out", "none.urdf"},
       {"robot big.urdf -o out", "millimetres"},
       {"robot long.urdf -o out --max-error 1", name + ".tree: cannot be written: the name is too"},
       {cover + "no/where", "no/where: no such folder"},
       {cover + "lug.stl", "lug.stl: is not a folder"},
       {cover + "out --max-error 0", "--max-error"},
       {cover + "out --max-error 20", "max error: 20 m is far more than any link is across"},
       {cover + "out --padding -1", "--padding: must be finite"},
       {cover + "out --min-external nan", "--min-external: must be finite"},
       {cover + "out --geometry both", "--geometry"},
       {cover + "out --geometry visual --link finger:padding=1", "link 'finger': has options"},
       {cover + "out --format urdf,sdf", "--format"},
       {cover + "out --format json,pairs --proofs none", "--format pairs: nothing is proved of"},
       {cover + "out --proofs some", "--proofs"},
       {cover + "out --package parts", "--package: 'parts' is not NAME=DIR"},
       {cover + "out --package parts=.", "--package: parts is given twice"},
       {cover + "out --link finger", "--link: 'finger' is not NAME:"},
       {cover + "out --link bsae:max-error=1", "the robot has no such link; did you mean base?"},
       {cover + "out --link flange:max-error=1", "link 'flange': has options and no geometry"},
       {cover + "out --link finger:max-error=x", "--link finger: 'x' is not a number"},
       {cover + "out --link finger:max-error=-1", "link 'finger' max error: must be positive"},
       {cover + "out --link finger:max-error", "'max-error' is not NAME=VALUE"},
       {cover + "out --link finger:radius=1", "'radius' is none of max-error"},
       {cover + "out --link finger:padding=-1", "'padding=-1': must be at least 0"},
       {cover + "out --link finger:padding=0,padding=0", "padding is given twice"},
       {cover + "out --link finger:zones=none.json", "none.json"},
       {cover + "out --tool-link thumb", "--tool-link: the robot has no link 'thumb'"},
       {cover + "out --srdf lug.stl", "lug.stl"},
       {cover + "out --curobo other.yml", "other.yml"},
       {cover + "out --xrdf none.xrdf", "none.xrdf"},
       {cover + "out --effort 0 --seconds 1", "--seconds"},
       {cover + "out --threads -1", "--threads"},
       {cover + "out --seed -1", "--seed"}});
  EXPECT_EQ(files(), before);
}

TEST_F(RobotTest, NothingThatIsReadIsOverwritten) {
  fs::rename(folder_ / "arm.urdf", folder_ / "arm_1.spheres.urdf");
  expect_refusal("robot arm_1.spheres.urdf -o . --package parts=parts",
                 "arm_1.spheres.urdf: is named twice");
  EXPECT_EQ(read("arm_1.spheres.urdf"), kRobot);
  const auto expect_kept = [&](const std::string& file, const Words& more) {
    expect_refusal(joined("robot arm_1.spheres.urdf -o out --package parts=parts", more),
                   file + ": is named twice");
  };
  expect_kept("poses.csv", "--poses poses.csv --view poses.csv");
  write("z.json", R"({"format":"spherule-zones","version":1,"zones":[
    {"shape":"ball","center":[0,0,0],"radius":0.1,"max_error":0.005}]})");
  expect_kept("./z.json", "--link base:padding=0.01,zones=z.json --view ./z.json");
  fs::create_directory(folder_ / "out");
  expect_kept("out/arm_1.report.json", "--view out/arm_1.report.json");
}

class RobotFalseAlarmsTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("gantry.urdf", gantry("0"));
  }

  static Words command(const Words& more) {
    return joined(
        "robot gantry.urdf -o out --effort 0 --format json --max-error 0.1 --postures 2000", more);
  }

  json alarms() const { return read_json("out/gantry.report.json")["false_alarms"]; }
};

TEST_F(RobotFalseAlarmsTest, MeasuresAndNamesThePair) {
  const Outcome result = expect_exit(0, command("--proofs none"));
  EXPECT_TRUE(has(result.out, "false alarms: "));
  EXPECT_TRUE(has(result.out, "block and tool: "));
  const json found = alarms();
  EXPECT_EQ(found["postures"], 2000);
  EXPECT_EQ(found["free"], 2000);
  EXPECT_EQ(found["proofs"], "none");
  EXPECT_GT(found["share"], 0.05);
  EXPECT_GT(found["share_upper_bound"], found["share"]);
  ASSERT_EQ(found["pairs"].size(), 1U);
  EXPECT_EQ(found["pairs"][0]["links"], (json{"block", "tool"}));
  EXPECT_EQ(found["pairs"][0]["refused"], found["refused"]);
  EXPECT_GT(found["pairs"][0]["median_gap"], 0.018);
  EXPECT_FALSE(found.contains("goal"));
}

TEST_F(RobotFalseAlarmsTest, ProofsSpareThePair) {
  const json found = expect_json(0, command({}))["false_alarms"];
  EXPECT_EQ(found["proofs"], "boxes");
  EXPECT_EQ(found["refused"], 0);
  EXPECT_EQ(found["share_with_proofs"]["never"], 0.0);
  EXPECT_GT(found["share_with_proofs"]["none"], 0.05);
}

TEST_F(RobotFalseAlarmsTest, ReachesAGoal) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  write("poses.csv", "turn, slide\n0, 0.3\n0.5, 0.4\n");
  expect_said(0, command("--proofs none --false-alarms 20% --poses poses.csv"),
              "goal 20.00 %: reached");
  const json report = read_json("out/gantry.report.json");
  const json& found = report["false_alarms"];
  EXPECT_EQ(found["postures"], 10000);  // of the verification
  EXPECT_LE(found["share_upper_bound"], 0.2);
  EXPECT_EQ(found["given"]["postures"], 2);
  EXPECT_EQ(found["given"]["refused"], 0);
  EXPECT_TRUE(found["goal"]["reached"]);
  EXPECT_EQ(found["goal"]["sphere_count"], report["total"]["sphere_count"]);
  EXPECT_EQ(found["goal"]["coarsest"]["max_error"], 0.1);
  EXPECT_LT(found["goal"]["coarsest"]["sphere_count"], found["goal"]["sphere_count"]);
  EXPECT_GT(found["goal"]["coarsest"]["share"], 0.2);
  ASSERT_EQ(found["goal"]["links"].size(), 2U);
  std::size_t spheres = 0;
  for (const LinkSpheres& link :
       read_robot_spheres(folder_ / "out/gantry.spheres.json").spheres.links) {
    spheres += link.spheres.size();
  }
  EXPECT_EQ(found["goal"]["sphere_count"], spheres);
  for (const json& link : report["links"]) {
    if (link["sphere_count"] == 0) continue;
    EXPECT_TRUE(link["certificate"]["covered"]);
    EXPECT_LE(link["options"]["max-error"], 0.1);
  }
}

TEST_F(RobotFalseAlarmsTest, AGoalThatIsNotShownFails) {
  const Outcome result = expect_exit(1, command("--false-alarms 0.0001"));
  EXPECT_TRUE(has(result.err, "false alarms"));
  EXPECT_TRUE(has(result.out, "--postures"));
  EXPECT_FALSE(alarms()["goal"]["reached"]);
}

TEST_F(RobotFalseAlarmsTest, RefusesBadInput) {
  for (const char* share : {"0", "1", "100%", "-1%", "few", "1%%", "%", "nan"}) {
    expect_refusal(command({"--false-alarms", share}), "share");
  }
  expect_refusals({{command("--proofs some"), "--proofs"},
                   {command("--postures 0"), "--postures"},
                   {command("--poses none.csv"), "none.csv"}});
  write("narrow.csv", "0.1\n");
  expect_refusal(command("--poses narrow.csv"), "line 1");
  write("empty.csv", "# nothing\n");
  expect_refusal(command("--poses empty.csv"), "empty.csv");
  write("post.urdf",
        R"(<robot name="post"><link name="post"><collision><geometry><box size="1 1 1"/></geometry>
           </collision></link></robot>)");
  expect_refusal("robot post.urdf -o out --false-alarms 1%", "no joint that moves");
  EXPECT_FALSE(exists("out"));
}

// Commands on a robot whose URDF the program xacro makes: a stand-in for it on the PATH.

class XacroCommand : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    environment_ = {"PATH=" + folder_.string() + ":" + std::getenv("PATH")};
    write("xacro", "#!/bin/sh\nsed -n 's/^made: //p' \"$1\"\n");
    fs::permissions(folder_ / "xacro", fs::perms::owner_all);
    // All its links are in what xacro makes.
    write("arm.urdf.xacro",
          "<robot name=\"raw\"><xacro:arm/>\nmade: <robot name=\"arm\"><link name=\"base\">" +
              box("collision", "1 0.01 0.01") + "</link></robot>\n</robot>\n");
  }
};

TEST_F(XacroCommand, TakesItAsTheUrdf) {
  const Outcome robot = expect_exit(0, "robot arm.urdf.xacro --max-error 0.2 --effort 0");
  const std::string urdf = read("arm-spheres/arm.spheres.urdf");
  EXPECT_TRUE(has(urdf, "<sphere radius"));
  EXPECT_FALSE(has(urdf, "xacro"));
  expect_said(0, "info arm.urdf.xacro", "arm");
  expect_exit(0, "view arm.urdf.xacro arm-spheres/arm.spheres.json -o arm.html");
  expect_exit(0, "audit-robot arm.urdf.xacro arm-spheres/arm.spheres.urdf");
}

// cuRobo cannot read the other.
TEST_F(XacroCommand, TheCuroboFileNamesTheUrdfThatIsWritten) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const Words cover = "robot arm.urdf.xacro --max-error 0.2 --effort 0";
  const auto run_with = [&](const Words& more) { return expect_exit(0, joined(cover, more)).err; };
  for (const Words& more : {Words{}, Words("--format curobo,urdf")}) {
    EXPECT_FALSE(has(run_with(more), "cuRobo"));
    const std::string file = read("arm-spheres/arm.curobo.yml");
    EXPECT_TRUE(has(file, "urdf_path: arm-spheres/arm.spheres.urdf\n"));
    EXPECT_TRUE(has(file, "asset_root_path: arm-spheres\n"));
    EXPECT_TRUE(exists("arm-spheres/arm.spheres.urdf"));
  }
  EXPECT_TRUE(has(run_with("-o alone --format curobo"),
                  "warning: urdf_path of the cuRobo file is arm.urdf.xacro, which cuRobo "
                  "cannot read"));
  EXPECT_TRUE(has(read("alone/arm.curobo.yml"), "urdf_path: arm.urdf.xacro\n"));
  // A file that is kept names what it named.
  write("mine.yml", read("alone/arm.curobo.yml"));
  EXPECT_FALSE(has(run_with("-o kept --format curobo --curobo mine.yml"), "cuRobo"));
}

// Some managers of services ignore the ends of their children, which is inherited.
TEST_F(XacroCommand, RunsWhereTheParentIgnoresTheEndsOfChildren) {
  const Outcome outcome = finish(start_process(
      "/usr/bin/env", {"--ignore-signal=CHLD", SPHERULE_COMMAND, "info", "arm.urdf.xacro"},
      {.folder = folder_, .out = ".out", .error = ".err", .environment = environment_}));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

}  // namespace
}  // namespace spherule
