// SPDX-License-Identifier: BSD-3-Clause
// What `spherule robot` proves of pairs of links and writes, and `spherule check` takes.
#include "tests/cli/gantry.h"
#include "tests/cli/view_scene.h"
#include "tests/support/effort.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace spherule {
namespace {

using nlohmann::json;

class RobotPairsTest : public CommandTest {
 protected:
  Outcome cover(const std::vector<std::string>& more = {}) {
    std::vector<std::string> line = {"robot", "gantry.urdf", "-o",  "out",        "--effort",
                                     "0",     "--max-error", "0.1", "--postures", "500"};
    line.insert(line.end(), more.begin(), more.end());
    return run(line);
  }
  Outcome check(const std::vector<std::string>& more,
                const std::string& path = "slide, turn\n0, 0\n0.1, 0.5\n") {
    write("empty.json", R"({"format": "spherule-scene", "version": 1})");
    write("path.csv", path);
    std::vector<std::string> line = {"check",    "gantry.urdf", "empty.json",
                                     "path.csv", "--spheres",   "out/gantry.spheres.json"};
    line.insert(line.end(), more.begin(), more.end());
    return run(line);
  }
};

TEST_F(RobotPairsTest, PairsThatNeverTouchAreIgnoredWithTheReason) {
  write("gantry.urdf", gantry("0"));
  const Outcome result = cover();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("pairs of links: 1 proved never to touch"), std::string::npos)
      << result.out;
  const std::string reason = "Never (proved within the limits)";
  EXPECT_NE(read("out/gantry.srdf").find(R"(link1="block" link2="tool" reason=")" + reason + "\""),
            std::string::npos);
  for (const char* const file : {"out/gantry.curobo.yml", "out/gantry.xrdf"}) {
    EXPECT_NE(read(file).find("block: [tool]  # " + reason + ": tool\n"), std::string::npos)
        << read(file);
  }
  const json report = read_json("out/gantry.report.json");
  EXPECT_EQ(report["link_pairs"]["never"], 1);
  EXPECT_EQ(report["link_pairs"]["pairs"][0]["links"], (json{"block", "tool"}));
  EXPECT_EQ(report["link_pairs"]["pairs"][0]["free_share"], 1.0);
  EXPECT_TRUE(report["posture_contacts"].empty());
}

