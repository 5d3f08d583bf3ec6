// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/check_fixture.h"

#include <string>
#include <vector>

namespace spherule {
namespace {

using nlohmann::json;

TEST_F(CheckTest, ConfigurationsOrMotions) {
  const json configurations = checked(0);
  EXPECT_EQ(configurations["verdict"], "free");
  EXPECT_EQ(configurations["configurations"], 2);
  EXPECT_TRUE(configurations["first_contact"].is_null());

  const json motions = checked(1, {"--edges"});
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
  EXPECT_EQ(checked(0, {"--edges"})["verdict"], "free");
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
  const Outcome table = run(command({}));
  EXPECT_EQ(table.exit_code, 1);
  EXPECT_NE(table.out.find("collision: 5 configurations, 3 of them collide"), std::string::npos)
      << table.out;
  EXPECT_NE(table.out.find("40.5"), std::string::npos) << table.out;
}

// What a motion meets behind its first contact is a pair, too.
TEST_F(CheckTest, AllThatAMotionTouchesIsNamed) {
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
    {"name": "near", "ball": {"radius": 0.1}, "pose": {"position": [-0.5, 0, 0]}},
    {"name": "far", "ball": {"radius": 0.1}, "pose": {"position": [0.5, 0, 0]}}]})");
  const json report = checked(1, {"--edges"});
  ASSERT_EQ(report["pairs"].size(), 2u);
  for (const std::size_t i : {0U, 1U}) {
    const json& pair = report["pairs"][i];
    EXPECT_EQ(pair["second"], i == 0 ? "near" : "far");
    EXPECT_EQ(pair["count"], 1);
    EXPECT_GT(pair["worst_contact"]["depth"], 0.1);
    EXPECT_NEAR(pair["worst_contact"]["fraction"].get<double>(), i == 0 ? 0.25 : 0.75, 0.03);
  }
}

TEST_F(CheckTest, AnObstacleThatIsFarAwayLooksLikeMillimetres) {
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
    {"name": "table", "box": {"size": [600, 800, 50]}, "pose": {"position": [600, 0, 0]}}]})");
  const Outcome outcome = run(command({}));
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(
      outcome.err.find("cell.json: obstacle table is 600 m from the origin: lengths in scenes "
                       "are metres"),
      std::string::npos)
      << outcome.err;
}

TEST_F(CheckTest, GrazingIsNotProved) {
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
    {"name": "floor", "half_space": {}, "pose": {"position": [0, 0, -0.050001]}}]})");
  // Along the floor, which is a plane, a micrometre is enough.
  EXPECT_EQ(checked(0, {"--edges", "--resolution", "0.01"})["verdict"], "free");
  // Only where x is 0.47, shortly before three quarters of the way.
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
    {"name": "post", "ball": {"radius": 0.1}, "pose": {"position": [0.47, 0.150000001, 0]}}]})");
  const json report = checked(1, {"--edges", "--resolution", "0.01"});
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
  run({"tree", "balls.json", "-o", "balls.tree"});
  write("scan.xyz", "0 0 0\n0.001 0 0\n");
  const auto scene = [](const std::string& shape) {
    return R"({"format": "spherule-scene", "version": 1, "obstacles": [{"name": "thing", )" +
           shape + R"(, "pose": {"position": [1, 0, 0]}}]})";
  };
  for (const std::string shape :
       {R"("mesh": {"file": "block.stl", "scale": 0.001})", R"("spheres": {"file": "balls.json"})",
        R"("tree": {"file": "balls.tree"})", R"("points": {"file": "scan.xyz", "radius": 0.01})",
        R"("ball": {"radius": 0.01})", R"("capsule": {"radius": 0.01, "length": 0.1})",
        R"("cylinder": {"radius": 0.01, "length": 0.1})"}) {
    SCOPED_TRACE(shape);
    write("cell.json", scene(shape));
    write("path.csv", "0 0\n");
    EXPECT_EQ(checked(0)["verdict"], "free");
    // The hand is wholly inside the block.
    write("path.csv", shape.find("mesh") != std::string::npos ? "1.06 0\n" : "1 0\n");
    EXPECT_EQ(checked(1)["first_contact"]["second"]["name"], "thing");
  }
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
    {"name": "thing", "mesh": {"file": "block.stl", "scale": 0.001},
     "pose": {"position": [0, -0.5, -0.5]}}]})");
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
  const json report = checked(0, {"--edges"});
  EXPECT_EQ(report["configurations"], 1);
  EXPECT_FALSE(report.contains("motions"));
}

