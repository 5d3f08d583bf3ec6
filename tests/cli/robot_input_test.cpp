// SPDX-License-Identifier: BSD-3-Clause
// What commands make of robots, SRDFs and trajectories as people have them.
#include "tests/cli/command_test_support.h"
#include "tests/cli/robot_fixtures.h"

#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

using nlohmann::json;

std::string collision_box(const std::string& size) {
  return box("collision", size);
}

// A cage on the base, and a hand that two joints move in it.
const std::string kCaged = R"(<?xml version="1.0"?>
<robot name="caged">
  <link name="base"/>
  <link name="cage">)" + collision_box("0.2 0.2 0.2") +
                           R"(</link>
  <link name="arm"/>
  <link name="hand">)" + collision_box("0.1 0.1 0.1") +
                           R"(</link>
  <joint name="fix" type="fixed"><parent link="base"/><child link="cage"/></joint>
  <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="arm"/><child link="hand"/>
    <axis xyz="1 0 0"/><limit lower="0.01" upper="2" effort="1" velocity="1"/></joint>
</robot>
)";

class RobotInputTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("caged.urdf", kCaged);
    write("caged.json", R"({"cage": {"centers": [[0, 0, 0]], "radii": [0.2]},
                            "hand": {"centers": [[0, 0, 0]], "radii": [0.1]}})");
    write("cell.json", scene("", R"("robot": {"srdf": "caged.srdf"})"));
    write("empty.json", scene(""));
    write("path.csv", "turn,slide\n0,0.01\n");
  }

  void write_srdf(const std::string& elements) {
    write("caged.srdf", "<robot name=\"caged\">" + elements + "</robot>");
  }
  Words check(const std::string& more = "") {
    return joined("check caged.urdf cell.json path.csv --spheres caged.json", more);
  }
  // Of a robot of one joint, and the numbers of path.csv.
  void expect_free(const std::string& urdf, const std::string& more = "") {
    write("one.urdf", urdf);
    expect_exit(0, "check one.urdf empty.json path.csv --effort 0 --max-error 0.05 " + more);
  }
};

const std::string kDefault = R"(<disable_default_collisions link="cage"/>)";
const std::string kEnabled = R"(<enable_collisions link1="hand" link2="cage"/>)";
const std::string kDisabled = R"(<disable_collisions link1="cage" link2="hand" reason="User"/>)";

// As MoveIt makes its matrix of an SRDF.
TEST_F(RobotInputTest, ChecksPairsAsTheSrdfSays) {
  const std::vector<std::pair<std::string, int>> cases = {{"", 1},
                                                          {kDefault, 0},
                                                          {kDefault + kEnabled, 1},
                                                          {kEnabled + kDisabled, 0},
                                                          {kDefault + kEnabled + kDisabled, 0}};
  for (const auto& [elements, exit_code] : cases) {
    write_srdf(elements);
    EXPECT_EQ(expect_exit(exit_code, check()).err, "") << elements;
  }
  write_srdf(kDefault + "<wings/>");
  EXPECT_EQ(
      expect_exit(0, check()).err,
      "spherule: warning: caged.srdf: line 1: <wings>: it is not known there and is ignored\n");
}

TEST_F(RobotInputTest, KeepsTheDefaultsOfAnSrdfInAllFormats) {
  write_srdf(kDefault);
  const std::string cover =
      "robot caged.urdf -o out --effort 0 --max-error 0.05 --postures 100 --srdf caged.srdf";
  EXPECT_EQ(expect_exit(0, cover).err, "");
  EXPECT_TRUE(has(read("out/caged.curobo.yml"), "cage: [hand]"));
  EXPECT_TRUE(has(read("out/caged.xrdf"), "cage: [hand]"));
  const std::string kept = read("out/caged.srdf");
  EXPECT_TRUE(has(kept, R"(<disable_default_collisions link="cage"/>)"));
  EXPECT_FALSE(has(kept, "<disable_collisions"));
  expect_exit(0, "check caged.urdf empty.json path.csv --spheres out/caged.srdf");
  const json judged = expect_json(0, "check-srdf caged.urdf caged.srdf --json");
  ASSERT_EQ(judged["pairs"].size(), 1U);
  EXPECT_EQ(judged["pairs"][0]["reason"], "disable_default_collisions");
  EXPECT_EQ(judged["pairs"][0]["verdict"], "touches");
  const json audited =
      expect_json(0, "audit-robot caged.urdf out/caged.spheres.json --srdf caged.srdf --json");
  EXPECT_EQ(audited["pairs"][0]["kind"], "given");
  expect_said(0, "info caged.srdf", "links disabled by default: 1");

  write_srdf(kDefault + kEnabled);
  expect_exit(0, cover);
  EXPECT_FALSE(has(read("out/caged.curobo.yml"), "cage: [hand]"));
  expect_exit(1, "check caged.urdf empty.json path.csv --spheres out/caged.srdf");
}

