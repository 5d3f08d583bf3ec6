// SPDX-License-Identifier: BSD-3-Clause
#include "robot/formats/sphere_formats.h"
#include "tests/cli/command_test_support.h"
#include "tests/support/effort.h"

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace spherule {
namespace {

using nlohmann::json;

// Bars: without external spheres what is inside is found by a flood, which is quick there.
constexpr const char* kRobot = R"(<robot name="two"><link name="base">
  <visual><geometry><box size="0.15 0.001 0.001"/></geometry></visual>
  <collision><geometry><box size="0.2 0.001 0.001"/></geometry></collision></link>
<link name="arm"><collision><geometry><box size="0.08 0.0005 0.0005"/></geometry></collision></link>
<joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
  <origin xyz="0.3 0 0"/><axis xyz="0 0 1"/><limit lower="-4" upper="4" effort="1" velocity="1"/>
</joint></robot>)";

// cuRobo yml with a sphere for each link.
std::string spheres(double base, double arm) {
  return "robot_cfg:\n  kinematics:\n    collision_spheres:\n      base:\n      - {center: [0, 0, "
         "0], "
         "radius: " +
         std::to_string(base) +
         "}\n      arm:\n      - {center: [0, 0, 0], radius: " + std::to_string(arm) + "}\n";
}

class AuditRobotCommand : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("two.urdf", kRobot);
  }
};

TEST_F(AuditRobotCommand, ExitCodeAndTable) {
  write("good.yml", spheres(0.12, 0.05));
  const Outcome good = run({"audit-robot", "two.urdf", "good.yml"});
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_NE(good.out.find("cuRobo yml"), std::string::npos) << good.out;
  write("leaks.yml", spheres(0.09, 0.05));
  const Outcome leaks = run({"audit-robot", "two.urdf", "leaks.yml"});
  EXPECT_EQ(leaks.exit_code, 1) << leaks.err;
  EXPECT_NE(leaks.out.find("NO"), std::string::npos) << leaks.out;
  EXPECT_EQ(run({"audit-robot", "two.urdf", "leaks.yml", "--geometry", "visual"}).exit_code, 0);
}

TEST_F(AuditRobotCommand, Json) {
  write("leaks.yml", spheres(0.09, 0.05) +
                         "      ghost:\n      - {center: [0, 0, 0], radius: 1}\n"
                         "      - {center: [0, 0, 0], radius: -1}\n");
  const std::vector<std::string> command = {"audit-robot", "two.urdf", "leaks.yml", "--json",
                                            "--ignore-unknown-links"};
  const Outcome result = run(command);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report.at("links_covered"), false);
  EXPECT_EQ(report.at("switched_off"), 1);
  EXPECT_EQ(report.at("unknown_links"), json({"ghost"}));
  const json& base = report.at("links").at(0);
  EXPECT_EQ(base.at("sphere_count"), 1);
  const double depth = std::sqrt(0.01 + 2 * 0.00000025) - 0.09;
  EXPECT_LE(base.at("certificate").at("uncovered_depth_surface").at(0), depth + 1e-9);
  EXPECT_GE(base.at("certificate").at("uncovered_depth_surface").at(1), depth - 1e-9);
  EXPECT_EQ(base.at("warnings"), json::array());
  EXPECT_EQ(report.at("links").at(1).at("certificate").at("covered"), true);
  std::vector<std::string> with_one_thread = command;
  with_one_thread.insert(with_one_thread.end(), {"--threads", "1"});
  EXPECT_EQ(run(with_one_thread).out, result.out);
}

