// SPDX-License-Identifier: BSD-3-Clause
// `check` where it makes spheres itself, of the robot and of what is attached to it.

#include "tests/cli/check_fixture.h"
#include "tests/support/effort.h"

#include <string>
#include <vector>

namespace spherule {
namespace {

using nlohmann::json;

TEST_F(CheckTest, CoversTheRobotAndAToolWhereThereAreNoSpheres) {
  write_box("tool.stl", {0.1, 0.02, 0.02});
  write("cell.json", wall_and(R"("attached": [{"name": "tool", "link": "wrist",
    "mesh": {"file": "tool.stl"}, "pose": {"position": [0.05, -0.01, -0.01]}}],
    "allowed_contacts": [{"body": "tool", "other": "hand"}])"));
  write("path.csv", "-0.3 0\n-0.1 0\n0.03 0\n");
  const Outcome outcome = run({"check", "slider.urdf", "cell.json", "path.csv", "--max-error",
                               "0.04", "--effort", "0", "--json"});
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  const json report = json::parse(outcome.out);
  EXPECT_EQ(report["colliding"], 2);
  EXPECT_EQ(report["first_contact"]["first"]["name"], "tool");
  EXPECT_EQ(report["first_contact"]["line"], 2);
}

// Which of a link's geometries stands for it: what is covered, and what must stand in spheres.
TEST_F(CheckTest, GeometryIsWhatIsAskedFor) {
  write("two.urdf", R"(<robot name="two"><link name="base"/><link name="hand">
    <visual><geometry><box size="0.02 0.02 0.02"/></geometry></visual>
    <collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
    <joint name="slide" type="prismatic"><parent link="base"/><child link="hand"/>
      <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>)");
  write("path.csv", "-0.045\n");
  std::vector<std::string> line = {"check",       "two.urdf", "cell.json", "path.csv",
                                   "--max-error", "0.02",     "--effort",  "0"};
  EXPECT_EQ(run(line).exit_code, 1);
  line.insert(line.end(), {"--geometry", "visual"});
  EXPECT_EQ(run(line).exit_code, 0);
  // A link that is only to be seen needs spheres only where the visual geometry stands for it.
  write("seen.urdf", R"(<robot name="seen"><link name="base"><visual><geometry>
    <sphere radius="0.02"/></geometry></visual></link><link name="hand"/>
    <joint name="slide" type="prismatic"><parent link="base"/><child link="hand"/>
      <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>)");
  write("path.csv", "-0.1\n");
  line = {"check", "seen.urdf", "cell.json", "path.csv", "--spheres", "slider.json"};
  EXPECT_EQ(run(line).exit_code, 0);
  line.insert(line.end(), {"--geometry", "visual"});
  const Outcome seen = run(line);
  EXPECT_EQ(seen.exit_code, 1);
  EXPECT_NE(seen.err.find("link base has a shape but no spheres"), std::string::npos) << seen.err;
}

// In which frame they are nobody says.
TEST_F(CheckTest, SpheresOfOneMeshAreRefused) {
  write("one.json", R"({"format": "spherule-spheres", "version": 1, "options": {},
    "spheres": [{"center": [0, 0, 0], "radius": 0.05}]})");
  expect_refusal({"check", "slider.urdf", "cell.json", "path.csv", "--spheres", "one.json"},
                 "one.json: holds the spheres of one mesh");
}

TEST_F(CheckTest, WarnsOfLinksAndToolsWhoseMeshesAreOpen) {
  write("sheet.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nf 1 2 3\n");
  write("sheet.urdf", R"(<robot name="sheet"><link name="base"/><link name="hand"><collision>
    <geometry><mesh filename="sheet.obj"/></geometry></collision></link>
    <joint name="slide" type="prismatic"><parent link="base"/><child link="hand"/>
      <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>)");
  write("cell.json", wall_and(R"("attached": [{"name": "tool", "link": "hand",
    "mesh": {"file": "sheet.obj"}, "pose": {"position": [0.5, 0, 0]}}])"));
  write("path.csv", "1\n");
  const Outcome outcome = run({"check", "sheet.urdf", "cell.json", "path.csv", "--effort", "0"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  for (const std::string warning : {"link hand: its mesh is open", "tool: its mesh is open"}) {
    EXPECT_NE(outcome.err.find("spherule: warning: " + warning), std::string::npos) << outcome.err;
  }
}

// What is attached has its own max error, and one geometry, whatever the robot's are.
TEST_F(CheckTest, AttachedMeshesAreCoveredAsTheySay) {
  write_box("tool.stl", {0.1, 0.1, 0.1});
  write("seen.urdf", R"(<robot name="seen"><link name="base"/><link name="hand"><visual><geometry>
    <sphere radius="0.01"/></geometry></visual></link>
    <joint name="slide" type="prismatic"><parent link="base"/><child link="hand"/>
      <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>)");
  // 0.025 from the wall: one sphere around the cube reaches 0.037 beyond its faces.
  write("path.csv", "-0.3255\n");
  const auto exit_code_with = [this](const std::string& max_error) {
    write("cell.json", wall_and(R"("attached": [{"name": "tool", "link": "hand",
      "mesh": {"file": "tool.stl"}, "pose": {"position": [0.2, -0.05, -0.05]})" +
                                max_error + "}]"));
    const Outcome outcome = run({"check", "seen.urdf", "cell.json", "path.csv", "--geometry",
                                 "visual", "--max-error", "0.04", "--effort", "0"});
    EXPECT_EQ(outcome.err, "");
    return outcome.exit_code;
  };
  EXPECT_EQ(exit_code_with(""), 1);
  EXPECT_EQ(exit_code_with(R"(, "max_error": 0.02)"), 0);
}

