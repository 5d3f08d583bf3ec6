// SPDX-License-Identifier: BSD-3-Clause
// What `spherule robot` proves of pairs of links and writes, and `spherule check` takes.
#include "tests/cli/command_test_support.h"
#include "tests/cli/robot_fixtures.h"
#include "tests/support/effort.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace spherule {
namespace {

using nlohmann::json;

class RobotPairsTest : public CommandTest {
 protected:
  // Covers the gantry whose slide goes that far down.
  Outcome cover(const std::string& lower, const std::string& more = "") {
    write("gantry.urdf", gantry(lower));
    return expect_exit(
        0, "robot gantry.urdf -o out --effort 0 --max-error 0.1 --postures 500 " + more);
  }
  Words check(const std::string& more, const std::string& path = "slide, turn\n0, 0\n0.1, 0.5\n") {
    write("empty.json", scene(""));
    write("path.csv", path);
    return "check gantry.urdf empty.json path.csv --spheres out/gantry.spheres.json " + more;
  }
};

constexpr const char* kNever = "Never (proved within the limits)";

TEST_F(RobotPairsTest, PairsThatNeverTouchAreIgnoredWithTheReason) {
  const Outcome result = cover("0");
  EXPECT_EQ(result.err, "");
  EXPECT_TRUE(has(result.out, "pairs of links: 1 proved never to touch"));
  const std::string reason = kNever;
  EXPECT_TRUE(
      has(read("out/gantry.srdf"), R"(link1="block" link2="tool" reason=")" + reason + "\""));
  for (const char* const file : {"out/gantry.curobo.yml", "out/gantry.xrdf"}) {
    EXPECT_TRUE(has(read(file), "block: [tool]  # " + reason + ": tool\n"));
  }
  const json report = read_json("out/gantry.report.json");
  EXPECT_EQ(report["link_pairs"]["never"], 1);
  EXPECT_EQ(report["link_pairs"]["pairs"][0]["links"], (json{"block", "tool"}));
  EXPECT_EQ(report["link_pairs"]["pairs"][0]["free_share"], 1.0);
  EXPECT_TRUE(report["posture_contacts"].empty());
}

// What little effort leaves open is no proof, and more effort proves more.
TEST_F(RobotPairsTest, TheirWorkGrowsWithTheEffort) {
  std::string robot = gantry("-0.05");
  const std::string turn = R"(<axis xyz="1 0 0"/><limit lower="-1")";
  robot.replace(robot.find(turn), turn.size(), R"(<axis xyz="0 1 0"/><limit lower="-1")");
  write("gantry.urdf", robot);
  std::size_t boxes = 0;
  double free_share = 0.0;
  for (const std::string effort : {"0", "4", "60"}) {
    expect_exit(0, "robot gantry.urdf -o out --max-error 0.1 --postures 10 --effort " + effort);
    const json pair = read_json("out/gantry.report.json")["link_pairs"]["pairs"][0];
    EXPECT_EQ(pair["verdict"], "touching");
    EXPECT_GT(pair["boxes"].get<std::size_t>(), boxes) << effort;
    EXPECT_GT(pair["free_share"].get<double>(), free_share) << effort;
    boxes = pair["boxes"];
    free_share = pair["free_share"];
  }
}

// Of an SRDF the comments stay; written into a second time, no file changes.
TEST_F(RobotPairsTest, FilesThatAreKeptGetThePairsOnce) {
  write("my.srdf", "<robot name=\"gantry\">\n  <!-- mine -->\n</robot>\n");
  write("my.yml", "kinematics:\n  collision_link_names: [tool]\n  collision_spheres:\n");
  write("my.xrdf",
        "format: xrdf\nformat_version: 1.0\ncollision: {geometry: g}\nself_collision:\n"
        "  geometry: g\n  ignore:\n    tool: [other]\ngeometry:\n  g:\n    spheres: {}\n");
  cover("0", "--srdf my.srdf --curobo my.yml --xrdf my.xrdf");
  std::vector<std::string> texts;
  for (const std::string ending : {"srdf", "curobo.yml", "xrdf"}) {
    texts.push_back(read("out/gantry." + ending));
    write("again." + ending, texts.back());
  }
  EXPECT_TRUE(has(texts[0], "<!-- mine -->") && has(texts[0], kNever));
  EXPECT_TRUE(has(texts[1], "  self_collision_ignore:\n    tool: [block]\n"));
  EXPECT_TRUE(has(texts[2], "    tool: [other]\n    block: [tool]\n"));
  cover("0", "--srdf again.srdf --curobo again.curobo.yml --xrdf again.xrdf");
  for (const std::string ending : {"srdf", "curobo.yml", "xrdf"}) {
    EXPECT_EQ(read("out/gantry." + ending), read("again." + ending));
  }
}