TEST_F(AuditRobotCommand, TableSaysWhatWasLeftOut) {
  write("two.yml", spheres(0.12, 0.05) +
                       "      ghost:\n      - {center: [0, 0, 0], radius: 1}\n"
                       "      - {center: [0, 0, 0], radius: -1}\n");
  const std::string table =
      run({"audit-robot", "two.urdf", "two.yml", "--ignore-unknown-links"}).out;
  EXPECT_NE(table.find("left out: 1 spheres that the file switches off"), table.npos) << table;
  EXPECT_NE(table.find("left out: the spheres of ghost"), table.npos) << table;
  write("two.spheres.urdf", R"(<robot name="two"><link name="base">
    <collision><geometry><sphere radius="0.12"/></geometry></collision>
    <collision><geometry><box size="1 1 1"/></geometry></collision></link><link name="arm">
    <collision><geometry><sphere radius="0.05"/></geometry></collision></link></robot>)");
  const Outcome shapes = run({"audit-robot", "two.urdf", "two.spheres.urdf"});
  EXPECT_EQ(shapes.exit_code, 0) << shapes.err;
  EXPECT_NE(shapes.out.find("left out: 1 collision shapes"), table.npos) << shapes.out;
}

// A leak of 10.0 mm in the first link, none in the second; the last row is of both.
TEST_F(AuditRobotCommand, TheLastRowIsOfAllLinks) {
  write("leaks.yml", spheres(0.09, 0.05));
  const std::string table = run({"audit-robot", "two.urdf", "leaks.yml"}).out;
  const std::size_t last = table.find("\nall ");
  ASSERT_NE(last, table.npos) << table;
  std::istringstream row(table.substr(last + 5));
  std::string spheres, leak, to, upper, rest;
  row >> spheres >> leak >> to >> upper;
  std::getline(row, rest);
  EXPECT_EQ(spheres, "2");
  EXPECT_EQ(leak + to, "10.0to");
  EXPECT_EQ(rest.substr(rest.find_last_of(' ')), " NO");
}

// The half edges of the base are 100, 0.5 and 0.5 mm, its sphere of 90 mm is about the middle.
TEST_F(AuditRobotCommand, TheTextSaysWhereLinksLeak) {
  write("leaks.yml", spheres(0.09, 0.05));
  const std::string text = run({"audit-robot", "two.urdf", "leaks.yml"}).out;
  const std::string heading = "\ndeepest leaks at (x, y, z), in the frame of the link:\n";
  const std::size_t places = text.find(heading);
  ASSERT_NE(places, text.npos) << text;
  std::istringstream row(text.substr(places + heading.size()));
  std::string link, x, y, z;
  row >> link >> x >> y >> z;
  EXPECT_EQ(link, "base");
  EXPECT_NEAR(std::abs(std::stod(x.substr(1))), 100.0, 0.1) << text;
  EXPECT_NEAR(std::abs(std::stod(y)), 0.5, 0.1) << text;
  EXPECT_NEAR(std::abs(std::stod(z)), 0.5, 0.1) << text;
  row >> link;
  EXPECT_EQ(link, "next:") << "the arm does not leak: " << text;
  for (std::istringstream lines(text); std::getline(lines, link);) {
    const bool is_step = link.find("spherule ") != link.npos;
    EXPECT_TRUE(is_step || link.size() <= 100u) << link;
  }
  write("good.yml", spheres(0.12, 0.05));
  EXPECT_EQ(run({"audit-robot", "two.urdf", "good.yml"}).out.find("deepest leaks"), text.npos);
}

TEST_F(AuditRobotCommand, LevelsAreChosen) {
  const auto level = [](const char* radius) {
    return std::string(R"({"spheres": [{"origin": [0, 0, 0], "radius": )") + radius + "}]}";
  };
  write("levels.json", R"({"base": [)" + level("0.09") + "," + level("0.12") + R"(], "arm": [)" +
                           level("0.05") + "," + level("0.05") + "]}");
  EXPECT_EQ(run({"audit-robot", "two.urdf", "levels.json"}).exit_code, 0);
  EXPECT_EQ(run({"audit-robot", "two.urdf", "levels.json", "--level", "0"}).exit_code, 1);
  expect_refusal({"audit-robot", "two.urdf", "levels.json", "--level", "2"}, "has only 2 levels");
}

