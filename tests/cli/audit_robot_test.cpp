// SPDX-License-Identifier: BSD-3-Clause
#include "robot/formats/sphere_formats.h"
#include "tests/cli/command_test_support.h"
#include "tests/support/effort.h"

#include <cmath>
#include <sstream>

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
  expect_said(0, "audit-robot two.urdf good.yml", "cuRobo yml");
  write("leaks.yml", spheres(0.09, 0.05));
  const Outcome leaks = expect_exit(1, "audit-robot two.urdf leaks.yml");
  EXPECT_TRUE(has(leaks.out, "NO"));
  expect_exit(0, "audit-robot two.urdf leaks.yml --geometry visual");
}

TEST_F(AuditRobotCommand, Json) {
  write("leaks.yml", spheres(0.09, 0.05) +
                         "      ghost:\n      - {center: [0, 0, 0], radius: 1}\n"
                         "      - {center: [0, 0, 0], radius: -1}\n");
  const Words command = "audit-robot two.urdf leaks.yml --json --ignore-unknown-links";
  const Outcome result = expect_exit(1, command);
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
  EXPECT_EQ(run(joined(command, "--threads 1")).out, result.out);
}

TEST_F(AuditRobotCommand, LevelsAreChosen) {
  const auto level = [](const char* radius) {
    return std::string(R"({"spheres": [{"origin": [0, 0, 0], "radius": )") + radius + "}]}";
  };
  write("levels.json", R"({"base": [)" + level("0.09") + "," + level("0.12") + R"(], "arm": [)" +
                           level("0.05") + "," + level("0.05") + "]}");
  expect_exit(0, "audit-robot two.urdf levels.json");
  expect_exit(1, "audit-robot two.urdf levels.json --level 0");
  expect_refusal("audit-robot two.urdf levels.json --level 2", "has only 2 levels");
}

TEST_F(AuditRobotCommand, PosesDecide) {
  write("arm.json",
        "{\"base\": {\"centers\": [], \"radii\": []}, \"arm\": {\"centers\": [[0, 0, 0], [0.3, 0, "
        "0]], "
        "\"radii\": [0.05, 0.105]}}");
  write("good.csv", "turn\n3.14159\n");
  write("bad.csv", "3.14159\n0\n");
  expect_exit(1, "audit-robot two.urdf arm.json");
  expect_exit(0, "audit-robot two.urdf arm.json --poses good.csv");
  const Outcome bad = expect_exit(1, "audit-robot two.urdf arm.json --poses bad.csv --json");
  const json poses = json::parse(bad.out).at("configurations");
  EXPECT_EQ(poses.at(0).at("deepest_link"), "");
  EXPECT_FALSE(poses.at(0).contains("deepest_leak"));
  // In the second the arm's spheres are all beyond 0.195 on the x axis.
  EXPECT_NEAR(poses.at(1).at("deepest_leak").at(0).get<double>(), -0.1, 1e-3);
  EXPECT_EQ(poses.at(1).at("deepest_link"), "base");
  if (test::kSanitized) return;  // each run takes seconds
  const std::string text = run("audit-robot two.urdf arm.json --poses bad.csv").out;
  EXPECT_TRUE(has(text, ", at base, (-100.0, "));
  EXPECT_TRUE(has(text, ") in the frame of the root\n"));
  write("degrees.csv", "turn\n180\n");
  const Outcome degrees =
      expect_exit(0, "audit-robot two.urdf arm.json --poses degrees.csv --degrees");
  EXPECT_EQ(degrees.err, "");
  const Outcome radians = run("audit-robot two.urdf arm.json --poses degrees.csv");
  EXPECT_TRUE(has(radians.err, "its angles look like degrees"));
}

TEST_F(AuditRobotCommand, ThePageOfARepairShowsTheRepairedSpheres) {
  write_robot_spheres(
      {.robot = "two", .links = {{"base", {{{0, 0, 0}, 0.09}}}, {"arm", {{{0, 0, 0}, 0.05}}}}},
      SphereFormat::kSpherule, {}, folder_ / "leaky.json");
  const Outcome mended = expect_exit(
      0, "audit-robot two.urdf leaky.json --repair mended.json --max-error 0.03 --view page.html");
  const std::string page = read("page.html");
  EXPECT_TRUE(has(page, "mended.json"));
  EXPECT_TRUE(has(page, "all links covered (proved)"));
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
    expect_exit(1, "audit-robot two.urdf leaky");
    const Outcome mended =
        expect_exit(0, "audit-robot two.urdf leaky --repair mended --max-error 0.03");
    EXPECT_EQ(read_robot_spheres(folder_ / "mended").format, format);
    expect_exit(0, "audit-robot two.urdf mended --max-error 0.03");
  }
}

TEST_F(AuditRobotCommand, BuffersBelowZeroShrink) {
  write("shrunk.yml", spheres(0.12, 0.05) + "    collision_sphere_buffer: -0.02\n");
  expect_said(1, "audit-robot two.urdf shrunk.yml", "shrink");
  write("one.yml", spheres(0.12, 0.05) + "    collision_sphere_buffer: {base: -0.02}\n");
  expect_said(1, "audit-robot two.urdf one.yml", "shrink");
  expect_refusal("audit-robot two.urdf shrunk.yml --repair out.yml", "buffer below 0");
}

TEST_F(AuditRobotCommand, BadInput) {
  write("good.yml", spheres(0.12, 0.05));
  write("one.json", "[{\"spheres\": []}]");
  write("columns.json", "{\"arm\": {\"centers\": [], \"radii\": []}}");
  write("poses.csv", "1, 2\n");
  expect_refusals({{"audit-robot missing.urdf good.yml", "missing.urdf: "},
                   {"audit-robot two.urdf missing.yml", "missing.yml: "},
                   {"audit-robot two.urdf two.urdf", "holds no spheres"},
                   {"audit-robot two.urdf one.json", "the name of their link"},
                   {"audit-robot two.urdf columns.json --repair out", "is read only"},
                   {"audit-robot two.urdf good.yml --poses poses.csv", "poses.csv: "}});
  write("poses.csv", "# far\n1\n-750\n");
  const Outcome far = expect_exit(2, "audit-robot two.urdf good.yml --poses poses.csv");
  EXPECT_TRUE(
      has(far.err, "warning: poses.csv: 1 of 2 configurations is outside the joint limits"));
  EXPECT_TRUE(
      has(far.err, "\nspherule: poses.csv: line 3: joint turn is at a position beyond 100"));
  expect_refusals(
      {{"audit-robot two.urdf good.yml --degrees", "--degrees"},
       {"audit-robot two.urdf good.yml --geometry other", "--geometry"},
       {"audit-robot two.urdf good.yml --max-error -1", "--max-error"},
       {"audit-robot two.urdf good.yml --threads -1", "--threads"},
       {"audit-robot two.urdf good.yml --repair good.yml", "good.yml"},
       {"audit-robot two.urdf one.json --link amr", "--link: the robot has no link 'amr'"},
       {"audit-robot two.urdf good.yml --link arm", "--link: good.yml names its links itself"},
       {"audit-robot two.urdf good.yml --level -1", "and not negative"}});
  expect_exit(1, "audit-robot two.urdf one.json --link arm");
}

}  // namespace
}  // namespace spherule
