// SPDX-License-Identifier: BSD-3-Clause
// `check` where it depends on what the numbers of a trajectory mean: which way continuous joints
// turn, the joint limits, and degrees.
#include "tests/cli/command_test_support.h"
#include "tests/cli/robot_fixtures.h"
#include "tests/support/effort.h"

#include <algorithm>

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
    write("cell.json", scene(ball("post", "0.05", "0.5, 0, 0")));
    write("path.csv", "slide turn\n0 2\n0 3\n0 -3\n0 -2\n");
  }
  Outcome outcome_of(const Words& more) { return run(command(more)); }

  // A wheel that follows the one joint of a hand.
  void write_geared(const std::string& multiplier) {
    write("geared.urdf", R"(<robot name="geared"><link name="base"/><link name="hand"/>
      <link name="wheel"/>
      <joint name="turn" type="continuous"><parent link="base"/><child link="hand"/>
        <axis xyz="0 0 1"/></joint>
      <joint name="gear" type="continuous"><parent link="base"/><child link="wheel"/>
        <axis xyz="0 0 1"/><mimic joint="turn" multiplier=")" +
                             multiplier + R"("/></joint></robot>)");
    write("slider.json", R"({"hand": {"centers": [[0, 0, 0]], "radii": [0.05]}})");
  }
};

TEST_F(CheckMotionsTest, ContinuousJointsTurnAsGivenAndThatIsSaid) {
  const Outcome outcome = outcome_of("--edges");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(has(outcome.out, "continuous joints turn as given"));
  EXPECT_TRUE(has(outcome.out, "3-4 at 0.4"));
  EXPECT_EQ(count_of(outcome.err, "\n"), 1u) << outcome.err;
  EXPECT_TRUE(has(outcome.err,
                  "spherule: warning: path.csv: 1 motion turns a continuous joint by "
                  "more than half a turn, the first from line 3 to line 4: joint turn "
                  "by -6 rad"));
  EXPECT_TRUE(has(outcome.err, "--continuous shortest"));
  const Outcome said = outcome_of("--edges --continuous as-given");
  EXPECT_EQ(said.out, outcome.out);
  EXPECT_EQ(said.err, outcome.err);
  const json report = checked(1, "--edges");
  EXPECT_EQ(report["continuous"], "as-given");
  EXPECT_EQ(report["more_than_half_a_turn"]["count"], 1);
  EXPECT_EQ(report["more_than_half_a_turn"]["first"]["step"], -6.0);
  EXPECT_EQ(report["more_than_half_a_turn"]["first"]["to_line"], 4);
  // Single configurations have no way.
  const Outcome none = outcome_of({});
  EXPECT_EQ(none.exit_code, 0);
  EXPECT_EQ(none.err, "");
  EXPECT_FALSE(has(none.out, "continuous"));
}

TEST_F(CheckMotionsTest, OrTheShorterWay) {
  const Outcome outcome = outcome_of("--edges --continuous shortest");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(has(outcome.out, "continuous joints turn the shorter way"));
  EXPECT_TRUE(has(outcome.out, "by -6 rad as given, here by 0.283185 rad"));
  // A post on the shorter way is found there, where it is.
  write("cell.json", scene(ball("post", "0.03", "-0.5, 0, 0")));
  EXPECT_EQ(checked(0, "--edges")["verdict"], "free");
  const json report = checked(1, "--edges --continuous shortest");
  EXPECT_EQ(report["continuous"], "shortest");
  EXPECT_EQ(report["first_contact"]["line"], 3);
  EXPECT_EQ(report["first_contact"]["first"]["name"], "wrist");
  EXPECT_NEAR(report["first_contact"]["point"][0].get<double>(), -0.5, 0.02);
  EXPECT_NEAR(report["first_contact"]["fraction"].get<double>(),
              (0.1415927 - 0.05 / 0.5) / 0.2831853, 0.01);
}

TEST_F(CheckMotionsTest, HalfATurnHasNoShorterWay) {
  write("path.csv", "0 0.5\n0 3.6416\n0 0.5\n");
  const Outcome outcome = outcome_of("--edges --continuous shortest");
  EXPECT_EQ(count_of(outcome.err, "\n"), 1u) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "of 2 motions no way is clearly the shorter one"));
  EXPECT_TRUE(has(outcome.err, "from line 1 to line 2: joint turn"));
}