TEST_F(CheckTest, TheLastMotionIsProvedToo) {
  write("path.csv", "-1 0\n-0.9 0\n1 0\n");
  const json report = checked(1, {"--edges"});
  EXPECT_EQ(report["motions"], 2);
  EXPECT_EQ(report["first_contact"]["line"], 2);
  EXPECT_EQ(report["first_contact"]["to_line"], 3);
  EXPECT_NEAR(report["first_contact"]["fraction"].get<double>(), (0.9 - 0.0505) / 1.9, 2e-4);
}

// Of several pairs, each has its own count, first and deepest contact.
TEST_F(CheckTest, PairsAreToldApart) {
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
    {"name": "wall", "box": {"size": [0.001, 1, 1]}},
    {"name": "post", "ball": {"radius": 0.1}, "pose": {"position": [0.5, 0, 0]}}]})");
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
  const std::string scene = R"({"format": "spherule-scene", "version": 1)";
  write("three.yml", spheres);
  write("cell.json", scene + "}");
  write("path.csv", "0 0\n");
  const std::vector<std::string> line = {"check",    "three.urdf", "cell.json",
                                         "path.csv", "--spheres",  "three.yml"};
  EXPECT_EQ(run(line).exit_code, 1);
  write("three.yml", spheres + "self_collision_ignore: {a: [c]}\ncollision_sphere_buffer: 0.01\n");
  const Outcome ignored = run(line);
  EXPECT_EQ(ignored.exit_code, 0) << ignored.out;
  EXPECT_NE(ignored.err.find("1 of the pairs of links are ignored"), std::string::npos)
      << ignored.err;
  EXPECT_NE(ignored.err.find("its buffers are not added"), std::string::npos) << ignored.err;
  write("three.yml", spheres);
  write("cell.json", scene + R"(, "robot": {"srdf": "three.srdf"}})");
  write("three.srdf", R"(<robot name="three"><disable_collisions link1="a" link2="gone"/>
    <disable_collisions link1="gone" link2="c"/></robot>)");
  EXPECT_EQ(run(line).exit_code, 1);
  write("three.srdf", R"(<robot name="three"><disable_collisions link1="a" link2="gone"/>
    <disable_collisions link1="c" link2="a"/></robot>)");
  EXPECT_EQ(run(line).exit_code, 0);
}

TEST_F(CheckTest, PointsAreScaledAndThinnedOut) {
  const auto scene = [this](const std::string& more) {
    write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
      {"name": "scan", "points": {"file": "scan.xyz", "radius": 0.01)" +
                           more + "}}]}");
  };
  write("scan.xyz", "1000 0 0\n1300 0 0\n");
  write("path.csv", "1.15 0\n");
  scene("");
  EXPECT_EQ(checked(0)["verdict"], "free");
  scene(R"(, "scale": 0.001)");
  EXPECT_EQ(checked(0)["verdict"], "free");
  scene(R"(, "scale": 0.001, "voxel": 2)");  // one sphere around both
  EXPECT_EQ(checked(1)["verdict"], "collision");
  write("path.csv", "1.3 0\n");
  scene(R"(, "scale": 0.001)");
  EXPECT_EQ(checked(1)["verdict"], "collision");
}

TEST_F(CheckTest, WarnsOfWhatIsNotChecked) {
  write("cup.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
    {"name": "cup", "mesh": {"file": "cup.obj"}, "pose": {"position": [0, 0, 5]}}]})");
  write("slider.json", R"({"hand": {"centers": [[0, 0, 0], [0, 0, 0]], "radii": [0.05, -1]}})");
  const Outcome outcome = run(command({}));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  EXPECT_NE(outcome.err.find("cup: the mesh is open"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("1 spheres are switched off"), std::string::npos) << outcome.err;
}