std::string one_joint(const std::string& type, const std::string& in_joint) {
  return "<robot name=\"one\"><link name=\"base\"/><link name=\"hand\">" +
         collision_box("0.1 0.1 0.1") + "</link>\n<joint name=\"pan\" type=\"" + type +
         R"("><parent link="base"/><child link="hand"/>)" + in_joint + "</joint></robot>";
}

TEST_F(RobotInputTest, LimitsAreNeededOnlyWhereTheyAreUsed) {
  const std::string reversed =
      one_joint("revolute", R"(<limit lower="2.7" upper="-2.7" effort="1" velocity="1"/>)");
  const std::string warning =
      "spherule: warning: one.urdf: line 2: joint 'pan': <joint>: its limits are reversed: 2.7 and "
      "-2.7: it is read as a joint without limits\n";
  write("one.urdf", reversed);
  write("path.csv", "pan\n3\n");
  const Outcome info = expect_exit(0, "info one.urdf");
  EXPECT_EQ(info.err, warning);
  EXPECT_TRUE(has(info.out, "pan: no limits"));
  EXPECT_EQ(expect_exit(0, "robot one.urdf -o out --effort 0 --max-error 0.05").err, warning);
  EXPECT_TRUE(exists("out/one.curobo.yml"));
  expect_free(reversed);
  expect_exit(0, "view one.urdf -o one.html");
  const std::string reason =
      ": joint pan: it has no limits, which are needed here: correct its <limit> in the URDF\n";
  EXPECT_EQ(expect_exit(2, "check one.urdf empty.json path.csv --enforce-limits").err,
            warning + "spherule: --enforce-limits" + reason);
  EXPECT_EQ(expect_exit(2, "robot one.urdf -o out --false-alarms 1%").err,
            warning + "spherule: --false-alarms" + reason);
}

TEST_F(RobotInputTest, PlanarJointsMoveInTheirPlane) {
  write("path.csv", "pan/x,pan/y,pan/theta\n1,2,0\n");
  expect_free(one_joint("planar", R"(<axis xyz="0 0 1"/>)"));
  write("empty.json", scene(ball("post", "0.01", "1, 2, 0")));
  expect_exit(1, "check one.urdf empty.json path.csv --effort 0 --max-error 0.05");
  write("path.csv", "pan/x,pan/y,pan/theta\n1,2.2,0\n");
  expect_exit(0, "check one.urdf empty.json path.csv --effort 0 --max-error 0.05");
  expect_exit(0, "robot one.urdf -o out --effort 0 --max-error 0.05");
  EXPECT_FALSE(has(read("out/one.srdf"), "pan/x"));
}

// All that is read is refused before the robot is covered, which would be refused, too.
TEST_F(RobotInputTest, RefusesBadFilesBeforeItCovers) {
  write("cloud.xyz", "0 0 0\n1 2\n");
  write("broken.stl", "solid s\nfacet\n");
  const std::string check = "check caged.urdf cell.json path.csv --max-error 1e-6";
  expect_refusal("check caged.urdf empty.json path.csv --max-error 1e-6", "caged.urdf: link ");
  const std::vector<std::pair<std::string, std::string>> scenes = {
      {R"({"name": "scan", "points": {"file": "cloud.xyz", "radius": 0.1}})", "cloud.xyz"},
      {R"({"name": "part", "mesh": {"file": "broken.stl"}})", "broken.stl"},
      {R"({"name": "part", "tree": {"file": "broken.stl"}})", "broken.stl"},
      {R"({"name": "part", "spheres": {"file": "broken.stl"}})", "broken.stl"},
      {R"({"name": "part", "mesh": {"file": "gone.stl"}})", "gone.stl"}};
  for (const auto& [obstacle, file] : scenes) {
    write("cell.json", scene(obstacle));
    expect_refusal(check, file);
  }
  write("cell.json", scene(""));
  write("path.csv", "turn,slide\n0,x\n");
  expect_refusal(check, "path.csv: line 2");
  const std::string audit =
      "audit-robot caged.urdf caged.json --min-external 1e-6 --max-error 1e-6 ";
  write("bad.srdf", "<robot/>");
  expect_refusals(
      {{audit + "--srdf bad.srdf", "bad.srdf"},
       {audit + "--pairs broken.stl", "broken.stl"},
       {"robot caged.urdf -o out --false-alarms 1% --link nobody:max-error=0.01", "nobody"}});
}

