// SPDX-License-Identifier: BSD-3-Clause
// The styles that the published files of each format have. Links are those of spheres_to_keep(),
// and others.
#include "tests/fuzz/fuzz_seeds.h"
#include "tests/fuzz/kept_file_targets.h"
#include "tests/robot/formats/sphere_sets.h"

namespace spherule::test {

std::vector<std::string> into_yaml_seeds() {
  return {R"(# notice
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
)"};
}

std::vector<std::string> into_srdf_seeds() {
  return {R"(<?xml version='1.0' ?>
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
          "<![CDATA[<a>]]><group name=\"g\"/>\r\n</robot>"};
}

std::vector<std::string> into_urdf_seeds() {
  std::string text = urdf_text(spheres_to_keep().links);
  const std::string joints = R"(<joint name="j" type="fixed"><parent link="base"/>
    <child link="arm"/></joint><joint name="k" type="fixed"><parent link="arm"/>
    <child link="hand"/></joint><link name="base_sphere1"><collision><geometry>
    <sphere radius="1"/></geometry></collision></link><joint name="l" type="fixed">
    <parent link="base"/><child link="base_sphere1"/><origin xyz="1 0 0"/></joint></robot>)";
  text.replace(text.find("</robot>"), text.size(), joints);
  return {text, urdf_text(spheres_to_keep().links)};
}

}  // namespace spherule::test
