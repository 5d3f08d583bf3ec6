// SPDX-License-Identifier: BSD-3-Clause
// Files of all kinds: told apart, refused with the command that takes them, and where a result goes
// if no place is named.
#include "tests/cli/command_test_support.h"

namespace spherule {
namespace {

class WrongFileTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write_box("part.stl", {2, 1, 1});
    write_spheres("part.json", {{1, 0.5, 0.5, 2}});
    ASSERT_EQ(run({"tree", "part.json", "-o", "part.tree"}).exit_code, 0);
  }

  void expect_info(const std::string& file, const std::string& text) {
    const Outcome info = run({"info", file});
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_NE(info.out.find(text), std::string::npos) << info.out;
  }
};

TEST_F(WrongFileTest, TheRightCommandIsNamed) {
  const std::string mesh = "it is a mesh (spherule fit part.stl covers it with spheres)";
  const std::string spheres = "it is a set of spheres (spherule tree part.json builds its tree)";
  const std::string tree = "it is a sphere tree (spherule collide part.tree OTHER.tree checks it)";
  expect_refusal({"tree", "part.stl"}, mesh);
  expect_refusal({"collide", "part.tree", "part.stl"}, mesh);
  expect_refusal({"collide", "part.json", "part.tree"}, spheres);
  expect_refusal({"fit", "part.json", "-o", "out.json"}, spheres);
  expect_refusal({"fit", "part.tree", "-o", "out.json"}, tree);
  expect_refusal({"audit", "part.stl", "part.tree"}, tree);
  expect_refusal({"fit", "part.stl", "--tool", "part.tree", "-o", "out.json"}, tree);
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
  EXPECT_EQ(run({"view", "part.stl"}).exit_code, 0);
  expect_info("part.html", "a page of spherule view");
}

// A file of the right kind that is broken is no other kind; a name that is not there is none at
// all.
TEST_F(WrongFileTest, OtherErrorsStayAsTheyAre) {
  write("broken.stl", "solid");
  for (const std::string file : {"broken.stl", "none.stl"}) {
    const Outcome outcome = run({"fit", file, "-o", "out.json"});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_EQ(outcome.err.find("it is a"), std::string::npos) << outcome.err;
  }
}

TEST_F(WrongFileTest, ResultsHaveAPlaceByDefault) {
  EXPECT_EQ(run({"fit", "part.stl", "--max-error", "1", "--effort", "0"}).exit_code, 0);
  EXPECT_EQ(read_json("part.json").at("options").at("max-error"), 1.0);
  EXPECT_EQ(run({"tree", "part.json"}).exit_code, 0);
  EXPECT_EQ(run({"view", "part.stl", "part.json"}).exit_code, 0);
  EXPECT_EQ(run({"view", "part.tree"}).exit_code, 0);  // over the page that is there
  EXPECT_EQ(files(), (std::vector<std::string>{"part.html", "part.json", "part.stl", "part.tree"}));
}

TEST_F(WrongFileTest, WhatIsSomethingElseIsNotReplacedByDefault) {
  const std::string notes = R"({"notes": "of mine"})";
  write("part.json", notes);
  expect_refusal({"fit", "part.stl", "--max-error", "1", "--effort", "0"},
                 "part.json: is there already, and is something else");
  EXPECT_EQ(read("part.json"), notes);
  EXPECT_EQ(
      run({"fit", "part.stl", "-o", "part.json", "--max-error", "1", "--effort", "0"}).exit_code,
      0);
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
  expect_refusal({"fit", "arm.urdf", "-o", "out.json"}, "it is a robot (spherule robot arm.urdf");
  expect_refusal({"robot", "part.stl", "-o", "out"}, "it is a mesh (spherule fit part.stl");
  expect_refusal({"robot", "arm.srdf", "-o", "out"}, "it is an SRDF (spherule check-srdf");
  expect_refusal({"check", "arm.urdf", "arm.yml", "path.csv"}, "it is a file of a robot's spheres");
  expect_refusal({"audit-robot", "arm.urdf", "cell.json"}, "it is a scene (spherule check");
  write("path.csv", "0\n");
  expect_refusal({"check", "arm.urdf", "cell.json", "path.csv", "--spheres", "part.stl"},
                 "it is a mesh (spherule fit part.stl");
  expect_refusal(
      {"check", "arm.urdf", "cell.json", "path.csv", "--spheres", "arm.yml", "--pairs", "arm.srdf"},
      "it is an SRDF (spherule check-srdf");
  expect_refusal({"robot", "arm.urdf", "--srdf", "arm.yml", "-o", "out"},
                 "it is a file of a robot's spheres");
  expect_refusal({"robot", "arm.urdf", "--curobo", "arm.srdf", "-o", "out"},
                 "it is an SRDF (spherule check-srdf");
  expect_refusal({"audit-robot", "arm.urdf", "arm.yml", "--poses", "cell.json"},
                 "it is a scene (spherule check");

  expect_info("arm.urdf", "links: 2, 1 with collision geometry, 0 with visual geometry\n");
  expect_info("arm.urdf", "  lift: -1 to 2 m\n");
  expect_info("arm.srdf", "disabled pairs of links: 1\n");
  expect_info("arm.yml", "spheres: 1 on 1 links\n  base: 1\n");
  expect_info("cell.json", "a scene (spherule check");
  write("path.csv", "lift\n-0.5\n");
  expect_info("path.csv", "a table of numbers (spherule check");
  write("zones.json", R"({"format": "spherule-zones", "version": 1, "zones": []})");
  expect_info("zones.json", "a file of zones (spherule fit");

  EXPECT_EQ(run({"robot", "arm.urdf", "--max-error", "0.5", "--effort", "0", "--format", "json"})
                .exit_code,
            0);
  EXPECT_TRUE(exists("arm-spheres/arm.spheres.json"));
}
#endif

}  // namespace
}  // namespace spherule
