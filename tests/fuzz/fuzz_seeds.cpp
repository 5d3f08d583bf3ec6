// SPDX-License-Identifier: BSD-3-Clause
#include "base/crc64.h"
#include "base/files.h"
#include "io/sphere_file.h"
#include "io/sphere_text.h"
#include "robot/formats/sphere_formats.h"
#include "robot/pairs/link_pairs.h"
#include "robot/pairs/proof_scope.h"
#include "simplifier/types/zones.h"
#include "spheretree/sphere_tree.h"
#include "spheretree/tree_bytes.h"
#include "tests/fuzz/fuzz_targets.h"
#include "tests/robot/box_robots.h"
#include "tests/robot/files/random_urdf.h"
#include "tests/robot/formats/sphere_sets.h"
#include "tests/support/mesh_files.h"
#include "tests/support/random.h"
#include "tests/support/temp_dir.h"
#include "tests/support/zoo.h"

#include <cstdint>
#include <map>

namespace spherule::test {

std::string with_checksum(std::string_view content) {
  std::string file(content);
  const std::uint64_t sum = crc64(content);
  for (int k = 0; k < 8; ++k) file.push_back(static_cast<char>(sum >> (8 * k) & 0xFFU));
  return file;
}

std::string without_checksum(std::string_view file) {
  return std::string(file.substr(0, file.size() - 8));
}

std::string threemf_around(std::string_view model) {
  return threemf_bytes(std::string(model));
}

namespace {

using Seeds = std::vector<std::string>;

const std::vector<Sphere> kSpheres = {
    {{0, 0, 0}, 1.0}, {{1.5, -0.25, 1e-3}, 0.5}, {{-3, 2, 1}, 1e3}, {{0.1, 0.2, 0.3}, 0.0}};

const TriangleMesh kSolid = cube_mesh();
const std::string kModel = threemf_model(kSolid, "1 0 0 0 1 0 0 0 1 10 20 30");

std::string tree_bytes() {
  return internal::encode_tree(build_tree(kSpheres));
}

Seeds joined(Seeds some, const Seeds& more) {
  some.insert(some.end(), more.begin(), more.end());
  return some;
}

// Four that are drawn at random.
template <class Draw>
Seeds drawn(std::uint64_t seed, Draw draw) {
  Random random(seed);
  Seeds seeds;
  for (int i = 1; i <= 4; ++i) seeds.push_back(draw(random, i));
  return seeds;
}

Seeds ply_seeds() {
  return {ply_bytes(kSolid, PlyForm::kText, true), ply_bytes(kSolid, PlyForm::kBigEndian, false),
          ply_bytes(kSolid, PlyForm::kLittleEndian, true)};
}

// Of one point: in text, in bytes, and compressed (four bytes, then these twice more).
Seeds pcd_seeds() {
  const std::string head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ";
  const std::string one("\0\0\x80\x3f", 4);
  const std::string packed("\7\0\0\0\x0c\0\0\0\3\0\0\x80\x3f\xc0\3", 15);
  return {head + "ascii\n1 2 3\n", head + "binary\n" + one + one + one,
          head + "binary_compressed\n" + packed};
}

// A strip of two triangles, one vertex moved by a sparse accessor, and two triangles in a fan.
std::string sparse_gltf() {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 1,2,3,1]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5},
      {"attributes": {"POSITION": 0}, "indices": 1, "mode": 6}]}],
    "accessors": [{"componentType": 5126, "type": "VEC3", "count": 4, "sparse": {"count": 1,
        "indices": {"bufferView": 0, "componentType": 5121}, "values": {"bufferView": 1}}},
      {"bufferView": 2, "componentType": 5121, "type": "SCALAR", "count": 4}],
    "bufferViews": [{"buffer": 0, "byteLength": 1},
      {"buffer": 0, "byteOffset": 4, "byteLength": 12},
      {"buffer": 0, "byteOffset": 16, "byteLength": 4}],
    "buffers": [{"byteLength": 20, "uri":
      "data:application/octet-stream;base64,AgAAAAAAgD8AAABAAABAQAABAgM="}]})";
}

// Of objects within objects.
std::string assembled_model() {
  const std::string end = "</resources>";
  std::string assembled = kModel;
  assembled.replace(
      assembled.find(end), end.size(),
      R"(<object id="2" type="model"><metadatagroup><metadata name="n">v</metadata></metadatagroup>)"
      R"(<components><component objectid="1"/>)"
      R"(<component objectid="1" transform="0 1 0 -1 0 0 0 0 1 5 0 0"/></components></object>)"
      R"(<object id="3"><components><component objectid="2" transform="2 0 0 0 2 0 0 0 2 0 0 1"/>)"
      R"(<component objectid="2"/></components></object></resources>)");
  const std::string item = R"(<build><item objectid="3"/>)";
  assembled.replace(assembled.find("<build>"), std::string("<build>").size(), item);
  return assembled;
}