// Two cubes that a gap of 0.05 parts, and which one sphere around each makes touch.
TEST_F(CheckTest, BodiesThatAlwaysTouchGetAdvice) {
  if (test::kSanitized) GTEST_SKIP() << test::kLeftToRelease;
  const std::string cube =
      R"(<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>)";
  write("cubes.urdf", R"(<robot name="cubes"><link name="a">)" + cube +
                          R"(<link name="b"/><link name="c">)" + cube +
                          R"(<joint name="j" type="prismatic"><parent link="a"/><child link="b"/>
      <origin xyz="0.15 0 0"/><axis xyz="1 0 0"/>
      <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
    <joint name="k" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/>
      <limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>)");
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
    {"name": "wall", "box": {"size": [0.1, 1, 1]}, "pose": {"position": [-0.09, 0, 0]}}],
    "allowed_contacts": [{"body": "c", "other": "wall"}]})");
  const auto checked_with = [this](const std::vector<std::string>& more) {
    std::vector<std::string> line = {"check",       "cubes.urdf", "cell.json", "path.csv",
                                     "--max-error", "0.04",       "--effort",  "0"};
    line.insert(line.end(), more.begin(), more.end());
    return run(line);
  };
  write("path.csv", "0 0\n0 0.001\n0.001 0\n");
  const std::string advice = "c and a touch all the time\n";
  const std::string table = checked_with({}).out;
  EXPECT_NE(table.find("\n" + advice +
                       "where they may, name them under \"allowed_contacts\" in "
                       "cell.json\nnext: spherule check cubes.urdf cell.json "
                       "path.csv --max-error 0.02 --effort 0 --geometry collision "
                       "   # finer spheres may part them\n"),
            table.npos)
      << table;
  // The wall touches a all the time, too; that is no matter of spheres on links.
  EXPECT_EQ(table.find("wall touch all"), table.npos) << table;
  EXPECT_NE(table.find("wall"), table.npos) << table;
  const std::string edges = checked_with({"--edges", "--resolution", "0.002"}).out;
  EXPECT_NE(edges.find(advice), edges.npos) << edges;
  EXPECT_NE(edges.find("path.csv --edges --resolution 0.002 --max-error 0.02 "), edges.npos)
      << edges;
  EXPECT_TRUE(json::accept(checked_with({"--json"}).out));
  const Outcome finer = run({"check", "cubes.urdf", "cell.json", "path.csv", "--max-error", "0.02",
                             "--effort", "0", "--json"});
  EXPECT_EQ(finer.exit_code, 1) << finer.err;
  const json pairs = json::parse(finer.out)["pairs"];
  ASSERT_EQ(pairs.size(), 1U) << pairs;
  EXPECT_EQ(pairs[0]["second"], "wall");
  // Spheres that were given may be finer than any that check would fit.
  write("cubes.json", R"({"a": {"centers": [[0, 0, 0]], "radii": [0.087]},
                          "c": {"centers": [[0, 0, 0]], "radii": [0.087]}})");
  const std::string given = checked_with({"--spheres", "cubes.json"}).out;
  EXPECT_NE(given.find(advice), given.npos) << given;
  EXPECT_EQ(given.find("next:"), given.npos) << given;
  // Not all the time: once apart; or only once examined.
  for (const std::string path : {"0 0\n0 1\n", "0 0\n"}) {
    write("path.csv", path);
    const std::string other = checked_with({}).out;
    EXPECT_NE(other.find("collision"), other.npos) << other;
    EXPECT_EQ(other.find("all the time"), other.npos) << other;
  }
  // On every motion, but each of them starts free.
  write("empty.json", R"({"format": "spherule-scene", "version": 1, "obstacles": []})");
  write("path.csv", "0 1\n0 -1\n0 1\n");
  const std::string through = run({"check", "cubes.urdf", "empty.json", "path.csv", "--edges",
                                   "--max-error", "0.04", "--effort", "0"})
                                  .out;
  EXPECT_NE(through.find("2 of them collide"), through.npos) << through;
  EXPECT_EQ(through.find("all the time"), through.npos) << through;
}

}  // namespace
}  // namespace spherule
