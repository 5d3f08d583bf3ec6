// SPDX-License-Identifier: BSD-3-Clause
#include "tests/cli/command_test_support.h"

namespace spherule {
namespace {

using nlohmann::json;

// Files of all kinds: told apart, refused with the command that takes them, and where a result goes
// if no place is named.
class WrongFileTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_box("part.stl", {2, 1, 1});
    write_spheres("part.json", {{1, 0.5, 0.5, 2}});
    expect_exit(0, "tree part.json -o part.tree");
  }

  void expect_info(const std::string& file, const std::string& text) {
    expect_said(0, {"info", file}, text);
  }
};

TEST_F(WrongFileTest, VersionsAndHelpAreNoFaults) {
  EXPECT_TRUE(expect_exit(0, "--version").out.starts_with("spherule 0."));
  EXPECT_EQ(expect_exit(0, "--help").err, "");
  EXPECT_EQ(run("help").out, run("--help").out);
  EXPECT_EQ(run("help fit").out, run("fit --help").out);
}

TEST_F(WrongFileTest, FaultyCommandLinesAreRefused) {
  const std::string fit = "fit part.stl -o out.json ";
  expect_refusals({{"", "a command is required"},
                   {"frobnicate", "unknown command: frobnicate"},
                   {"fti", "did you mean fit?"},
                   {"veiw", "did you mean view?"},
                   {"help fti", "there is no command 'fti'; did you mean fit?"},
                   {"help fit fit", "there is no command 'fit'"},
                   {"manual frobnicate", "there is no command 'frobnicate'"},
                   {"fit -o out.json", "mesh is required"},
                   {"collide part.tree", "b"},
                   {fit + "-x", "unexpected option: -x"},
                   {fit + "--max-eror 1", "did you mean --max-error?"},
                   {fit + "--max-eror=1", "did you mean --max-error?"},
                   {fit + "--frobnicate", "unexpected option: --frobnicate"},
                   {fit + "--max-error fast", "--max-error"},
                   {fit + "--seed -1", "--seed"},
                   {fit + "--seed 1 --seed 2", "--seed"},
                   {fit + "--threads -1", "--threads"},
                   {fit + "--method other", "other"}});
  for (const char* length :
       {"--max-error", "--min-external", "--padding", "--min-radius", "--min-internal"}) {
    for (const char* value : {" -1", " nan", " 1e999"}) {
      expect_refusal(fit + length + value, std::string(length) + ": must be finite");
    }
  }
  EXPECT_FALSE(exists("out.json"));
}

TEST_F(WrongFileTest, TheRightCommandIsNamed) {
  const std::string mesh = "it is a mesh (spherule fit part.stl covers it with spheres)";
  const std::string spheres = "it is a set of spheres (spherule tree part.json builds its tree)";
  const std::string tree = "it is a sphere tree (spherule collide part.tree OTHER.tree checks it)";
  expect_refusals({{"tree part.stl", mesh},
                   {"collide part.tree part.stl", mesh},
                   {"collide part.json part.tree", spheres},
                   {"fit part.json -o out.json", spheres},
                   {"fit part.tree -o out.json", tree},
                   {"audit part.stl part.tree", tree},
                   {"fit part.stl --tool part.tree -o out.json", tree}});
}