// What is written of random spheres.
Seeds written(std::vector<SphereFormat> formats) {
  Random random(3);
  const RobotSpheres spheres = random_spheres(random, 3);
  const TempDir folder;
  const auto urdf = folder.write("robot.urdf", urdf_text(spheres.links));
  Seeds seeds;
  for (const SphereFormat format : formats) {
    const auto file = folder.path() / "seed";
    write_robot_spheres(spheres, format, {.urdf = urdf}, file);
    seeds.push_back(read_file(file));
  }
  return seeds;
}

// A robot with a link that is named as one of spheres.
std::string urdf_with_joints() {
  std::string text = urdf_text(spheres_to_keep().links);
  const std::string joints = R"(<joint name="j" type="fixed"><parent link="base"/>
    <child link="arm"/></joint><joint name="k" type="fixed"><parent link="arm"/>
    <child link="hand"/></joint><link name="base_sphere1"><collision><geometry>
    <sphere radius="1"/></geometry></collision></link><joint name="l" type="fixed">
    <parent link="base"/><child link="base_sphere1"/><origin xyz="1 0 0"/></joint></robot>)";
  text.replace(text.find("</robot>"), text.size(), joints);
  return text;
}

std::string sphere_text(bool certified) {
  SphereFile file;
  file.spheres = kSpheres;
  if (certified) {
    file.certificate.emplace();
    file.certificate->sphere_count = kSpheres.size();
    file.options["max-error"] = 0.5;
  }
  return internal::encode_spheres(file, "seed");
}

std::string pair_bytes() {
  BoxRobot robot{RobotModel("post")};
  robot.model.add_link("bar", "post",
                       {.name = "turn", .type = JointType::kRevolute, .lower = -2, .upper = 2});
  robot.add_boxes(0, {{Eigen::Vector3d(0.9, -0.1, -0.1), Eigen::Vector3d(1.1, 0.1, 0.1)}});
  robot.add_boxes(1, {{Eigen::Vector3d(0.0, -0.02, -0.05), Eigen::Vector3d(2.0, 0.02, 0.05)}});
  return internal::encode_link_pairs(prove_link_pairs(robot.model, robot.bodies, {.boxes = 20}));
}