TEST_F(AuditRobotCommand, PosesDecide) {
  write("arm.json",
        "{\"base\": {\"centers\": [], \"radii\": []}, \"arm\": {\"centers\": [[0, 0, 0], [0.3, 0, "
        "0]], "
        "\"radii\": [0.05, 0.105]}}");
  write("good.csv", "turn\n3.14159\n");
  write("bad.csv", "3.14159\n0\n");
  EXPECT_EQ(run({"audit-robot", "two.urdf", "arm.json"}).exit_code, 1);
  const Outcome good = run({"audit-robot", "two.urdf", "arm.json", "--poses", "good.csv"});
  EXPECT_EQ(good.exit_code, 0) << good.err << good.out;
  const Outcome bad = run({"audit-robot", "two.urdf", "arm.json", "--poses", "bad.csv", "--json"});
  EXPECT_EQ(bad.exit_code, 1) << bad.err;
  const json poses = json::parse(bad.out).at("configurations");
  EXPECT_EQ(poses.at(0).at("deepest_link"), "");
  EXPECT_FALSE(poses.at(0).contains("deepest_leak"));
  // In the second the arm's spheres are all beyond 0.195 on the x axis.
  EXPECT_NEAR(poses.at(1).at("deepest_leak").at(0).get<double>(), -0.1, 1e-3);
  EXPECT_EQ(poses.at(1).at("deepest_link"), "base");
  if (test::kSanitized) return;  // each run takes seconds
  const std::string text = run({"audit-robot", "two.urdf", "arm.json", "--poses", "bad.csv"}).out;
  EXPECT_NE(text.find(", at base, (-100.0, "), text.npos) << text;
  EXPECT_NE(text.find(") in the frame of the root\n"), text.npos) << text;
  write("degrees.csv", "turn\n180\n");
  const Outcome degrees =
      run({"audit-robot", "two.urdf", "arm.json", "--poses", "degrees.csv", "--degrees"});
  EXPECT_EQ(degrees.exit_code, 0) << degrees.err << degrees.out;
  EXPECT_EQ(degrees.err, "");
  const Outcome radians = run({"audit-robot", "two.urdf", "arm.json", "--poses", "degrees.csv"});
  EXPECT_NE(radians.err.find("its angles look like degrees"), std::string::npos) << radians.err;
}

TEST_F(AuditRobotCommand, WhatIsOfferedRepeatsTheOptions) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const auto level = [](const char* radius) {
    return std::string(R"([{"spheres": [{"origin": [0, 0, 0], "radius": )") + radius + "}]}]";
  };
  write("leaks.json", R"({"base": )" + level("0.09") + R"(, "arm": )" + level("0.05") + "}");
  write("path.csv", "0\n");
  std::vector<std::string> line = {"audit-robot", "two.urdf", "leaks.json",     "--package", "x=.",
                                   "--max-error", "0.03",     "--min-external", "0.1"};
  const std::string given = "two.urdf leaks.json --geometry collision --package x=. ";
  const std::string table = run(line).out;
  EXPECT_NE(table.find("next: spherule view " + given + "--leaks -o leaks.html"), table.npos)
      << table;
  EXPECT_NE(table.find("spherule audit-robot " + given +
                       "--max-error 0.03 --min-external 0.1 --repair leaks.mended.json"),
            table.npos)
      << table;
  line.insert(line.end(), {"--level", "0"});
  const std::string of_level = run(line).out;
  EXPECT_EQ(of_level.find("spherule view"), table.npos) << of_level;
  EXPECT_NE(of_level.find("--level 0 --max-error 0.03"), table.npos) << of_level;
  const Outcome posed = run({"audit-robot", "two.urdf", "leaks.json", "--poses", "path.csv"});
  EXPECT_EQ(posed.exit_code, 1) << posed.err;
  EXPECT_EQ(posed.out.find("--repair"), table.npos) << posed.out;
  EXPECT_NE(posed.out.find("next: spherule view"), table.npos) << posed.out;
}

