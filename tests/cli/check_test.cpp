// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"
#include "tests/cli/robot_fixtures.h"
#include "tests/support/effort.h"

namespace spherule {
namespace {

using nlohmann::json;

TEST_F(CheckTest, ConfigurationsOrMotions) {
  const json configurations = checked(0);
  EXPECT_EQ(configurations["verdict"], "free");
  EXPECT_EQ(configurations["configurations"], 2);
  EXPECT_TRUE(configurations["first_contact"].is_null());

  const json motions = checked(1, "--edges");
  EXPECT_EQ(motions["verdict"], "collision");
  EXPECT_EQ(motions["motions"], 1);
  EXPECT_EQ(motions["colliding"], 1);
  const json& contact = motions["first_contact"];
  EXPECT_EQ(contact["line"], 1);
  EXPECT_EQ(contact["to_line"], 2);
  EXPECT_NEAR(contact["fraction"].get<double>(), (1.0 - 0.0505) / 2.0, 2e-4);
  EXPECT_EQ(contact["first"]["name"], "hand");
  EXPECT_EQ(contact["first"]["kind"], "link");
  EXPECT_EQ(contact["second"]["name"], "wall");
  EXPECT_EQ(contact["second"]["kind"], "obstacle");

  // Not only where the motion first touches: at most 0.0505 deep, where the sphere is on the wall.
  EXPECT_NEAR(contact["depth"].get<double>(), 0.0, 1e-3);
  EXPECT_GT(motions["worst_contact"]["depth"], 0.03);
  EXPECT_LE(motions["worst_contact"]["depth"], 0.0506);
  EXPECT_GT(motions["worst_contact"]["fraction"], contact["fraction"]);
  EXPECT_EQ(motions["pairs"][0]["count"], 1);

  write("path.csv", "turn,slide\n0,1\n90,0.5\n");
  EXPECT_EQ(checked(0, "--edges")["verdict"], "free");
}

TEST_F(CheckTest, FirstAndDeepestContacts) {
  write("path.csv", "slide,turn\n# far\n-1,0\n0.04,0\n0.01,0\n1,0\n0.03,0\n");
  const json report = checked(1);
  EXPECT_EQ(report["colliding"], 3);
  ASSERT_EQ(report["pairs"].size(), 1u);
  EXPECT_EQ(report["pairs"][0]["count"], 3);
  EXPECT_EQ(report["first_contact"]["line"], 4);
  EXPECT_EQ(report["worst_contact"]["line"], 5);
  EXPECT_NEAR(report["first_contact"]["depth"].get<double>(), 0.0105, 1e-6);
  EXPECT_NEAR(report["worst_contact"]["depth"].get<double>(), 0.0405, 1e-6);
  const Outcome table = expect_exit(1, command({}));
  EXPECT_TRUE(has(table.out, "collision: 5 configurations, 3 of them collide"));
  EXPECT_TRUE(has(table.out, "40.5"));
}

// What a motion meets behind its first contact is a pair, too.
TEST_F(CheckTest, AllThatAMotionTouchesIsNamed) {
  write("cell.json",
        scene(ball("near", "0.1", "-0.5, 0, 0") + "," + ball("far", "0.1", "0.5, 0, 0")));
  const json report = checked(1, "--edges");
  ASSERT_EQ(report["pairs"].size(), 2u);
  for (const std::size_t i : {0U, 1U}) {
    const json& pair = report["pairs"][i];
    EXPECT_EQ(pair["second"], i == 0 ? "near" : "far");
    EXPECT_EQ(pair["count"], 1);
    EXPECT_GT(pair["worst_contact"]["depth"], 0.1);
    EXPECT_NEAR(pair["worst_contact"]["fraction"].get<double>(), i == 0 ? 0.25 : 0.75, 0.03);
  }
}

TEST_F(CheckTest, GrazingIsNotProved) {
  write("cell.json",
        scene(R"({"name": "floor", "half_space": {}, "pose": {"position": [0, 0, -0.050001]}})"));
  // Along the floor, which is a plane, a micrometre is enough.
  EXPECT_EQ(checked(0, "--edges --resolution 0.01")["verdict"], "free");
  // Only where x is 0.47, shortly before three quarters of the way.
  write("cell.json", scene(ball("post", "0.1", "0.47, 0.150000001, 0")));
  const json report = checked(1, "--edges --resolution 0.01");
  EXPECT_EQ(report["verdict"], "not proved");
  EXPECT_EQ(report["colliding"], 0);
  const json& open = report["not_proved"];
  ASSERT_EQ(open.size(), 1u);
  EXPECT_EQ(open[0]["line"], 1);
  EXPECT_EQ(open[0]["to_line"], 2);
  EXPECT_GT(open[0]["free_until"], 0.5);
  EXPECT_LT(open[0]["free_until"], 0.75);
}

TEST_F(CheckTest, ObstaclesOfAllKinds) {
  write_box("block.stl", {1000, 1000, 1000});
  write_spheres("balls.json", {{0.0, 0.0, 0.0, 0.01}});
  run("tree balls.json -o balls.tree");
  write("scan.xyz", "0 0 0\n0.001 0 0\n");
  const auto place = [this](const std::string& shape, const std::string& position) {
    write("cell.json", scene(R"({"name": "thing", )" + shape + R"(, "pose": {"position": [)" +
                             position + "]}}"));
  };
  for (const std::string shape :
       {R"("mesh": {"file": "block.stl", "scale": 0.001})", R"("spheres": {"file": "balls.json"})",
        R"("tree": {"file": "balls.tree"})", R"("points": {"file": "scan.xyz", "radius": 0.01})",
        R"("ball": {"radius": 0.01})", R"("capsule": {"radius": 0.01, "length": 0.1})",
        R"("cylinder": {"radius": 0.01, "length": 0.1})"}) {
    SCOPED_TRACE(shape);
    place(shape, "1, 0, 0");
    write("path.csv", "0 0\n");
    EXPECT_EQ(checked(0)["verdict"], "free");
    // The hand is wholly inside the block.
    write("path.csv", shape.find("mesh") != std::string::npos ? "1.06 0\n" : "1 0\n");
    EXPECT_EQ(checked(1)["first_contact"]["second"]["name"], "thing");
  }
  place(R"("mesh": {"file": "block.stl", "scale": 0.001})", "0, -0.5, -0.5");
  write("path.csv", "0.5 0\n");
  EXPECT_EQ(checked(1)["colliding"], 1);
}

TEST_F(CheckTest, AToolWhoseTipMayTouch) {
  write_spheres("tool.json", {{0.0, 0.0, 0.0, 0.01}, {0.1, 0.0, 0.0, 0.02}});
  const std::string tool =
      R"("attached": [{"name": "tool", "link": "wrist", "spheres": {"file": "tool.json"},
                       "pose": {"position": [0.1, 0, 0]}}],
         "regions": [{"body": "tool", "name": "tip",
                      "ball": {"center": [0.1, 0, 0], "radius": 0.01}}])";
  write("path.csv", "-0.19 0\n");  // the tip, of which the centre is at 0.2
  write("cell.json", wall_and(tool));
  const json contact = checked(1)["first_contact"];
  EXPECT_EQ(contact["first"]["name"], "tool");
  EXPECT_EQ(contact["first"]["kind"], "attached");
  const std::string allowed =
      R"(, "allowed_contacts": [{"body": "tool", "region": "tip", "other": "wall"}])";
  write("cell.json", wall_and(tool + allowed));
  EXPECT_EQ(checked(0)["verdict"], "free");
  write("path.csv", "-0.09 0\n");  // the rest of it
  EXPECT_EQ(checked(1)["first_contact"]["first"]["name"], "tool");
  write("path.csv", "-0.19 3.14159\n");  // turned away
  EXPECT_EQ(checked(0)["verdict"], "free");
}

