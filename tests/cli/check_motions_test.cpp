// SPDX-License-Identifier: BSD-3-Clause
// `check` where it depends on what the numbers of a trajectory mean: which way continuous joints
// turn, the joint limits, and degrees.

#include "tests/cli/check_fixture.h"

#include <string>
#include <vector>

namespace spherule {
namespace {

using nlohmann::json;

// How often a text is there.
std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// A tool half a metre from the axis of the wrist, which turns without limits, and a post that
// stands where the wrist is at 0.
class CheckMotionsTest : public CheckTest {
 protected:
  void SetUp() override {
    CheckTest::SetUp();
    write("slider.json", R"({"wrist": {"centers": [[0.5, 0, 0]], "radii": [0.02]},
                             "hand": {"centers": [[0, 0, 0]], "radii": [0.05]}})");
    write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
      {"name": "post", "ball": {"radius": 0.05}, "pose": {"position": [0.5, 0, 0]}}]})");
    write("path.csv", "slide turn\n0 2\n0 3\n0 -3\n0 -2\n");
  }
  Outcome outcome_of(const std::vector<std::string>& more) { return run(command(more)); }
};

TEST_F(CheckMotionsTest, ContinuousJointsTurnAsGivenAndThatIsSaid) {
  const Outcome outcome = outcome_of({"--edges"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find("continuous joints turn as given"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("3-4 at 0.4"), std::string::npos) << outcome.out;
  EXPECT_EQ(count_of(outcome.err, "\n"), 1u) << outcome.err;
  EXPECT_NE(outcome.err.find("spherule: warning: path.csv: 1 motion turns a continuous joint by "
                             "more than half a turn, the first from line 3 to line 4: joint turn "
                             "by -6 rad"),
            std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("--continuous shortest"), std::string::npos) << outcome.err;
  const Outcome said = outcome_of({"--edges", "--continuous", "as-given"});
  EXPECT_EQ(said.out, outcome.out);
  EXPECT_EQ(said.err, outcome.err);
  const json report = checked(1, {"--edges"});
  EXPECT_EQ(report["continuous"], "as-given");
  EXPECT_EQ(report["more_than_half_a_turn"]["count"], 1);
  EXPECT_EQ(report["more_than_half_a_turn"]["first"]["step"], -6.0);
  EXPECT_EQ(report["more_than_half_a_turn"]["first"]["to_line"], 4);
  // Single configurations have no way.
  const Outcome none = outcome_of({});
  EXPECT_EQ(none.exit_code, 0);
  EXPECT_EQ(none.err, "");
  EXPECT_EQ(none.out.find("continuous"), std::string::npos) << none.out;
}

TEST_F(CheckMotionsTest, OrTheShorterWay) {
  const Outcome outcome = outcome_of({"--edges", "--continuous", "shortest"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("continuous joints turn the shorter way"), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("by -6 rad as given, here by 0.283185 rad"), std::string::npos)
      << outcome.out;
  // A post on the shorter way is found there, where it is.
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
    {"name": "post", "ball": {"radius": 0.03}, "pose": {"position": [-0.5, 0, 0]}}]})");
  EXPECT_EQ(checked(0, {"--edges"})["verdict"], "free");
  const json report = checked(1, {"--edges", "--continuous", "shortest"});
  EXPECT_EQ(report["continuous"], "shortest");
  EXPECT_EQ(report["first_contact"]["line"], 3);
  EXPECT_EQ(report["first_contact"]["first"]["name"], "wrist");
  EXPECT_NEAR(report["first_contact"]["point"][0].get<double>(), -0.5, 0.02);
  EXPECT_NEAR(report["first_contact"]["fraction"].get<double>(),
              (0.1415927 - 0.05 / 0.5) / 0.2831853, 0.01);
}

TEST_F(CheckMotionsTest, HalfATurnHasNoShorterWay) {
  write("path.csv", "0 0.5\n0 3.6416\n0 0.5\n");
  const Outcome outcome = outcome_of({"--edges", "--continuous", "shortest"});
  EXPECT_EQ(count_of(outcome.err, "\n"), 1u) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: path.csv: of 2 motions no way is clearly the shorter one"),
            std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("from line 1 to line 2: joint turn"), std::string::npos);
}