TEST_F(CheckMotionsTest, TheShorterWayIsRefusedWhereAFollowerForbidsIt) {
  write_geared("0.5");
  write("path.csv", "3\n-3\n");
  const std::string line = "check geared.urdf cell.json path.csv --spheres slider.json --edges";
  expect_exit(0, line);
  expect_refusal(line + " --continuous shortest", "geared.urdf: joint gear: ");
  expect_refusal(line + " --continuous longest", "longest");
}

// Positions of joints that mimic others count, and where the shorter way ends.
TEST_F(CheckMotionsTest, WhatCannotBeProvedIsNamedByItsLine) {
  write("path.csv", "slide turn\n0 99.9\n0 89.33\n0 1\n0 1\n0 1\n0 1\n0 1\n0 1\n0 1\n");
  EXPECT_EQ(outcome_of("--edges").exit_code, 1);
  expect_refusal(command("--edges --continuous shortest"),
                 "path.csv: line 3: joint turn is at a position beyond 100");
  write_geared("30");
  write("path.csv", "3\n4\n");
  expect_refusal("check geared.urdf cell.json path.csv --spheres slider.json --edges",
                 "path.csv: line 2: joint gear is at a position beyond 100");
}

TEST_F(CheckMotionsTest, WarnsOfJointLimitsOrEnforcesThem) {
  std::string path = "-1 0\n";
  for (int i = 0; i < 500; ++i) path += "-2.5 0\n";
  write("path.csv", path);
  const std::string text =
      "500 of 501 configurations are outside the joint limits, the first in line 2: joint slide at "
      "-2.5 m, 0.5 m below its lower limit of -2 m";
  for (const Words& more : {Words{}, Words{"--edges"}}) {
    const Outcome warned = outcome_of(more);
    EXPECT_EQ(warned.exit_code, 0) << warned.out;
    EXPECT_EQ(warned.err, "spherule: warning: path.csv: " + text + "\n");
    Words enforced = more;
    enforced.push_back("--enforce-limits");
    const Outcome refused = outcome_of(enforced);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_TRUE(refused.out.starts_with("outside limits: 501 configurations")) << refused.out;
    EXPECT_TRUE(has(refused.out, "\n" + text + "\n"));
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
  EXPECT_EQ(outcome_of("--enforce-limits").err, "");
  EXPECT_EQ(checked(0, "--enforce-limits")["limits"]["outside"], 0);
}

TEST_F(CheckMotionsTest, AContactOutsideTheLimitsIsAContact) {
  write("cell.json", scene(ball("post", "0.05", "3, 0, 0")));
  write("path.csv", "0 0\n3 0\n");
  const json report = checked(1, "--edges --enforce-limits");
  EXPECT_EQ(report["verdict"], "collision");
  EXPECT_EQ(report["limits"]["outside"], 1);
  EXPECT_NEAR(report["first_contact"]["fraction"].get<double>(), 2.43 / 3.0, 1e-3);
}

TEST_F(CheckMotionsTest, ReadsDegrees) {
  write("path.csv", "slide turn\n0 90\n0 180\n0 -180\n0 -90\n");
  const Outcome outcome = outcome_of("--degrees");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(checked(1, "--degrees --edges")["first_contact"]["line"], 3);
  EXPECT_EQ(checked(0, "--degrees --edges --continuous shortest")["verdict"], "free");
  const Outcome warned = outcome_of("--degrees --edges");
  EXPECT_TRUE(has(warned.err, "joint turn by -360 degrees"));
  // Of 0.4 m nothing is turned.
  write("path.csv", "0.4 90\n0.46 90\n");
  EXPECT_EQ(checked(1, "--degrees")["first_contact"]["line"], 1);
}

// --shard: the reports of all parts, put together, are that of the whole.

class ShardTest : public CheckTest {
 protected:
  void SetUp() override {
    CheckTest::SetUp();
    // Across the wall, beyond the limits, and past a post so close that it is not proved.
    write("cell.json",
          scene(std::string(kWall) + "," + ball("post", "0.1", "1.47, 0.150000001, 0")));
    write("path.csv",
          "-1 0\n-0.5 1\n0.5 1\n# a line that is passed over\n0.02 1\n0.7 0\n2.5 0\n2.6 0\n1 "
          "0\n1.8 0\n1 0\n"
          "-0.0506 0\n-0.0506 1\n-0.0506 0.5\n-1 0\n0.04 0\n-0.03 0\n-2 0\n-2.1 0\n-0.0506 1\n");
  }
};

// As another process would see it: without what is told of the whole trajectory.
json without_turns(json report) {
  report.erase("continuous");
  report.erase("more_than_half_a_turn");
  return report;
}

// The first contacts of a pair are in the first part that has it, the worst ones in the deepest.
void merge_pairs(const json& part, json& all) {
  for (const json& pair : part) {
    const auto known = std::find_if(all.begin(), all.end(), [&](const json& other) {
      return other["first"] == pair["first"] && other["second"] == pair["second"];
    });
    if (known == all.end()) {
      all.push_back(pair);
      continue;
    }
    (*known)["count"] = known->at("count").get<int>() + pair["count"].get<int>();
    if (pair["worst_contact"]["depth"] > known->at("worst_contact")["depth"]) {
      (*known)["worst_contact"] = pair["worst_contact"];
    }
  }
}

json merged(const std::vector<json>& parts) {
  json all = parts.front();
  all.erase("shard");
  for (std::size_t i = 1; i < parts.size(); ++i) {
    for (const char* count : {"configurations", "motions", "colliding"}) {
      if (all.contains(count)) all[count] = all[count].get<int>() + parts[i].at(count).get<int>();
    }
    json& limits = all["limits"];
    const json& more = parts[i].at("limits");
    limits["outside"] = limits["outside"].get<int>() + more.at("outside").get<int>();
    if (limits["first"].is_null()) limits["first"] = more.at("first");
    merge_pairs(parts[i].at("pairs"), all["pairs"]);
    for (const json& point : parts[i].at("not_proved")) all["not_proved"].push_back(point);
    for (const char* contact : {"first_contact", "worst_contact"}) {
      if (all[contact].is_null() ||
          (contact == std::string("worst_contact") && parts[i][contact].is_object() &&
           parts[i][contact]["depth"] > all[contact]["depth"])) {
        all[contact] = parts[i][contact];
      }
    }
    for (const char* verdict : {"not proved", "collision"}) {
      if (parts[i]["verdict"] == verdict) all["verdict"] = verdict;
    }
  }
  return all;
}

TEST_F(ShardTest, ReportsTogetherAreThatOfTheWhole) {
  const std::vector<Words> ways = {
      {}, "--edges --resolution 0.01", "--edges --continuous shortest"};
  for (const Words& way : ways) {
    const json whole = without_turns(checked(1, way));
    ASSERT_GT(whole["limits"]["outside"], 0);
    ASSERT_GT(whole["colliding"], 2);
    if (way == ways[1]) {
      ASSERT_GT(whole["not_proved"].size(), 1u);
    }
    for (const int of : test::effort(std::vector{7, 2, 3, 16, 40}, 1)) {
      std::vector<json> parts;
      for (int i = 1; i <= of; ++i) {
        const Outcome outcome = run(
            joined(command(way), "--json --shard " + std::to_string(i) + "/" + std::to_string(of)));
        ASSERT_LE(outcome.exit_code, 1) << outcome.err;
        parts.push_back(without_turns(json::parse(outcome.out)));
        EXPECT_EQ(outcome.exit_code, parts.back()["verdict"] == "free" ? 0 : 1);
        EXPECT_EQ(parts.back()["shard"], (json{{"index", i}, {"of", of}}));
      }
      EXPECT_EQ(merged(parts), whole) << of;
    }
  }
}

// Each motion goes through the wall, deepest on its way.
TEST_F(ShardTest, TheDeepestContactsOfManyMotionsDoNotDependOnTheParts) {
  std::string path;
  for (int i = 0; i < 1001; ++i) path += "-0.3 0\n0.31 0\n";
  write("path.csv", path);
  const json whole = without_turns(checked(1, "--edges"));
  ASSERT_EQ(whole["colliding"], 2001);
  std::vector<json> parts;
  for (const char* shard : {"1/2", "2/2"}) {
    parts.push_back(without_turns(checked(1, {"--edges", "--shard", shard})));
  }
  EXPECT_EQ(merged(parts), whole);
}

TEST_F(ShardTest, WhatIsNoShardIsRefused) {
  for (const char* text :
       {"", "3", "0/4", "5/4", "1/0", "-1/4", "1/4x", "a/b", "1/", "1/9999999"}) {
    expect_said(2, command({"--shard", text}), "--shard");
  }
  expect_said(2, command("--shard 40/40 --view page.html"), "is empty");
}

}  // namespace
}  // namespace spherule