TEST_F(CheckTest, AddsPadding) {
  write("path.csv", "0.06 0\n");
  EXPECT_EQ(checked(0)["verdict"], "free");
  write("cell.json", wall_and(R"("padding": [{"body": "hand", "distance": 0.02}])"));
  const json contact = checked(1)["first_contact"];
  EXPECT_NEAR(contact["depth"].get<double>(), 0.0105, 1e-6);
  EXPECT_NEAR(contact["padding"].get<double>(), 0.02, 1e-12);
}

TEST_F(CheckTest, OneConfigurationHasNoMotion) {
  write("path.csv", "0.5 0\n");
  const json report = checked(0, "--edges");
  EXPECT_EQ(report["configurations"], 1);
  EXPECT_FALSE(report.contains("motions"));
}

TEST_F(CheckTest, TheLastMotionIsProvedToo) {
  write("path.csv", "-1 0\n-0.9 0\n1 0\n");
  const json report = checked(1, "--edges");
  EXPECT_EQ(report["motions"], 2);
  EXPECT_EQ(report["first_contact"]["line"], 2);
  EXPECT_EQ(report["first_contact"]["to_line"], 3);
  EXPECT_NEAR(report["first_contact"]["fraction"].get<double>(), (0.9 - 0.0505) / 1.9, 2e-4);
}

