// SPDX-License-Identifier: BSD-3-Clause
#include "base/files.h"
#include "robot/formats/sphere_formats.h"
#include "robot/pairs/link_pairs.h"
#include "tests/fuzz/fuzz_seeds.h"
#include "tests/fuzz/sealed_content.h"
#include "tests/robot/box_robots.h"
#include "tests/robot/files/random_urdf.h"
#include "tests/robot/formats/sphere_sets.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"

namespace spherule::test {
namespace {

// What is written of random spheres.
std::vector<std::string> written(std::vector<SphereFormat> formats) {
  Random random(3);
  const RobotSpheres spheres = random_spheres(random, 3);
  const TempDir folder;
  const auto urdf = folder.write("robot.urdf", urdf_text(spheres.links));
  std::vector<std::string> seeds;
  for (const SphereFormat format : formats) {
    const auto file = folder.path() / "seed";
    write_robot_spheres(spheres, format, {.urdf = urdf}, file);
    seeds.push_back(read_file(file));
  }
  return seeds;
}

}  // namespace

std::vector<std::string> scene_seeds() {
  return {R"({"format": "spherule-scene", "version": 1,
    "robot": {"pose": {"position": [0, 0, 0.5]}, "srdf": "arm.srdf"},
    "obstacles": [{"name": "floor", "half_space": {}},
      {"name": "table", "box": {"size": [1.2, 0.8, 0.05]}, "pose": {"position": [0.7, 0, 0.4]}},
      {"name": "part", "mesh": {"file": "part.stl", "scale": 0.001}},
      {"name": "scan", "points": {"file": "scan.ply", "radius": 0.005, "voxel": 0.01}}],
    "attached": [{"name": "torch", "link": "tool0", "mesh": {"file": "torch.stl"},
                  "max_error": 0.002}],
    "regions": [{"body": "torch", "name": "tip", "ball": {"center": [0, 0, 0.31], "radius": 0.01}}],
    "allowed_contacts": [{"body": "torch", "region": "tip", "other": "part"}],
    "padding": [{"body": "torch", "distance": 0.002}]})",
          R"({"format": "spherule-scene", "version": 1, "robot": {"pose": {"rpy": [0, 0, 1.5]}},
    "obstacles": [{"name": "a", "ball": {"radius": 1},
                   "pose": {"position": [0, 0, 1], "quaternion": [0, 0, 0, 2]}},
      {"name": "b", "cylinder": {"radius": 1, "length": 2}, "pose": {"rpy": [1, 0, 0]}},
      {"name": "c", "capsule": {"radius": 1, "length": 2}},
      {"name": "d", "spheres": {"file": "part.json"}}, {"name": "e", "tree": {"file": "part.tree"}},
      {"name": "f", "mesh": {"file": "part.obj", "scale": [1, -1, 0.001]}},
      {"name": "g", "points": {"file": "scan.xyz", "radius": 0.01, "scale": 0.001}}],
    "attached": [{"name": "hand", "link": "tool0", "spheres": {"file": "hand.json"}},
      {"name": "tool", "link": "hand", "tree": {"file": "t.tree"}, "pose": {"position": [1, 0, 0]}}],
    "allowed_contacts": [{"body": "hand", "other": "a"}],
    "padding": [{"body": "hand", "distance": 0.01, "other": "b"}]})"};
}

std::vector<std::string> trajectory_seeds() {
  return {"0.1, 0.2\n0.2; 0.3\n# end\n-1e-3 2\n", "time,turn,slider\n0,90,0.5\n1,-45,0.25\n"};
}

std::vector<std::string> point_seeds() {
  return {"0 0 0\n1, 2, 3\n4;5;6 255 0 0\n# end\n-1e-3 2 1e5\n"};
}

std::vector<std::string> urdf_seeds() {
  Random random(4);
  std::vector<std::string> seeds;
  for (int joints = 1; joints <= 4; ++joints) seeds.push_back(random_urdf(random, joints));
  seeds.emplace_back(R"(<robot name="arm" version="1.0"><material name="m"/>
    <link name="base"><visual name="v"><geometry>
        <mesh filename="package://arm/meshes/base.dae" scale="1 -1 1e-3"/></geometry></visual>
      <collision><geometry><mesh filename="../base.stl"/></geometry></collision>
      <collision><geometry><mesh filename="file:///base.stl"/></geometry></collision></link>
    <link name="hand"/><joint name="j" type="revolute"><parent link="base"/><child link="hand"/>
      <axis xyz="0 0 1"/><limit lower="-1" upper="1"/><safety_controller/></joint></robot>)");
  return seeds;
}

std::vector<std::string> srdf_seeds() {
  std::vector<std::string> seeds = written({SphereFormat::kSrdf});
  seeds.emplace_back(R"(<?xml version="1.0"?><robot name="arm">
    <group name="both"><group name="left"/><joint name="j2"/></group>
    <group name="left"><chain base_link="base" tip_link="l1"/><link name="l2"/></group>
    <group_state name="home" group="left"><joint name="j1" value="0.5"/></group_state>
    <virtual_joint name="world" type="fixed" parent_frame="world" child_link="base"/>
    <group_state name="there" group="both"><joint name="j2" value="1 2 3"/></group_state>
    <end_effector name="tool" parent_link="l2" group="left" parent_group="both"/>
    <link_sphere_approximation link="l2"><sphere center="0 0 0" radius="0"/>
    </link_sphere_approximation>
    <disable_collisions link1="l1" link2="l2" reason="Never"/></robot>)");
  return seeds;
}

std::vector<std::string> pair_content_seeds() {
  return {without_checksum(pair_seeds().front())};
}

std::vector<std::string> pair_seeds() {
  BoxRobot robot{RobotModel("post")};
  robot.model.add_link("bar", "post",
                       {.name = "turn", .type = JointType::kRevolute, .lower = -2, .upper = 2});
  robot.add_boxes(0, {{Eigen::Vector3d(0.9, -0.1, -0.1), Eigen::Vector3d(1.1, 0.1, 0.1)}});
  robot.add_boxes(1, {{Eigen::Vector3d(0.0, -0.02, -0.05), Eigen::Vector3d(2.0, 0.02, 0.05)}});
  return {internal::encode_link_pairs(prove_link_pairs(robot.model, robot.bodies, {.boxes = 20}))};
}

std::vector<std::string> sphere_xml_seeds() {
  return written({SphereFormat::kUrdf, SphereFormat::kSrdf});
}

std::vector<std::string> sphere_yaml_seeds() {
  std::vector<std::string> seeds = written({SphereFormat::kCurobo, SphereFormat::kXrdf});
  seeds.emplace_back("s: &s\n  - {center: [0, 0, 0], radius: 1}\ncollision_spheres:\n  a: *s\n");
  return seeds;
}

std::vector<std::string> sphere_json_seeds() {
  std::vector<std::string> seeds = written({SphereFormat::kFoam, SphereFormat::kSpherule});
  seeds.emplace_back(R"({"link": {"centers": [[0, 0, 0], [1, 2, 3]], "radii": [1, 0.5]}})");
  seeds.emplace_back(R"({"centers": [[0, 0, 0], [1, 2, 3]], "radii": [1, 0.5]})");
  seeds.emplace_back(
      R"({"a": {"BiggesetSphere": [0, 0, 0, 2], "SubSpheres": {"s1": [0, 0, 0, 1]}}})");
  return seeds;
}

std::vector<std::string> bradshaw_seeds() {
  return {"2 3\n0 0 0 9 1\n1 -2 3 0.5 1\n0 0 0 -1 0\n4 5 -6 0.75 1\n"};
}

}  // namespace spherule::test