// Of formats of others: the styles that their published files have. In into_*, links are those of
// spheres_to_keep(), and others.
const std::map<std::string_view, Seeds>& all_seeds() {
  static const std::map<std::string_view, Seeds> kSeeds = {
      {"stl", {binary_stl(kSolid), text_stl(kSolid)}},
      {"obj", {obj_text(kSolid), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1//1 2/1/1 3/2 -1\n"}},
      {"ply", ply_seeds()},
      {"points_ply", ply_seeds()},
      {"points_pcd", pcd_seeds()},
      {"off", {off_text(kSolid)}},
      {"3mf", {threemf_bytes(kModel), threemf_bytes(kModel, Zip::kDeflated64)}},
      {"3mf_model", {kModel, assembled_model()}},
      {"dae", joined({dae_text(kSolid, Eigen::Matrix4d::Identity())},
                     drawn(1, [](Random& random, int) { return random_dae(kSolid, random); }))},
      {"gltf", joined({gltf_text(kSolid, {1, 2, 3}), sparse_gltf()},
                      drawn(2, [](Random& random, int) { return random_gltf(kSolid, random); }))},
      {"glb", {glb_bytes(kSolid, {1, 2, 3})}},
      {"spheres", {sphere_text(false), sphere_text(true)}},
      {"tree", {tree_bytes()}},
      {"tree_content", {without_checksum(tree_bytes())}},
      {"zones", {R"({"format":"spherule-zones","version":1,"zones":[
    {"shape":"ball","center":[1,2,3],"radius":0.5,"max_error":0.1,"min_external":0.4},
    {"shape":"box","min":[0,0,0],"max":[1,1,1],"max_error":0.2},
    {"shape":"capsule","from":[0,0,0],"to":[1,0,0],"radius":0.1,"min_external":0.5}]})"}},
      {"scene",
       {R"({"format": "spherule-scene", "version": 1,
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
    "padding": [{"body": "hand", "distance": 0.01, "other": "b"}]})"}},
      {"trajectory",
       {"0.1, 0.2\n0.2; 0.3\n# end\n-1e-3 2\n", "time,turn,slider\n0,90,0.5\n1,-45,0.25\n"}},
      {"points", {"0 0 0\n1, 2, 3\n4;5;6 255 0 0\n# end\n-1e-3 2 1e5\n"}},
      {"urdf",
       joined(drawn(4, random_urdf), {R"(<robot name="arm" version="1.0"><material name="m"/>
    <link name="base"><visual name="v"><geometry>
        <mesh filename="package://arm/meshes/base.dae" scale="1 -1 1e-3"/></geometry></visual>
      <collision><geometry><mesh filename="../base.stl"/></geometry></collision>
      <collision><geometry><mesh filename="file:///base.stl"/></geometry></collision></link>
    <link name="hand"/><joint name="j" type="revolute"><parent link="base"/><child link="hand"/>
      <axis xyz="0 0 1"/><limit lower="-1" upper="1"/><safety_controller/></joint></robot>)"})},
      {"srdf", joined(written({SphereFormat::kSrdf}), {R"(<?xml version="1.0"?><robot name="arm">
    <group name="both"><group name="left"/><joint name="j2"/></group>
    <group name="left"><chain base_link="base" tip_link="l1"/><link name="l2"/></group>
    <group_state name="home" group="left"><joint name="j1" value="0.5"/></group_state>
    <virtual_joint name="world" type="fixed" parent_frame="world" child_link="base"/>
    <group_state name="there" group="both"><joint name="j2" value="1 2 3"/></group_state>
    <end_effector name="tool" parent_link="l2" group="left" parent_group="both"/>
    <link_sphere_approximation link="l2"><sphere center="0 0 0" radius="0"/>
    </link_sphere_approximation>
    <disable_collisions link1="l1" link2="l2" reason="Never"/></robot>)"})},
      {"pairs", {pair_bytes()}},
      {"pairs_content", {without_checksum(pair_bytes())}},
      {"spheres_xml", written({SphereFormat::kUrdf, SphereFormat::kSrdf})},
      {"spheres_yaml",
       joined(written({SphereFormat::kCurobo, SphereFormat::kXrdf}),
              {"s: &s\n  - {center: [0, 0, 0], radius: 1}\ncollision_spheres:\n  a: *s\n"})},
      {"spheres_json",
       joined(written({SphereFormat::kFoam, SphereFormat::kSpherule}),
              {R"({"link": {"centers": [[0, 0, 0], [1, 2, 3]], "radii": [1, 0.5]}})",
               R"({"centers": [[0, 0, 0], [1, 2, 3]], "radii": [1, 0.5]})",
               R"({"a": {"BiggesetSphere": [0, 0, 0, 2], "SubSpheres": {"s1": [0, 0, 0, 1]}}})"})},
      {"spheres_sph", {"2 3\n0 0 0 9 1\n1 -2 3 0.5 1\n0 0 0 -1 0\n4 5 -6 0.75 1\n"}},
      {"into_yaml",
       {R"(# notice
robot_cfg:
  kinematics:
    urdf_path: "robot/arm.urdf"  # relative
    collision_link_names:
      [
        "base", # first
        "hand",
      ]
    collision_spheres:
      "base":
        - "center": [9, 9, 9]
          "radius": 9.0
    self_collision_ignore:
      {
        "base": ["arm", "other"],
        "other": ["tool"],
      }
    lock_joints: {"a": 0.04, 'b': !!float 4e-2}
)",
        R"(robot_cfg:
  kinematics:
    collision_link_names:
    - base
    self_collision_ignore:
      base:
      - arm   # mine
    text: |
      # no comment
    collision_spheres:
      base:
      - center:
        - 9.0
        - 9.0
        - 9.0
        radius: 9.0
  # end
)",
        "kinematics:\n  k: &k {a: 1}\n  b: *k\n  collision_spheres: {base: []}\n"
        "  self_collision_ignore: {other: &l [x], base: *l}\n",
        "collision_spheres:\n  base: []\n",
        "format: xrdf\nformat_version: 1.0\ncollision:\n  geometry: auto\n"
        "geometry:\n  auto:\n    spheres:\n  fine: {}\nself_collision:\n  geometry: auto\n",
        R"(format: "xrdf"
format_version: 1.0

modifiers:
  - set_base_frame: "base"

collision:
  geometry: "auto"

self_collision:
  geometry: "auto"
  ignore:
    base:
      - "arm"
      - "world"
    hand: [ 'arm' ] # both

geometry:
  auto:
    spheres:
      base:
      - center: [0.0, 0.0, 0.1]
        radius: 0.07
  rest: {}
)"}},
      {"into_srdf",
       {R"(<?xml version='1.0' ?>
<!-- <robot> > -->
<robot   name='arm'
         xmlns:x = "y">
  <group name="all"> <link name="arm"/></group>
  <group_state name="home" group="all"><joint name="j" value="0.5"/></group_state>
  <link_sphere_approximation link="old"><sphere center="0 0 0" radius="9"/></link_sphere_approximation>
    <disable_collisions link1="arm" link2="base" reason="User>" /> <!-- mine -->
    <enable_collisions   link1="x" link2="y"/>

  <property name="a>b" value='"/>'/>
</robot> <!-- end -->
)",
        R"(<robot name="arm"/>)",
        "<robot name=\"arm\">\r\n<disable_collisions link1=\"arm\" link2=\"base\"/>"
        "<![CDATA[<a>]]><group name=\"g\"/>\r\n</robot>"}},
      {"into_urdf", {urdf_with_joints(), urdf_text(spheres_to_keep().links)}}};
  return kSeeds;
}

}  // namespace

std::vector<std::string> FuzzTarget::seeds() const {
  return all_seeds().at(name);
}

}  // namespace spherule::test