// Names in a mesh, and comments, may be anything.
TEST_F(WrongFileTest, WhatAMeshSaysIsNotTakenForItsKind) {
  write("part.gltf",
        R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"name":"radii",
"mesh":0}],"meshes":[{"name":"spheres","primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":
"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  expect_info("part.gltf", "1 triangle,");
  write("part.dae", R"(<?xml version="1.0"?><!-- <robot> name="generator" content="spherule" -->
<COLLADA><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">
0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#a" count="3" stride="3">
<param name="X"/><param name="Y"/><param name="Z"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles>
<input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes></COLLADA>)");
  expect_info("part.dae", "1 triangle,");
  expect_exit(0, "view part.stl");
  expect_info("part.html", "a page of spherule view");
}

// A file of the right kind that is broken is no other kind; a name that is not there is none at
// all.
TEST_F(WrongFileTest, OtherErrorsStayAsTheyAre) {
  write("broken.stl", "solid");
  for (const std::string file : {"broken.stl", "none.stl"}) {
    const Outcome outcome = expect_exit(2, {"fit", file, "-o", "out.json"});
    EXPECT_FALSE(has(outcome.err, "it is a"));
  }
}

TEST_F(WrongFileTest, ResultsHaveAPlaceByDefault) {
  expect_exit(0, "fit part.stl --max-error 1 --effort 0");
  EXPECT_EQ(read_json("part.json").at("options").at("max-error"), 1.0);
  expect_exit(0, "tree part.json");
  expect_exit(0, "view part.stl part.json");
  expect_exit(0, "view part.tree");  // over the page that is there
  EXPECT_EQ(files(), (Words{"part.html", "part.json", "part.stl", "part.tree"}));
}

TEST_F(WrongFileTest, WhatIsSomethingElseIsNotReplacedByDefault) {
  const std::string notes = R"({"notes": "of mine"})";
  write("part.json", notes);
  expect_refusal("fit part.stl --max-error 1 --effort 0",
                 "part.json: is there already, and is something else");
  EXPECT_EQ(read("part.json"), notes);
  expect_exit(0, "fit part.stl -o part.json --max-error 1 --effort 0");
}

#ifdef SPHERULE_HAS_ROBOT
TEST_F(WrongFileTest, RobotsHaveTheirOwnCommands) {
  write("arm.urdf", R"(<robot name="arm"><link name="base">
<collision><geometry><mesh filename="part.stl"/></geometry></collision></link>
<link name="tip"/><joint name="lift" type="prismatic"><parent link="base"/><child link="tip"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="2" effort="0" velocity="0"/></joint></robot>)");
  write("noted.urdf", "<!-- <group> of --><robot name=\"arm\"><link name=\"base\"/></robot>");
  expect_info("noted.urdf", "links: 1,");
  write("arm.srdf", R"(<robot name="arm"><group name="all"><link name="base"/></group>
<disable_collisions link1="base" link2="tip" reason="Adjacent"/></robot>)");
  write("arm.yml", "collision_spheres:\n  base:\n    - center: [1, 0.5, 0.5]\n      radius: 2\n");
  write("cell.json", R"({"format": "spherule-scene", "version": 1, "obstacles": []})");
  expect_refusals({{"fit arm.urdf -o out.json", "it is a robot (spherule robot arm.urdf"},
                   {"robot part.stl -o out", "it is a mesh (spherule fit part.stl"},
                   {"robot arm.srdf -o out", "it is an SRDF (spherule check-srdf"},
                   {"check arm.urdf arm.yml path.csv", "it is a file of a robot's spheres"},
                   {"audit-robot arm.urdf cell.json", "it is a scene (spherule check"}});
  write("path.csv", "0\n");
  expect_refusals(
      {{"check arm.urdf cell.json path.csv --spheres part.stl",
        "it is a mesh (spherule fit part.stl"},
       {{"check", "arm.urdf", "cell.json", "path.csv", "--spheres", "arm.yml", "--pairs",
         "arm.srdf"},
        "it is an SRDF (spherule check-srdf"},
       {"robot arm.urdf --srdf arm.yml -o out", "it is a file of a robot's spheres"},
       {"robot arm.urdf --curobo arm.srdf -o out", "it is an SRDF (spherule check-srdf"},
       {"audit-robot arm.urdf arm.yml --poses cell.json", "it is a scene (spherule check"}});

  expect_info("arm.urdf", "links: 2, 1 with collision geometry, 0 with visual geometry\n");
  expect_info("arm.urdf", "  lift: -1 to 2 m\n");
  expect_info("arm.srdf",
              "disabled pairs of links: 1, links disabled by default: 0, enabled pairs: 0\n");
  expect_info("arm.yml", "spheres: 1 on 1 links\n  base: 1\n");
  expect_info("cell.json", "a scene (spherule check");
  write("path.csv", "lift\n-0.5\n");
  expect_info("path.csv", "a table of numbers (spherule check");
  write("zones.json", R"({"format": "spherule-zones", "version": 1, "zones": []})");
  expect_info("zones.json", "a file of zones (spherule fit");

  expect_exit(0, "robot arm.urdf --max-error 0.5 --effort 0 --format json");
  EXPECT_TRUE(exists("arm-spheres/arm.spheres.json"));
}
#endif

// Two spheres of radius 1 at x = 0 and x = 10, and one sphere of radius 1 at the origin.
class CollideTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_spheres("two.json", {{0, 0, 0, 1}, {10, 0, 0, 1}});
    write_spheres("one.json", {{0, 0, 0, 1}});
    expect_exit(0, "tree two.json -o two.tree");
    expect_exit(0, "tree one.json -o one.tree");
  }
};