TEST_F(RobotPairsTest, ContactsInThePosturesThatHaveANameAreWarnings) {
  write("gantry.srdf", R"(<robot name="gantry"><group name="all"><joint name="slide"/></group>
<group_state name="home" group="all"><joint name="slide" value="-0.04"/></group_state></robot>)");
  EXPECT_TRUE(has(cover("-0.05", "--srdf gantry.srdf").err,
                  "in all/home tool and block touch, by their meshes, too"));
  EXPECT_TRUE(has(cover("0", "--proofs none").err,
                  "in the zero posture tool and block touch by their spheres alone"));
}

TEST_F(RobotPairsTest, CheckTakesTheProofsAndSaysOfWhatKindPairsAre) {
  const Outcome result = cover("-0.05");
  EXPECT_TRUE(has(result.err, "free for who takes the proofs"));
  EXPECT_TRUE(has(result.out, "--pairs out/gantry.pairs"));
  const json pair = read_json("out/gantry.report.json")["link_pairs"]["pairs"][0];
  EXPECT_EQ(pair["verdict"], "touching");
  EXPECT_LT(pair["witness"]["slide"], -0.0199);

  expect_exit(1, check("--edges"));
  EXPECT_TRUE(has(expect_exit(0, check("--edges --pairs out/gantry.pairs")).out,
                  "free though spheres overlap: tool and block (free in boxes), in 2 of 2"));
  const std::string path = "slide, turn\n-0.04, 0\n0, 0\n";
  EXPECT_TRUE(has(expect_exit(1, check("--pairs out/gantry.pairs", path)).out, "  can touch\n"));
  const json found = expect_json(1, check("--pairs out/gantry.pairs", path));
  ASSERT_EQ(found["pairs"].size(), 1U);
  EXPECT_EQ(found["pairs"][0]["count"], 1);
  EXPECT_EQ(found["pairs"][0]["kind"], "can touch");
  ASSERT_EQ(found["proved_free"].size(), 1U);
  EXPECT_EQ(found["proved_free"][0]["count"], 1);
  EXPECT_EQ(found["proved_free"][0]["kind"], "free in boxes");
  const json without = expect_json(1, check("", path));
  EXPECT_EQ(without["pairs"][0]["count"], 2);
  EXPECT_FALSE(without["pairs"][0].contains("kind"));
  EXPECT_TRUE(without["proved_free"].empty());

  // The clearance of the page is of what is not proved: the first configuration is in contact, the
  // second is proved free, and there are no others.
  const auto clearance = [&](const std::string& more, bool is_skipped) {
    expect_exit(1, check(more + " --view page.html", path));
    const json trajectory = scene_of(read("page.html")).at("trajectory");
    EXPECT_EQ(trajectory.at("skipped"), is_skipped);
    return floats_of(trajectory.at("clearance"));
  };
  EXPECT_EQ(clearance("", false), (std::vector<float>{0.0F, 0.0F}));
  EXPECT_EQ(clearance("--pairs out/gantry.pairs", true),
            (std::vector<float>{0.0F, std::numeric_limits<float>::infinity()}));

  // For other limits nothing was proved.
  write("gantry.urdf", gantry("-0.06"));
  EXPECT_TRUE(has(expect_exit(2, check("--pairs out/gantry.pairs")).err,
                  "the limits of joint 'slide' are wider"));
}