TEST_F(RobotInputTest, JointsThatTheTrajectoryLeavesOutStay) {
  write_srdf(R"(<group name="all"><joint name="slide"/></group>
    <group_state name="out" group="all"><joint name="slide" value="1"/></group_state>)");
  write("path.csv", "turn\n0\n");
  EXPECT_EQ(expect_exit(1, check()).err,
            "spherule: warning: path.csv: it leaves out joints, which stay where they are nearest "
            "to zero: slide at 0.01 m; --at NAME=POSITION, or --at and a state of the SRDF, says "
            "where\n");
  for (const char* const at : {"--at slide=1", "--at out", "--at all/out"}) {
    EXPECT_EQ(expect_exit(0, check(at)).err, "") << at;
  }
  EXPECT_EQ(expect_exit(1, check("--at out --at slide=0.02")).err, "");
  expect_refusals(
      {{check("--at slied=1"), "--at slied=1: the robot has no such joint; did you"},
       {check("--at slide=x"), "the position is no finite number"},
       {check("--at slide=1 --at slide=2"), "the joint is given twice"},
       {check("--at fix=1"), "the joint is fixed"},
       {check("--at turn=1"), "--at turn: path.csv has positions of this joint"},
       {check("--at in"), "caged.srdf has no such state; it has all/out"},
       {"check caged.urdf empty.json path.csv --spheres caged.json --at out", "no SRDF is given"}});
  write("path.csv", "slide\n0.5\n");
  expect_exit(0, check("--at turn=30 --degrees"));
}

TEST_F(RobotInputTest, WarnsOfNumbersWhoseOrderIsNotThatOfTheUrdf) {
  const std::string joint = R"(" type="continuous"><parent link=")";
  const auto to = [](const std::string& link) {
    return "\"/><child link=\"" + link + "\"/></joint>";
  };
  write("three.urdf",
        "<robot name=\"three\"><link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>"
        "<link name=\"d\"/><joint name=\"j1" +
            joint + "a" + to("b") + "<joint name=\"j2" + joint + "a" + to("c") +
            "<joint name=\"j3" + joint + "b" + to("d") + "</robot>");
  write("three.json", R"({"d": {"centers": [[0, 0, 0]], "radii": [0.1]}})");
  write("path.csv", "0 1 2\n");
  const std::string command = "check three.urdf empty.json path.csv --spheres three.json";
  EXPECT_EQ(
      expect_exit(0, command).err,
      "spherule: warning: path.csv: no line names the joints: the numbers of a line are taken "
      "for j1, j3, j2, depth first, while the URDF has j1, j2, j3; a first line of names "
      "would settle it\n");
  write("path.csv", "j1 j2 j3\n0 1 2\n");
  EXPECT_EQ(expect_exit(0, command).err, "");
}

// A zero byte ends no message, and what is wrong with spheres is not the fault of the URDF.
TEST_F(RobotInputTest, NamesTheFileAtFault) {
  write("cell.json", scene("", R"("padding": [{"body": "ha\u0000nd", "distance": 0.1}])"));
  expect_refusal(check(), "cell.json: ha\\x00nd: there is no link");
  write("caged.json", R"({"hand": {"centers": [[1e200, 0, 0]], "radii": [0.1]}})");
  expect_refusal("audit-robot caged.urdf caged.json", "caged.json: ");
}

}  // namespace
}  // namespace spherule