TEST_F(RobotPairsTest, WithoutProofsSpheresThatTouchAtRestAreAWarning) {
  write("gantry.urdf", gantry("0"));
  const Outcome result = cover({"--proofs", "none"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("in the zero posture tool and block touch by their spheres alone"),
            std::string::npos)
      << result.err;
  EXPECT_FALSE(exists("out/gantry.pairs"));
  EXPECT_EQ(result.out.find("--pairs"), std::string::npos) << result.out;
}

TEST_F(RobotPairsTest, PairsAreAskedForWithProofsAlone) {
  write("gantry.urdf", gantry("0"));
  const Outcome result = cover({"--format", "json,pairs", "--proofs", "none"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("--format pairs: nothing is proved of pairs with --proofs none"),
            std::string::npos)
      << result.err;
}

TEST_F(RobotPairsTest, StepsThatAreNamedTakeProofsWithoutPadding) {
  write("gantry.urdf", gantry("0"));
  const Outcome result = cover({"--format", "json,pairs", "--link", "tool:padding=0.001"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("spherule check gantry.urdf"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("--pairs"), std::string::npos) << result.out;
}

TEST_F(RobotPairsTest, CheckTakesTheProofs) {
  write("gantry.urdf", gantry("-0.05"));
  const Outcome result = cover();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("free for who takes the proofs"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("--pairs out/gantry.pairs"), std::string::npos) << result.out;
  const json pair = read_json("out/gantry.report.json")["link_pairs"]["pairs"][0];
  EXPECT_EQ(pair["verdict"], "touching");
  EXPECT_LT(pair["witness"]["slide"], -0.0199);

  EXPECT_EQ(check({"--edges"}).exit_code, 1);
  const Outcome proved = check({"--edges", "--pairs", "out/gantry.pairs"});
  EXPECT_EQ(proved.exit_code, 0);
  EXPECT_NE(
      proved.out.find("free though spheres overlap: tool and block (free in boxes), in 2 of 2"),
      std::string::npos)
      << proved.out;
  // For other limits nothing was proved.
  write("gantry.urdf", gantry("-0.06"));
  const Outcome other = check({"--pairs", "out/gantry.pairs"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("the limits of joint 'slide' are wider"), std::string::npos)
      << other.err;
}

TEST_F(RobotPairsTest, CheckSaysOfWhatKindPairsAre) {
  write("gantry.urdf", gantry("-0.05"));
  ASSERT_EQ(cover().exit_code, 0);
  const std::string path = "slide, turn\n-0.04, 0\n0, 0\n";
  const Outcome table = check({"--pairs", "out/gantry.pairs"}, path);
  EXPECT_EQ(table.exit_code, 1);
  EXPECT_NE(table.out.find("kind\n"), std::string::npos) << table.out;
  EXPECT_NE(table.out.find("  can touch\n"), std::string::npos) << table.out;
  const json found = json::parse(check({"--pairs", "out/gantry.pairs", "--json"}, path).out);
  ASSERT_EQ(found["pairs"].size(), 1U);
  EXPECT_EQ(found["pairs"][0]["count"], 1);
  EXPECT_EQ(found["pairs"][0]["kind"], "can touch");
  ASSERT_EQ(found["proved_free"].size(), 1U);
  EXPECT_EQ(found["proved_free"][0]["count"], 1);
  EXPECT_EQ(found["proved_free"][0]["kind"], "free in boxes");
  const json without = json::parse(check({"--json"}, path).out);
  EXPECT_EQ(without["pairs"][0]["count"], 2);
  EXPECT_FALSE(without["pairs"][0].contains("kind"));
  EXPECT_TRUE(without["proved_free"].empty());
}

TEST_F(RobotPairsTest, TheClearanceOfThePageIsOfWhatIsNotProved) {
  write("gantry.urdf", gantry("-0.05"));
  ASSERT_EQ(cover().exit_code, 0);
  const auto page = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--view", "page.html"});
    check(more, "slide, turn\n-0.04, 0\n0, 0\n");
    return scene_of(read("page.html")).at("trajectory");
  };
  const json spheres = page({});
  EXPECT_EQ(spheres.at("skipped"), false);
  EXPECT_EQ(floats_of(spheres.at("clearance")), (std::vector<float>{0.0F, 0.0F}));
  // The first configuration is in contact, the second is proved free, and there are no others.
  const json proved = page({"--pairs", "out/gantry.pairs"});
  EXPECT_EQ(proved.at("skipped"), true);
  EXPECT_EQ(floats_of(proved.at("clearance")),
            (std::vector<float>{0.0F, std::numeric_limits<float>::infinity()}));
}

TEST_F(RobotPairsTest, AuditTellsPairsApart) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const auto audit = [&](const std::vector<std::string>& more) {
    std::vector<std::string> line = {"audit-robot", "gantry.urdf", "out/gantry.spheres.json"};
    line.insert(line.end(), more.begin(), more.end());
    return run(line);
  };
  write("gantry.urdf", gantry("0"));
  ASSERT_EQ(cover().exit_code, 0);
  const Outcome never = audit({"--pairs", "out/gantry.pairs"});
  EXPECT_EQ(never.exit_code, 0) << never.err;
  EXPECT_NE(never.out.find("pairs of links: 1; 1 proved never\n"), std::string::npos) << never.out;
  EXPECT_NE(never.out.find("block  tool  proved never  never   100.0 %\n"), std::string::npos)
      << never.out;

  write("gantry.urdf", gantry("-0.05"));
  ASSERT_EQ(cover().exit_code, 0);
  write("gantry.srdf", R"(<robot name="gantry">
<disable_collisions link1="tool" link2="block" reason="Never"/></robot>)");
  const json boxes = json::parse(audit({"--pairs", "out/gantry.pairs", "--json"}).out)["pairs"][0];
  EXPECT_EQ(boxes["kind"], "free in boxes");
  EXPECT_EQ(boxes["verdict"], "touching");
  EXPECT_LT(boxes["free_share"], 1.0);
  const Outcome given = audit({"--srdf", "gantry.srdf", "--json"});
  EXPECT_EQ(given.exit_code, 0) << given.err;
  EXPECT_NE(given.err.find("disables tool and block (\"Never\"), which touch at slide"),
            std::string::npos)
      << given.err;
  const json judged = json::parse(given.out);
  EXPECT_EQ(judged["pairs"][0]["kind"], "given");
  EXPECT_EQ(judged["pairs"][0]["verdict"], "touching");
  EXPECT_LT(judged["pairs"][0]["witness"]["slide"], -0.0199);
  EXPECT_TRUE(judged["disabled_pairs"][0]["wrong"]);
}

TEST_F(RobotPairsTest, ThePageHasThePairsOfTheFirstSpheres) {
  const auto page = [&](const std::vector<std::string>& more) {
    std::vector<std::string> line = {"view", "gantry.urdf", "out/gantry.spheres.json"};
    line.insert(line.end(), more.begin(), more.end());
    line.insert(line.end(), {"-o", "page.html"});
    const Outcome result = run(line);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return scene_of(read("page.html"))["robot"];
  };
  write("gantry.urdf", gantry("-0.05"));
  ASSERT_EQ(cover().exit_code, 0);
  EXPECT_EQ(page({})["pairs"], json::parse(R"([{"links": [0, 2], "kind": "tested"}])"));
  EXPECT_EQ(page({})["pairs_of"], "out/gantry.spheres.json");
  const json pair = page({"out/gantry.pairs"})["pairs"][0];
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
  const json given = page({"gantry.srdf", "out/gantry.pairs"})["pairs"][0];
  EXPECT_EQ(given["kind"], "given");
  EXPECT_EQ(given["verdict"], "touching");
  EXPECT_FALSE(given.contains("boxes"));
  const Outcome bare = run({"view", "gantry.urdf", "out/gantry.pairs", "-o", "page.html"});
  EXPECT_EQ(bare.exit_code, 2);
  EXPECT_NE(bare.err.find("name a file of them"), std::string::npos) << bare.err;
}

TEST_F(RobotPairsTest, NamedStatesThatTouchAreTold) {
  write("gantry.urdf", gantry("-0.05"));
  write("gantry.srdf", R"(<robot name="gantry"><group name="all"><joint name="slide"/></group>
<group_state name="home" group="all"><joint name="slide" value="-0.04"/></group_state></robot>)");
  const Outcome result = cover({"--srdf", "gantry.srdf"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("in all/home tool and block touch, by their meshes, too"),
            std::string::npos)
      << result.err;
}

// The proved pair is added to each, its reason too; what was written is kept as it is.
TEST_F(RobotPairsTest, FilesThatAreKeptGetThePairsOnce) {
  write("gantry.urdf", gantry("0"));
  write("my.srdf", "<robot name=\"gantry\">\n  <!-- mine -->\n</robot>\n");
  write("my.yml", "kinematics:\n  collision_link_names: [tool]  # mine\n  collision_spheres:\n");
  write("my.xrdf",
        "format: xrdf\nformat_version: 1.0\ncollision: {geometry: g}  # mine\nself_collision:\n"
        "  geometry: g\n  ignore:\n    tool: [other]\ngeometry:\n  g:\n    spheres: {}\n");
  const Outcome result = cover({"--srdf", "my.srdf", "--curobo", "my.yml", "--xrdf", "my.xrdf"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string reason = "Never (proved within the limits)";
  EXPECT_EQ(read("out/gantry.srdf")
                .find("<robot name=\"gantry\">\n  <!-- mine -->\n"
                      "    <disable_collisions link1=\"block\" link2=\"tool\" "
                      "reason=\"" +
                      reason + "\"/>\n"),
            0U)
      << read("out/gantry.srdf");
  EXPECT_EQ(read("out/gantry.curobo.yml")
                .find("kinematics:\n  self_collision_ignore:\n    tool: [block]  # " + reason +
                      ": block\n  collision_link_names: [tool, block]  # mine\n"),
            0U)
      << read("out/gantry.curobo.yml");
  EXPECT_NE(read("out/gantry.xrdf")
                .find("  ignore:\n    tool: [other]\n    block: [tool]  # " + reason + ": tool\n"),
            std::string::npos)
      << read("out/gantry.xrdf");

  const std::vector<std::string> files = {"out/gantry.srdf", "out/gantry.curobo.yml",
                                          "out/gantry.xrdf"};
  std::vector<std::string> texts;
  for (const std::string& file : files) write("again" + file.substr(10), read(file));
  for (const std::string& file : files) texts.push_back(read(file));
  ASSERT_EQ(cover({"--srdf", "again.srdf", "--curobo", "again.curobo.yml", "--xrdf", "again.xrdf"})
                .exit_code,
            0);
  for (std::size_t i = 0; i < files.size(); ++i) EXPECT_EQ(read(files[i]), texts[i]);
}

TEST_F(RobotPairsTest, WhatIsProvedIsTheReasonInNewFiles) {
  write("gantry.urdf", gantry("0"));
  write("my.srdf", R"(<robot name="gantry">
<disable_collisions link1="tool" link2="block" reason="Never"/></robot>)");
  ASSERT_EQ(cover({"--srdf", "my.srdf"}).exit_code, 0);
  EXPECT_NE(read("out/gantry.xrdf").find("# Never (proved within the limits): tool\n"),
            std::string::npos);
  EXPECT_NE(read("out/gantry.srdf").find("link2=\"block\" reason=\"Never\"/>"), std::string::npos);
}

TEST_F(RobotPairsTest, DisabledPairsThatTouchAreAWarning) {
  write("gantry.urdf", gantry("-0.05"));
  const auto warnings = [&](const std::string& reason) {
    write("gantry.srdf", R"(<robot name="gantry"><disable_collisions link1="tool" link2="block")" +
                             reason + "/></robot>");
    return cover({"--srdf", "gantry.srdf"}).err;
  };
  EXPECT_NE(warnings(R"( reason="Never")")
                .find(R"(the SRDF disables tool and block ("Never"), which touch at slide -0.0)"),
            std::string::npos);
  const json judged = read_json("out/gantry.report.json")["disabled_pairs"][0];
  EXPECT_TRUE(judged["wrong"]);
  EXPECT_LT(judged["witness"]["slide"], -0.0199);
  EXPECT_NE(read("out/gantry.xrdf").find("# given, though they can touch: tool\n"),
            std::string::npos);
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

TEST_F(RobotPairsTest, ManyContactsAtRestAreAFewWarnings) {
  write("fan.urdf", fan());
  const Outcome result = run({"robot", "fan.urdf", "-o", "out", "--effort", "0", "--max-error",
                              "0.05", "--postures", "10", "--proofs", "none"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::size_t contacts = read_json("out/fan.report.json")["posture_contacts"].size();
  ASSERT_GT(contacts, 10U);
  const auto lines = std::count(result.err.begin(), result.err.end(), '\n');
  EXPECT_EQ(lines, 6) << result.err;
  EXPECT_NE(result.err.find("so do " + std::to_string(contacts - 5) + " more pairs"),
            std::string::npos)
      << result.err;
  // The plate without thickness has next to no volume, and a row as wide as others.
  const std::size_t row = result.out.find("\nr/0 ");
  ASSERT_NE(row, std::string::npos) << result.out;
  EXPECT_LT(result.out.find('\n', row + 1) - row, 110U) << result.out;
  EXPECT_TRUE(exists("out/fan.r%2F0.tree"));
  EXPECT_TRUE(exists("out/fan.2.tree"));
}

TEST_F(RobotPairsTest, LinksWhoseTreesWouldBeOneFileAreRefused) {
  std::string text = fan();
  const std::string name = "'2'";
  for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at)) {
    text.replace(at, name.size(), "'r%2F1'");
  }
  write("fan.urdf", text);
  const Outcome result = run({"robot", "fan.urdf", "-o", "out", "--format", "tree"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("fan.r%2F1.tree: is a file of two links"), std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace spherule