// Of several pairs, each has its own count, first and deepest contact.
TEST_F(CheckTest, PairsAreToldApart) {
  write("cell.json", scene(std::string(kWall) + "," + ball("post", "0.1", "0.5, 0, 0")));
  write("path.csv", "0.04 0\n0.4 0\n0.45 0\n");
  const json report = checked(1);
  ASSERT_EQ(report["pairs"].size(), 2u);
  EXPECT_EQ(report["first_contact"]["second"]["name"], "wall");
  EXPECT_EQ(report["worst_contact"]["second"]["name"], "post");
  EXPECT_EQ(report["pairs"][1]["count"], 2);
  EXPECT_EQ(report["pairs"][1]["first_contact"]["line"], 2);
  EXPECT_EQ(report["pairs"][1]["worst_contact"]["line"], 3);
}

// Links that touch each other; files of spheres and SRDF files name pairs that may.
TEST_F(CheckTest, PairsThatAreLeftOut) {
  write("three.urdf", R"(<robot name="three"><link name="a"/><link name="b"/><link name="c"/>
    <joint name="j" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="1 0 0"/>
      <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
    <joint name="k" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/>
      <limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>)");
  const std::string spheres =
      "collision_spheres:\n  a: [{center: [0, 0, 0], radius: 0.1}]\n"
      "  b: [{center: [0, 5, 0], radius: 0.1}]\n  c: [{center: [0, 0, 0], radius: 0.1}]\n";
  write("three.yml", spheres);
  write("cell.json", scene(""));
  write("path.csv", "0 0\n");
  const Words line = "check three.urdf cell.json path.csv --spheres three.yml";
  expect_exit(1, line);
  write("three.yml", spheres + "self_collision_ignore: {a: [c]}\ncollision_sphere_buffer: 0.01\n");
  const Outcome ignored = expect_exit(0, line);
  EXPECT_TRUE(has(ignored.err, "1 of the pairs of links are ignored"));
  EXPECT_TRUE(has(ignored.err, "its buffers are not added"));
  write("three.yml", spheres);
  write("cell.json", scene("", R"("robot": {"srdf": "three.srdf"})"));
  write("three.srdf", R"(<robot name="three"><disable_collisions link1="a" link2="gone"/>
    <disable_collisions link1="gone" link2="c"/></robot>)");
  expect_exit(1, line);
  write("three.srdf", R"(<robot name="three"><disable_collisions link1="a" link2="gone"/>
    <disable_collisions link1="c" link2="a"/></robot>)");
  expect_exit(0, line);
}

TEST_F(CheckTest, PointsAreScaledAndThinnedOut) {
  const auto checked_with = [this](const std::string& more, const std::string& verdict) {
    write("cell.json",
          scene(R"({"name": "scan", "points": {"file": "scan.xyz", "radius": 0.01)" + more + "}}"));
    EXPECT_EQ(checked(verdict == "free" ? 0 : 1)["verdict"], verdict);
  };
  write("scan.xyz", "1000 0 0\n1300 0 0\n");
  write("path.csv", "1.15 0\n");
  checked_with("", "free");
  checked_with(R"(, "scale": 0.001)", "free");
  checked_with(R"(, "scale": 0.001, "voxel": 2)", "collision");  // one sphere around both
  write("path.csv", "1.3 0\n");
  checked_with(R"(, "scale": 0.001)", "collision");
}