TEST_F(RobotPairsTest, AuditTellsPairsApart) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const auto audit = [&](const Words& more) {
    return run(joined("audit-robot gantry.urdf out/gantry.spheres.json", more));
  };
  cover("0");
  const Outcome never = audit("--pairs out/gantry.pairs");
  EXPECT_EQ(never.exit_code, 0) << never.err;
  EXPECT_TRUE(has(never.out, "pairs of links: 1; 1 proved never\n"));
  EXPECT_TRUE(has(never.out, "block  tool  proved never  never   100.0 %\n"));

  cover("-0.05");
  write("gantry.srdf", R"(<robot name="gantry">
<disable_collisions link1="tool" link2="block" reason="Never"/></robot>)");
  const json boxes = json::parse(audit("--pairs out/gantry.pairs --json").out)["pairs"][0];
  EXPECT_EQ(boxes["kind"], "free in boxes");
  EXPECT_EQ(boxes["verdict"], "touching");
  EXPECT_LT(boxes["free_share"], 1.0);
  const Outcome given = audit("--srdf gantry.srdf --json");
  EXPECT_EQ(given.exit_code, 0) << given.err;
  EXPECT_TRUE(has(given.err, "disables tool and block (\"Never\"), which touch at slide"));
  const json judged = json::parse(given.out);
  EXPECT_EQ(judged["pairs"][0]["kind"], "given");
  EXPECT_EQ(judged["pairs"][0]["verdict"], "touching");
  EXPECT_LT(judged["pairs"][0]["witness"]["slide"], -0.0199);
  EXPECT_TRUE(judged["disabled_pairs"][0]["wrong"]);
}

TEST_F(RobotPairsTest, ThePageHasThePairsOfTheFirstSpheres) {
  const auto page = [&](const std::string& more) {
    expect_exit(0, "view gantry.urdf out/gantry.spheres.json -o page.html " + more);
    return scene_of(read("page.html"))["robot"];
  };
  cover("-0.05");
  EXPECT_EQ(page("")["pairs"], json::parse(R"([{"links": [0, 2], "kind": "tested"}])"));
  EXPECT_EQ(page("")["pairs_of"], "out/gantry.spheres.json");
  const json pair = page("out/gantry.pairs")["pairs"][0];
  EXPECT_EQ(pair["kind"], "free in boxes");
  EXPECT_EQ(pair["verdict"], "touching");
  // Halved by one of the variables first.
  EXPECT_EQ(pair["boxes"]["variables"].size(), 2U);
  EXPECT_EQ(pair["boxes"]["variables"][0]["upper"], 0.5);
  const std::string nodes = pair["boxes"]["nodes"];
  EXPECT_GE(nodes.front(), 'C');
  EXPECT_EQ(nodes.find_first_not_of("ABCD"), std::string::npos);

  write("gantry.srdf", R"(<robot name="gantry">
<disable_collisions link1="tool" link2="block" reason="User"/></robot>)");
  const json given = page("gantry.srdf out/gantry.pairs")["pairs"][0];
  EXPECT_EQ(given["kind"], "given");
  EXPECT_EQ(given["verdict"], "touching");
  EXPECT_FALSE(given.contains("boxes"));
  expect_said(2, "view gantry.urdf out/gantry.pairs -o page.html", "name a file of them");
}

TEST_F(RobotPairsTest, DisabledPairsThatTouchAreAWarning) {
  const auto warnings = [&](const std::string& reason) {
    write("gantry.srdf", R"(<robot name="gantry"><disable_collisions link1="tool" link2="block")" +
                             reason + "/></robot>");
    return cover("-0.05", "--srdf gantry.srdf").err;
  };
  EXPECT_TRUE(has(warnings(R"( reason="Never")"),
                  R"(the SRDF disables tool and block ("Never"), which touch at slide -0.0)"));
  const json judged = read_json("out/gantry.report.json")["disabled_pairs"][0];
  EXPECT_TRUE(judged["wrong"]);
  EXPECT_LT(judged["witness"]["slide"], -0.0199);
  EXPECT_TRUE(has(read("out/gantry.xrdf"), "# given, though they can touch: tool\n"));
  EXPECT_EQ(warnings(R"( reason="User")"), "");
}

// A fan of 12 plates side by side on joints, whose spheres overlap though they are 1 mm apart; two
// of the links have a slash in the name, as those of some published robots do.
std::string fan() {
  std::string text = "<robot name='fan'><link name='r/hub'/>";
  for (int i = 0; i < 12; ++i) {
    const std::string n = std::to_string(i);
    const std::string link = (i < 2 ? "r/" : "") + n;
    text += "<link name='" + link + "'><collision><geometry><box size='0.2 0.2 " +
            (i == 0 ? "0" : "0.019") + "'/></geometry></collision></link><joint name='j" + n +
            "' type='continuous'><parent link='r/hub'/><child link='" + link +
            "'/><origin xyz='0 0 " + std::to_string(0.02 * i) + "'/></joint>";
  }
  return text + "</robot>";
}