// The spheres of one mesh are those of the only link; `view` would take our own for a part's.
TEST_F(AuditRobotCommand, WhatIsOfferedForOneMeshWorks) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  write("one.urdf", R"(<robot name="one"><link name="flange"/><link name="tool">
    <collision><geometry><box size="0.2 0.002 0.002"/></geometry></collision></link>
    <joint name="fix" type="fixed"><parent link="flange"/><child link="tool"/></joint></robot>)");
  write("leaks.json", R"([{"spheres": [{"origin": [0, 0, 0], "radius": 0.09}]}])");
  const Outcome leaks = run({"audit-robot", "one.urdf", "leaks.json", "--max-error", "0.03"});
  EXPECT_EQ(leaks.exit_code, 1) << leaks.err;
  EXPECT_NE(leaks.out.find("next: spherule view one.urdf leaks.json --geometry collision "
                           "--leaks -o leaks.html "),
            leaks.out.npos)
      << leaks.out;
  EXPECT_EQ(run({"view", "one.urdf", "leaks.json", "--geometry", "collision", "--leaks", "-o",
                 "leaks.html"})
                .exit_code,
            0);
  EXPECT_NE(leaks.out.find("      spherule audit-robot one.urdf leaks.json --geometry collision "
                           "--max-error 0.03 --repair leaks.mended.json "),
            leaks.out.npos)
      << leaks.out;
  const Outcome mended = run({"audit-robot", "one.urdf", "leaks.json", "--geometry", "collision",
                              "--max-error", "0.03", "--repair", "leaks.mended.json"});
  EXPECT_EQ(mended.exit_code, 0) << mended.err;
  // What it wrote names the link, so that it can be examined.
  EXPECT_EQ(run({"view", "one.urdf", "leaks.mended.json", "-o", "page.html"}).exit_code, 0);
  write("ours.json", R"({"format": "spherule-spheres", "version": 1, "options": {},
    "spheres": [{"center": [0, 0, 0], "radius": 0.09}]})");
  const Outcome ours = run({"audit-robot", "one.urdf", "ours.json", "--max-error", "0.03"});
  EXPECT_EQ(ours.exit_code, 1) << ours.err;
  EXPECT_EQ(ours.out.find("spherule view"), ours.out.npos) << ours.out;
}

TEST_F(AuditRobotCommand, ThePageOfARepairShowsTheRepairedSpheres) {
  write_robot_spheres(
      {.robot = "two", .links = {{"base", {{{0, 0, 0}, 0.09}}}, {"arm", {{{0, 0, 0}, 0.05}}}}},
      SphereFormat::kSpherule, {}, folder_ / "leaky.json");
  const Outcome mended = run({"audit-robot", "two.urdf", "leaky.json", "--repair", "mended.json",
                              "--max-error", "0.03", "--view", "page.html"});
  EXPECT_EQ(mended.exit_code, 0) << mended.err;
  const std::string page = read("page.html");
  EXPECT_NE(page.find("mended.json"), std::string::npos);
  EXPECT_NE(page.find("all links covered (proved)"), std::string::npos);
}

TEST_F(AuditRobotCommand, RepairKeepsTheFormat) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const RobotSpheres leaky{.robot = "two",
                           .links = {{"base", {{{0, 0, 0}, 0.09}}}, {"arm", {{{0, 0, 0}, 0.05}}}}};
  const std::vector<SphereFormat> formats = {SphereFormat::kCurobo, SphereFormat::kUrdf,
                                             SphereFormat::kXrdf,   SphereFormat::kSrdf,
                                             SphereFormat::kFoam,   SphereFormat::kSpherule};
  for (const SphereFormat format : formats) {
    SCOPED_TRACE(std::string(name_of(format)));
    write_robot_spheres(leaky, format, {.urdf = folder_ / "two.urdf"}, folder_ / "leaky");
    EXPECT_EQ(run({"audit-robot", "two.urdf", "leaky"}).exit_code, 1);
    const Outcome mended =
        run({"audit-robot", "two.urdf", "leaky", "--repair", "mended", "--max-error", "0.03"});
    EXPECT_EQ(mended.exit_code, 0) << mended.err;
    EXPECT_EQ(read_robot_spheres(folder_ / "mended").format, format);
    EXPECT_EQ(run({"audit-robot", "two.urdf", "mended", "--max-error", "0.03"}).exit_code, 0);
  }
}