TEST_F(CollideTest, ExitCodeIsTheVerdict) {
  const auto verdict = [&](const char* pose_b) {
    return run({"collide", "two.tree", "one.tree", "--pose-b", pose_b}).exit_code;
  };
  expect_exit(1, "collide two.tree one.tree");
  EXPECT_EQ(verdict("5 0 0 0 0 0 1"), 0);
  EXPECT_EQ(verdict("2 0 0 0 0 0 1"), 1);  // touching
  EXPECT_EQ(verdict("-2.001 0 0 0 0 0 1"), 0);
  EXPECT_EQ(verdict("-1.999,0,0, 0,0,0,1"), 1);
}

TEST_F(CollideTest, PosesRotate) {
  // A quarter turn about z moves the second sphere from x = 10 to y = 10.
  const std::string turn = "0 0 0 0 0 1 1";  // not of unit length: allowed
  expect_exit(
      1, {"collide", "two.tree", "one.tree", "--pose-a", turn, "--pose-b", "0 11.9 0 0 0 0 1"});
  expect_exit(0,
              {"collide", "two.tree", "one.tree", "--pose-a", turn, "--pose-b", "10 0 0 0 0 0 1"});
}

TEST_F(CollideTest, JsonAloneOnStandardOutput) {
  const Outcome hit =
      expect_exit(1, {"collide", "two.tree", "one.tree", "--pose-b", "11 0 0 0 0 0 1", "--json"});
  const json collision = json::parse(hit.out);
  EXPECT_EQ(collision.at("verdict"), "collision");
  EXPECT_EQ(collision.at("pairs"), json::parse("[[1,0]]"));

  const Outcome miss = expect_exit(
      0, {"collide", "two.tree", "one.tree", "--pose-b", "5 0 0 0 0 0 1", "--json", "--distance"});
  const json free = json::parse(miss.out);
  EXPECT_EQ(free.at("verdict"), "free");
  EXPECT_TRUE(free.at("pairs").empty());
  EXPECT_LE(free.at("distance").at("lower"), 3.0);
  EXPECT_GE(free.at("distance").at("upper"), 3.0);
  EXPECT_NEAR(free.at("distance").at("lower"), 3.0, 1e-9);
}

TEST_F(CollideTest, BadInput) {
  const auto refuse = [&](const std::string& pose, const std::string& reason) {
    expect_refusal({"collide", "two.tree", "one.tree", "--pose-b", pose}, reason);
  };
  refuse("", "--pose-b: ");
  refuse("1 2 3", "seven numbers");
  refuse("1 2 3 0 0 0 1 1", "seven numbers");
  refuse("1 2 3 0 0 zero 1", "'zero' is not a number");
  refuse("1 2 3 0 0 0 0", "--pose-b: ");
  refuse("1 2 nan 0 0 0 1", "--pose-b: ");
  refuse("inf 0 0 0 0 0 1", "--pose-b: ");
  expect_refusal("collide two.json one.tree", "two.json: ");
  expect_refusal("collide two.tree missing.tree", "missing.tree: ");
  std::string damaged = read("one.tree");
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
  write("damaged.tree", damaged);
  expect_refusal("collide two.tree damaged.tree", "damaged.tree: ");
  expect_refusal("info damaged.tree", "damaged.tree: ");
}

}  // namespace
}  // namespace spherule