// What is not checked, or looks wrong, is a warning of one line; the exit code does not change.
TEST_F(CheckTest, Warnings) {
  write("sheet.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nf 1 2 3\n");
  write("mesh.json", wall_and(R"("attached": [{"name": "tool", "link": "hand",
    "mesh": {"file": "sheet.obj"}, "pose": {"position": [0.5, 0, 0]}}])"));
  write("far.json", scene(R"({"name": "table", "box": {"size": [600, 800, 50]},
    "pose": {"position": [600, 0, 0]}})"));
  write("off.json", R"({"hand": {"centers": [[0, 0, 0], [0, 0, 0]], "radii": [0.05, -1]}})");
  write("own.xrdf",
        "format: xrdf\nformat_version: 1.0\ncollision: {geometry: g}\n"
        "self_collision: {geometry: own}\ngeometry:\n"
        "  g: {spheres: {hand: [{center: [0, 0, 0], radius: 0.1}]}}\n  own: {spheres: {}}\n");
  write("two.json", R"({"hand": {"centers": [[0, 0, 0]], "radii": [0.05]},
                        "ghost": {"centers": [[0, 0, 0]], "radii": [0.05]}})");
  write("degrees.csv", "-1 0\n-1 45\n-1.1 90\n-1.1 180\n");
  struct Case {
    std::string scene, path, spheres, warning;
  };
  const std::vector<Case> cases = {
      {"mesh.json", "path.csv", "slider.json", "tool: its mesh is open"},
      {"far.json", "path.csv", "slider.json", "obstacle table is 600 m from the origin"},
      {"cell.json", "path.csv", "off.json", "1 spheres are switched off"},
      {"cell.json", "path.csv", "own.xrdf", "the geometry 'own' that it names for self-collisions"},
      {"cell.json", "path.csv", "two.json --ignore-unknown-links", "'ghost'; they are left out"},
      {"cell.json", "degrees.csv", "slider.json", "its angles look like degrees"}};
  for (const Case& one : cases) {
    const Outcome outcome = expect_exit(0, "check slider.urdf " + one.scene + " " + one.path +
                                               " --effort 0 --spheres " + one.spheres);
    EXPECT_TRUE(outcome.err.starts_with("spherule: warning: ")) << outcome.err;
    EXPECT_TRUE(has(outcome.err, one.warning));
  }
  EXPECT_EQ(run("check slider.urdf cell.json degrees.csv --degrees --spheres slider.json").err, "");
}

TEST_F(CheckTest, RefusesBadInput) {
  write("one.json", R"({"format": "spherule-spheres", "version": 1, "options": {},
    "spheres": [{"center": [0, 0, 0], "radius": 0.05}]})");
  write("arm.json", R"({"arm": {"centers": [[0, 0, 0]], "radii": [0.05]}})");
  write("huge.urdf", sliding("huge", "", box("collision", "1e4 1e4 1e4")));
  write("short.csv", "0\n");
  const std::string check = "check slider.urdf cell.json path.csv --spheres ";
  expect_refusals(
      {{command("--edges --resolution 0"), "resolution"},
       {command("--resolution 0.01"), "--edges"},
       {command("--continuous shortest"), "--edges"},
       {check + "arm.json", "arm.json: has spheres of 1 link that the robot has not got"},
       {check + "one.json", "one.json: holds the spheres of one mesh"},
       {check + "slider.json --pairs none.pairs", "none."},
       {check + "slider.json --view path.csv", "path.csv"},
       {"check none.urdf cell.json path.csv", "none.urdf"},
       {"check huge.urdf cell.json short.csv", "link 'hand': is"},
       {"check huge.urdf cell.json short.csv --pairs none.pairs", "none."},
       {"check slider.urdf", "scene"}});
  const std::vector<std::pair<std::string, std::string>> scenes = {
      {R"("obstacle": [])", "cell.json: the key 'obstacle' is not known here"},
      {R"("allowed_contacts": [{"body": "arm", "other": "wall"}])", "arm"},
      {R"("padding": [{"body": "hnad", "distance": 0.1}])", "hnad: there is no link"},
      {R"("attached": [{"name": "t", "link": "hand", "mesh": {"file": "none.stl"}}])", "none.stl"},
      {R"("attached": [{"name": "t", "link": "hnad", "tree": {"file": "t"}}])", "cell.json: "},
      {R"("regions": [{"body": "hnad", "name": "tip", "ball": {"center": [0, 0, 0], "radius": 1}}])",
       "hnad: "},
      {R"("robot": {"srdf": "none.srdf"})", "none.srdf: "}};
  for (const auto& [keys, reason] : scenes) {
    write("cell.json", wall_and(keys));
    expect_refusal(command({}), reason);
    // Before a robot is covered, as this one cannot be.
    expect_refusal("check huge.urdf cell.json short.csv", reason);
  }
  write("cell.json", scene(R"({"name": "part", "mesh": {"file": "none.stl"}})"));
  expect_refusal(command({}), "none.stl");
  write("cell.json", wall_and(""));
  const std::vector<std::pair<std::string, std::string>> paths = {
      {"0 0\n0\n", "path.csv: line 2: has 1 numbers instead of 2"},
      {"slide,elbow\n0,0\n", "path.csv: line 1: the robot has no joint 'elbow'"},
      {"0 0\n\n0 800\n", "path.csv: line 3: joint turn is at a position beyond 100"}};
  for (const auto& [path, reason] : paths) {
    write("path.csv", path);
    expect_refusal(command("--edges"), reason);
  }
}