TEST_F(AuditRobotCommand, BuffersBelowZeroShrink) {
  write("shrunk.yml", spheres(0.12, 0.05) + "    collision_sphere_buffer: -0.02\n");
  const Outcome result = run({"audit-robot", "two.urdf", "shrunk.yml"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_NE(result.err.find("shrink"), std::string::npos);
  write("one.yml", spheres(0.12, 0.05) + "    collision_sphere_buffer: {base: -0.02}\n");
  const Outcome one = run({"audit-robot", "two.urdf", "one.yml"});
  EXPECT_EQ(one.exit_code, 1) << one.err;
  EXPECT_NE(one.err.find("shrink"), std::string::npos);
  expect_refusal({"audit-robot", "two.urdf", "shrunk.yml", "--repair", "out.yml"},
                 "buffer below 0");
}

TEST_F(AuditRobotCommand, BadInput) {
  write("good.yml", spheres(0.12, 0.05));
  write("one.json", "[{\"spheres\": []}]");
  write("columns.json", "{\"arm\": {\"centers\": [], \"radii\": []}}");
  write("poses.csv", "1, 2\n");
  expect_refusal({"audit-robot", "missing.urdf", "good.yml"}, "missing.urdf: ");
  expect_refusal({"audit-robot", "two.urdf", "missing.yml"}, "missing.yml: ");
  expect_refusal({"audit-robot", "two.urdf", "two.urdf"}, "holds no spheres");
  expect_refusal({"audit-robot", "two.urdf", "one.json"}, "the name of their link");
  expect_refusal({"audit-robot", "two.urdf", "columns.json", "--repair", "out"}, "is read only");
  expect_refusal({"audit-robot", "two.urdf", "good.yml", "--poses", "poses.csv"}, "poses.csv: ");
  write("poses.csv", "# far\n1\n-750\n");
  const Outcome far = run({"audit-robot", "two.urdf", "good.yml", "--poses", "poses.csv"});
  EXPECT_EQ(far.exit_code, 2);
  EXPECT_NE(far.err.find("warning: poses.csv: 1 of 2 configurations is outside the joint limits"),
            std::string::npos)
      << far.err;
  EXPECT_NE(far.err.find("\nspherule: poses.csv: line 3: joint turn is at a position beyond 100"),
            std::string::npos)
      << far.err;
  expect_refusal({"audit-robot", "two.urdf", "good.yml", "--degrees"}, "--degrees");
  expect_refusal({"audit-robot", "two.urdf", "good.yml", "--geometry", "other"}, "--geometry");
  expect_refusal({"audit-robot", "two.urdf", "good.yml", "--max-error", "-1"}, "--max-error");
  expect_refusal({"audit-robot", "two.urdf", "good.yml", "--threads", "-1"}, "--threads");
  expect_refusal({"audit-robot", "two.urdf", "good.yml", "--repair", "good.yml"}, "good.yml");
  expect_refusal({"audit-robot", "two.urdf", "one.json", "--link", "amr"},
                 "--link: the robot has no link 'amr'");
  expect_refusal({"audit-robot", "two.urdf", "good.yml", "--link", "arm"},
                 "--link: good.yml names its links itself");
  expect_refusal({"audit-robot", "two.urdf", "good.yml", "--level", "-1"}, "and not negative");
  EXPECT_EQ(run({"audit-robot", "two.urdf", "one.json", "--link", "arm"}).exit_code, 1);
}

}  // namespace
}  // namespace spherule