// At most five warnings of a kind, and one that counts the rest; the report has all.
TEST_F(RobotPairsTest, ManyContactsAtRestAreAFewWarnings) {
  write("fan.urdf", fan());
  const Outcome result = expect_exit(
      0, "robot fan.urdf -o out --effort 0 --max-error 0.05 --postures 10 --proofs none");
  const std::size_t contacts = read_json("out/fan.report.json")["posture_contacts"].size();
  ASSERT_GT(contacts, 10U);
  EXPECT_EQ(lines_of(result.err).size(), 6U) << result.err;
  EXPECT_TRUE(has(result.err, "so do " + std::to_string(contacts - 5) + " more pairs"));
  EXPECT_TRUE(exists("out/fan.r%2F0.tree") && exists("out/fan.2.tree"));
}

TEST_F(RobotPairsTest, LinksWhoseTreesWouldBeOneFileAreRefused) {
  std::string text = fan();
  const std::string name = "'2'";
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at)) {
    text.replace(at, name.size(), "'r%2F1'");
  }
  write("fan.urdf", text);
  expect_said(2, "robot fan.urdf -o out --format tree", "fan.r%2F1.tree: is a file of two links");
}

// A cart that is driven against a block from 0.1 m on.
constexpr const char* kRail = R"(<?xml version="1.0"?>
<robot name="rail">
  <link name="block"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <link name="bare"/>
  <link name="plate"><collision><geometry><box size="0.01 0.01 0.01"/></geometry></collision></link>
  <link name="cart"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <joint name="lift" type="prismatic"><parent link="block"/><child link="plate"/>
    <origin xyz="0 2 0"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.5" effort="1" velocity="1"/></joint>
  <joint name="rod" type="prismatic"><parent link="plate"/><child link="bare"/>
    <origin xyz="0 -2 0"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.5" effort="1" velocity="1"/></joint>
  <joint name="drive" type="prismatic"><parent link="bare"/><child link="cart"/>
    <axis xyz="1 0 0"/><limit lower="0.1" upper="1" effort="1" velocity="1"/></joint>
</robot>
)";

class CheckSrdfTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("rail.urdf", kRail);
  }

  Outcome judge(const std::string& reason, const Words& more = {}) {
    write("rail.srdf", R"(<robot name="rail">
<disable_collisions link1="block" link2="cart" reason=")" +
                           reason + R"("/>
<disable_collisions link1="block" link2="plate" reason="Adjacent"/></robot>)");
    return run(joined("check-srdf rail.urdf rail.srdf", more));
  }
};

TEST_F(CheckSrdfTest, SaysWhatTouchesAndWhere) {
  const Outcome result = judge("Never");
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_EQ(result.out.find("1 disabled pair touches, though not meant to:\n"
                            "  block and cart (\"Never\"): lift 0."),
            0U)
      << result.out;
  EXPECT_TRUE(
      has(result.out, "could be disabled, too (proved never to touch):\n  plate and cart\n"));
  EXPECT_EQ(judge("User").exit_code, 0);
}

// No time is enough for nothing: what is not proved is not confirmed.
TEST_F(CheckSrdfTest, WhatIsNotProvedIsNotConfirmed) {
  const Outcome result = judge("Never", "--seconds 1e-9");
  EXPECT_EQ(result.exit_code, 1) << result.out;
  EXPECT_TRUE(has(result.out, "neither proved nor touching:\n  block and cart (\"Never\")"));
  EXPECT_EQ(judge("User", "--seconds 1e-9").exit_code, 0);
}

TEST_F(CheckSrdfTest, TellsItInJson) {
  const json found = json::parse(judge("Never", {"--json"}).out);
  ASSERT_EQ(found["pairs"].size(), 2U);
  EXPECT_EQ(found["pairs"][0]["verdict"], "touches");
  EXPECT_TRUE(found["pairs"][0]["wrong"]);
  EXPECT_LE(found["pairs"][0]["witness"]["drive"], 0.2001);
  EXPECT_EQ(found["pairs"][1]["verdict"], "never");
  EXPECT_EQ(found["could_be_added"], json::parse(R"([["plate", "cart"]])"));
}

TEST_F(CheckSrdfTest, BadInputIsRefused) {
  expect_said(2, "check-srdf rail.urdf rail.urdf", "rail.urdf: it disables no pair of links");
}

}  // namespace
}  // namespace spherule