// What stands in no spheres is not checked, so that nothing is called free.
TEST_F(CheckTest, NothingIsFreeWithAShapeLeftOut) {
  write("slider.json", R"({"wrist": {"centers": [[0, 0, 0]], "radii": [0.01]}})");
  Outcome outcome = expect_exit(1, command({}));
  EXPECT_TRUE(outcome.out.starts_with("not proved")) << outcome.out;
  EXPECT_TRUE(has(outcome.err, "link hand has a shape but no spheres"));

  write("slider.json", R"(<robot name="slider"><link name="hand">
    <collision><geometry><sphere radius="0.05"/></geometry></collision>
    <collision><geometry><box size="1 1 1"/></geometry></collision></link></robot>)");
  outcome = expect_exit(1, command({}));
  EXPECT_TRUE(has(outcome.err, "1 shapes are no spheres"));
}

// `check` where it makes spheres itself, of the robot and of what is attached to it.

TEST_F(CheckTest, CoversTheRobotAndAToolWhereThereAreNoSpheres) {
  write_box("tool.stl", {0.1, 0.02, 0.02});
  write("cell.json", wall_and(R"("attached": [{"name": "tool", "link": "wrist",
    "mesh": {"file": "tool.stl"}, "pose": {"position": [0.05, -0.01, -0.01]}}],
    "allowed_contacts": [{"body": "tool", "other": "hand"}])"));
  write("path.csv", "-0.3 0\n-0.1 0\n0.03 0\n");
  const json report =
      expect_json(1, "check slider.urdf cell.json path.csv --max-error 0.04 --effort 0");
  EXPECT_EQ(report["colliding"], 2);
  EXPECT_EQ(report["first_contact"]["first"]["name"], "tool");
  EXPECT_EQ(report["first_contact"]["line"], 2);
}

// Which of a link's geometries stands for it: what is covered, and what must stand in spheres.
TEST_F(CheckTest, GeometryIsWhatIsAskedFor) {
  write("two.urdf",
        sliding("two", "", box("visual", "0.02 0.02 0.02") + box("collision", "0.1 0.1 0.1")));
  write("path.csv", "-0.045\n");
  const Words visual = "--geometry visual";
  Words line = "check two.urdf cell.json path.csv --max-error 0.02 --effort 0";
  expect_exit(1, line);
  expect_exit(0, joined(line, visual));
  // A link that is only to be seen needs spheres only where the visual geometry stands for it.
  write("seen.urdf", sliding("seen", box("visual", "0.02 0.02 0.02"), ""));
  write("path.csv", "-0.1\n");
  line = "check seen.urdf cell.json path.csv --spheres slider.json";
  expect_exit(0, line);
  EXPECT_TRUE(
      has(expect_exit(1, joined(line, visual)).err, "link base has a shape but no spheres"));
}

// What is attached has its own max error, and one geometry, whatever the robot's are.
TEST_F(CheckTest, AttachedMeshesAreCoveredAsTheySay) {
  write_box("tool.stl", {0.1, 0.1, 0.1});
  write("seen.urdf", sliding("seen", "", box("visual", "0.01 0.01 0.01")));
  // 0.025 from the wall: one sphere around the cube reaches 0.037 beyond its faces.
  write("path.csv", "-0.3255\n");
  const auto exit_code_with = [this](const std::string& max_error) {
    write("cell.json", wall_and(R"("attached": [{"name": "tool", "link": "hand",
      "mesh": {"file": "tool.stl"}, "pose": {"position": [0.2, -0.05, -0.05]})" +
                                max_error + "}]"));
    const Outcome outcome =
        run("check seen.urdf cell.json path.csv --geometry visual --max-error 0.04 --effort 0");
    EXPECT_EQ(outcome.err, "");
    return outcome.exit_code;
  };
  EXPECT_EQ(exit_code_with(""), 1);
  EXPECT_EQ(exit_code_with(R"(, "max_error": 0.02)"), 0);
}

}  // namespace
}  // namespace spherule
