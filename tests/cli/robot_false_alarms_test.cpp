// SPDX-License-Identifier: BSD-3-Clause
#include "robot/formats/sphere_formats.h"
#include "tests/cli/gantry.h"
#include "tests/support/effort.h"

#include <string>
#include <vector>

namespace spherule {
namespace {

using nlohmann::json;

class RobotFalseAlarmsTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("gantry.urdf", gantry("0"));
  }

  static std::vector<std::string> command(const std::vector<std::string>& more) {
    std::vector<std::string> line = {"robot",       "gantry.urdf", "-o",         "out",
                                     "--effort",    "0",           "--format",   "json",
                                     "--max-error", "0.1",         "--postures", "2000"};
    line.insert(line.end(), more.begin(), more.end());
    return line;
  }

  json alarms() const { return read_json("out/gantry.report.json")["false_alarms"]; }
};

TEST_F(RobotFalseAlarmsTest, MeasuresAndNamesThePair) {
  const Outcome result = run(command({"--proofs", "none"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("false alarms: "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("block and tool: "), std::string::npos) << result.out;
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
  const Outcome result = run(command({"--json"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json found = json::parse(result.out)["false_alarms"];
  EXPECT_EQ(found["proofs"], "boxes");
  EXPECT_EQ(found["refused"], 0);
  EXPECT_EQ(found["share_with_proofs"]["never"], 0.0);
  EXPECT_GT(found["share_with_proofs"]["none"], 0.05);
}

TEST_F(RobotFalseAlarmsTest, ReachesAGoal) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  write("poses.csv", "turn, slide\n0, 0.3\n0.5, 0.4\n");
  const Outcome result =
      run(command({"--proofs", "none", "--false-alarms", "20%", "--poses", "poses.csv"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("goal 20.00 %: reached"), std::string::npos) << result.out;
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
  const Outcome result = run(command({"--false-alarms", "0.0001"}));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("false alarms"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("--postures"), std::string::npos) << result.out;
  EXPECT_FALSE(alarms()["goal"]["reached"]);
}

TEST_F(RobotFalseAlarmsTest, RefusesBadInput) {
  for (const char* share : {"0", "1", "100%", "-1%", "few", "1%%", "%", "nan"}) {
    expect_refusal(command({"--false-alarms", share}), "share");
  }
  expect_refusal(command({"--proofs", "some"}), "--proofs");
  expect_refusal(command({"--postures", "0"}), "--postures");
  expect_refusal(command({"--poses", "none.csv"}), "none.csv");
  write("narrow.csv", "0.1\n");
  expect_refusal(command({"--poses", "narrow.csv"}), "line 1");
  write("empty.csv", "# nothing\n");
  expect_refusal(command({"--poses", "empty.csv"}), "empty.csv");
  write("post.urdf",
        R"(<robot name="post"><link name="post"><collision><geometry><box size="1 1 1"/></geometry>
           </collision></link></robot>)");
  expect_refusal({"robot", "post.urdf", "-o", "out", "--false-alarms", "1%"},
                 "no joint that moves");
  EXPECT_FALSE(exists("out"));
}

}  // namespace
}  // namespace spherule