TEST_F(CheckMotionsTest, TheShorterWayIsRefusedWhereAFollowerForbidsIt) {
  write("geared.urdf", R"(<robot name="geared"><link name="base"/><link name="hand"/>
    <link name="wheel"/>
    <joint name="turn" type="continuous"><parent link="base"/><child link="hand"/>
      <axis xyz="0 0 1"/></joint>
    <joint name="gear" type="continuous"><parent link="base"/><child link="wheel"/>
      <axis xyz="0 0 1"/><mimic joint="turn" multiplier="0.5"/></joint></robot>)");
  write("path.csv", "3\n-3\n");
  write("slider.json", R"({"hand": {"centers": [[0, 0, 0]], "radii": [0.05]}})");
  std::vector<std::string> line = {"check",     "geared.urdf", "cell.json", "path.csv",
                                   "--spheres", "slider.json", "--edges"};
  EXPECT_EQ(run(line).exit_code, 0);
  line.insert(line.end(), {"--continuous", "shortest"});
  expect_refusal(line, "geared.urdf: joint gear: ");
  line.back() = "longest";
  expect_refusal(line, "longest");
}

// Positions of joints that mimic others count, and where the shorter way ends.
TEST_F(CheckMotionsTest, WhatCannotBeProvedIsNamedByItsLine) {
  write("path.csv", "slide turn\n0 99.9\n0 89.33\n0 1\n0 1\n0 1\n0 1\n0 1\n0 1\n0 1\n");
  EXPECT_EQ(outcome_of({"--edges"}).exit_code, 1);
  expect_refusal(command({"--edges", "--continuous", "shortest"}),
                 "path.csv: line 3: joint turn is at a position beyond 100");
  write("geared.urdf", R"(<robot name="geared"><link name="base"/><link name="hand"/>
    <link name="wheel"/>
    <joint name="turn" type="continuous"><parent link="base"/><child link="hand"/>
      <axis xyz="0 0 1"/></joint>
    <joint name="gear" type="continuous"><parent link="base"/><child link="wheel"/>
      <axis xyz="0 0 1"/><mimic joint="turn" multiplier="30"/></joint></robot>)");
  write("path.csv", "3\n4\n");
  write("slider.json", R"({"hand": {"centers": [[0, 0, 0]], "radii": [0.05]}})");
  expect_refusal(
      {"check", "geared.urdf", "cell.json", "path.csv", "--spheres", "slider.json", "--edges"},
      "path.csv: line 2: joint gear is at a position beyond 100");
}

TEST_F(CheckMotionsTest, WarnsOfJointLimitsOrEnforcesThem) {
  std::string path = "-1 0\n";
  for (int i = 0; i < 500; ++i) path += "-2.5 0\n";
  write("path.csv", path);
  const std::string text =
      "500 of 501 configurations are outside the joint limits, the first in line 2: joint slide at "
      "-2.5 m, 0.5 m below its lower limit of -2 m";
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, std::vector<std::string>{"--edges"}}) {
    const Outcome warned = outcome_of(more);
    EXPECT_EQ(warned.exit_code, 0) << warned.out;
    EXPECT_EQ(warned.err, "spherule: warning: path.csv: " + text + "\n");
    std::vector<std::string> enforced = more;
    enforced.push_back("--enforce-limits");
    const Outcome refused = outcome_of(enforced);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_TRUE(refused.out.starts_with("outside limits: 501 configurations")) << refused.out;
    EXPECT_NE(refused.out.find("\n" + text + "\n"), std::string::npos) << refused.out;
    const json report = checked(1, enforced);
    EXPECT_EQ(report["verdict"], "outside limits");
    EXPECT_EQ(report["colliding"], 0);
    EXPECT_EQ(report["limits"]["outside"], 500);
    EXPECT_EQ(report["limits"]["enforced"], true);
    EXPECT_EQ(report["limits"]["first"]["line"], 2);
    EXPECT_EQ(report["limits"]["first"]["joint"], "slide");
    EXPECT_EQ(report["limits"]["first"]["position"], -2.5);
    EXPECT_EQ(checked(0, more)["limits"]["enforced"], false);
  }
  write("path.csv", "2 0\n-2 3\n");
  EXPECT_EQ(outcome_of({"--enforce-limits"}).err, "");
  EXPECT_EQ(checked(0, {"--enforce-limits"})["limits"]["outside"], 0);
}