TEST_F(CheckTest, RefusesBadInput) {
  const auto refused = [this](const std::string& reason) { expect_refusal(command({}), reason); };
  write("path.csv", "0 0\n0\n");
  refused("path.csv: line 2: has 1 numbers instead of 2");
  write("path.csv", "slide,elbow\n0,0\n");
  refused("path.csv: line 1: the robot has no joint 'elbow'");
  write("path.csv", "0 0\n\n0 800\n");
  expect_refusal(command({"--edges"}), "path.csv: line 3: joint turn is at a position beyond 100");
  write("path.csv", "0 0\n");
  expect_refusal(command({"--edges", "--resolution", "0"}), "resolution");
  expect_refusal(command({"--resolution", "0.01"}), "--edges");
  expect_refusal(command({"--continuous", "shortest"}), "--edges");
  write("cell.json", wall_and(R"("obstacle": [])"));
  refused("cell.json: the key 'obstacle' is not known here");
  write("cell.json", wall_and(R"("allowed_contacts": [{"body": "arm", "other": "wall"}])"));
  refused("arm");
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
    {"name": "part", "mesh": {"file": "none.stl"}}]})");
  refused("none.stl");
  write("cell.json", wall_and(""));
  write("slider.json", R"({"arm": {"centers": [[0, 0, 0]], "radii": [0.05]}})");
  refused("slider.json: has spheres of 1 link that the robot has not got: 'arm'");
  expect_refusal({"check", "none.urdf", "cell.json", "path.csv"}, "none.urdf");
  expect_refusal({"check", "slider.urdf"}, "scene");
}

// A robot whose covering is refused, by then.
TEST_F(CheckTest, RefusesScenesBeforeTheRobotIsCovered) {
  write("huge.urdf",
        R"(<robot name="huge"><link name="base"/><link name="hand"><collision><geometry>
    <box size="1e4 1e4 1e4"/></geometry></collision></link><joint name="turn" type="continuous">
    <parent link="base"/><child link="hand"/></joint></robot>)");
  write("path.csv", "0\n");
  const auto refused = [this](const std::string& keys, const std::string& reason) {
    write("cell.json", wall_and(keys));
    expect_refusal({"check", "huge.urdf", "cell.json", "path.csv"}, reason);
  };
  refused("", "link 'hand': is");
  refused(R"("padding": [{"body": "hnad", "distance": 0.1}])", "hnad: there is no link");
  refused(R"("attached": [{"name": "tool", "link": "hand", "mesh": {"file": "none.stl"}}])",
          "none.stl: ");
  refused(R"("attached": [{"name": "tool", "link": "hnad", "tree": {"file": "cell.json"}}])",
          "hnad: ");
  refused(R"("regions": [{"body": "hnad", "name": "tip", "ball": {"center": [0, 0, 0],
          "radius": 1}}])",
          "hnad: ");
  refused(R"("robot": {"srdf": "none.srdf"})", "none.srdf: ");
  expect_refusal({"check", "huge.urdf", "cell.json", "path.csv", "--pairs", "none.pairs"}, "none.");
}

TEST_F(CheckTest, ALongListOfMotionsIsCut) {
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": [
    {"name": "post", "ball": {"radius": 0.1}, "pose": {"position": [0.47, 0.150000001, 0]}}]})");
  const auto table_of = [this](int motions) {
    std::string path = "-1 0\n";
    for (int i = 0; i < motions; ++i) path += i % 2 == 0 ? "1 0\n" : "-1 0\n";
    write("path.csv", path);
    return run(command({"--edges", "--resolution", "0.01"})).out;
  };
  const auto rows_of = [](const std::string& table) {
    std::size_t rows = 0;
    const std::string row = "not proved beyond line ";
    for (std::size_t at = table.find(row); at != table.npos; at = table.find(row, at + 1)) ++rows;
    return rows;
  };
  const std::string whole = table_of(20);
  EXPECT_EQ(rows_of(whole), 20U) << whole;
  EXPECT_EQ(whole.find(" more\n"), whole.npos) << whole;
  const std::string cut = table_of(23);
  EXPECT_EQ(rows_of(cut), 20U) << cut;
  EXPECT_TRUE(cut.ends_with("\nand 3 more\n")) << cut;
}

// What stands in no spheres is not checked, so that nothing is called free.
TEST_F(CheckTest, NothingIsFreeWithAShapeLeftOut) {
  write("slider.json", R"({"wrist": {"centers": [[0, 0, 0]], "radii": [0.01]}})");
  Outcome outcome = run(command({}));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(outcome.out.starts_with("not proved")) << outcome.out;
  EXPECT_NE(outcome.err.find("link hand has a shape but no spheres"), std::string::npos)
      << outcome.err;

  write("slider.json", R"(<robot name="slider"><link name="hand">
    <collision><geometry><sphere radius="0.05"/></geometry></collision>
    <collision><geometry><box size="1 1 1"/></geometry></collision></link></robot>)");
  outcome = run(command({}));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("1 shapes are no spheres"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace spherule