TEST_F(CheckMotionsTest, AContactOutsideTheLimitsIsAContact) {
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
    {"name": "post", "ball": {"radius": 0.05}, "pose": {"position": [3, 0, 0]}}]})");
  write("path.csv", "0 0\n3 0\n");
  const json report = checked(1, {"--edges", "--enforce-limits"});
  EXPECT_EQ(report["verdict"], "collision");
  EXPECT_EQ(report["limits"]["outside"], 1);
  EXPECT_NEAR(report["first_contact"]["fraction"].get<double>(), 2.43 / 3.0, 1e-3);
}

TEST_F(CheckMotionsTest, ReadsDegrees) {
  write("path.csv", "slide turn\n0 90\n0 180\n0 -180\n0 -90\n");
  const Outcome outcome = outcome_of({"--degrees"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(checked(1, {"--degrees", "--edges"})["first_contact"]["line"], 3);
  EXPECT_EQ(checked(0, {"--degrees", "--edges", "--continuous", "shortest"})["verdict"], "free");
  const Outcome warned = outcome_of({"--degrees", "--edges"});
  EXPECT_NE(warned.err.find("joint turn by -360 degrees"), std::string::npos) << warned.err;
  // Of 0.4 m nothing is turned.
  write("path.csv", "0.4 90\n0.46 90\n");
  EXPECT_EQ(checked(1, {"--degrees"})["first_contact"]["line"], 1);
}

TEST_F(CheckMotionsTest, LimitsAreToldInDegrees) {
  write("elbow.urdf", R"(<robot name="elbow"><link name="base"/><link name="hand"/>
    <joint name="bend" type="revolute"><parent link="base"/><child link="hand"/>
      <axis xyz="0 0 1"/><limit lower="-1" upper="1.5707963267948966" effort="1" velocity="1"/>
    </joint></robot>)");
  write("slider.json", R"({"hand": {"centers": [[0, 0, 0]], "radii": [0.05]}})");
  const std::vector<std::string> line = {"check",     "elbow.urdf",  "cell.json", "path.csv",
                                         "--spheres", "slider.json", "--degrees"};
  write("path.csv", "90\n-45\n");
  EXPECT_EQ(run(line).err, "");
  write("path.csv", "90\n135\n");
  EXPECT_NE(run(line).err.find("1 of 2 configurations is outside the joint limits, the first in "
                               "line 2: joint bend at 135 degrees, 45 degrees above its upper "
                               "limit of 90 degrees"),
            std::string::npos)
      << run(line).err;
}

TEST_F(CheckMotionsTest, SaysWhereAFileLooksLikeDegrees) {
  write("path.csv", "0 0\n0 45\n0.1 90\n0.1 180\n");
  const Outcome outcome = outcome_of({});
  EXPECT_EQ(count_of(outcome.err, "\n"), 1u) << outcome.err;
  EXPECT_NE(outcome.err.find("spherule: warning: path.csv: its angles look like degrees: as "
                             "radians 3 of 3"),
            std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("the first in line 2: joint turn at 45;"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(outcome_of({"--degrees"}).err, "");
  // It is said, too, where the numbers are too large to be proved.
  const Outcome refused = outcome_of({"--edges"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("look like degrees"), std::string::npos) << refused.err;
}

// What comes next is offered with the options that were given.
TEST_F(CheckMotionsTest, AdviceKeepsTheOptions) {
  const std::string cube =
      R"(<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>)";
  write("cubes.urdf", R"(<robot name="cubes"><link name="a">)" + cube +
                          R"(<link name="b"/><link name="c">)" + cube +
                          R"(<joint name="j" type="continuous"><parent link="a"/><child link="b"/>
      <axis xyz="1 0 0"/></joint>
    <joint name="k" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/>
      <limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>)");
  write("path.csv", "0 0.01\n10 0.01\n20 0.01\n");
  const std::string out =
      run({"check", "cubes.urdf", "cell.json", "path.csv", "--max-error", "0.04", "--effort", "0",
           "--edges", "--continuous", "shortest", "--degrees", "--enforce-limits"})
          .out;
  EXPECT_NE(out.find("path.csv --edges --continuous shortest --degrees --enforce-limits "
                     "--max-error 0.02 "),
            out.npos)
      << out;
}

}  // namespace
}  // namespace spherule
