// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/cli/command_test_support.h"

#include <string>
#include <vector>

namespace spherule {

// A sphere of radius 0.05 that slides along x and turns about z.
inline constexpr const char* kSlider = R"(<?xml version="1.0"?>
<robot name="slider">
  <link name="base"/>
  <link name="hand">
    <collision><geometry><sphere radius="0.05"/></geometry></collision>
  </link>
  <link name="wrist"/>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="hand"/>
    <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="turn" type="continuous"><parent link="hand"/><child link="wrist"/>
    <axis xyz="0 0 1"/></joint>
</robot>
)";

// A URDF: a tool that slides beside a block, from `lower` to 0.5, and turns. The two are 0.02 m
// apart where the slide stands at zero, so that they never touch if it does not go below -0.02.
inline std::string gantry(const std::string& lower) {
  return R"(<?xml version="1.0"?>
<robot name="gantry">
  <link name="block"><collision><geometry><box size="0.3 0.3 0.3"/></geometry></collision></link>
  <link name="carriage"/>
  <link name="tool"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <joint name="slide" type="prismatic"><parent link="block"/><child link="carriage"/>
    <origin xyz="0.22 0 0"/><axis xyz="1 0 0"/>
    <limit lower=")" +
         lower + R"(" upper="0.5" effort="1" velocity="1"/></joint>
  <joint name="turn" type="revolute"><parent link="carriage"/><child link="tool"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
)";
}

// A URDF of a link `base` on which a link `hand` slides along x, with what is inside of both.
inline std::string sliding(const std::string& robot, const std::string& base,
                           const std::string& hand) {
  return "<robot name=\"" + robot + "\"><link name=\"base\">" + base +
         "</link><link name=\"hand\">" + hand + R"(</link>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="hand"/>
    <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>)";
}

// A shape of a link; `kind` is "visual" or "collision".
inline std::string box(const std::string& kind, const std::string& size) {
  return "<" + kind + "><geometry><box size=\"" + size + "\"/></geometry></" + kind + ">";
}

// A scene with obstacles, and what else is given.
inline std::string scene(const std::string& obstacles, const std::string& keys = "") {
  return R"({"format": "spherule-scene", "version": 1, "obstacles": [)" + obstacles + "]" +
         (keys.empty() ? "" : ", " + keys) + "}";
}

// Obstacles: a wall of a millimetre at x = 0, and a ball.
inline constexpr const char* kWall = R"({"name": "wall", "box": {"size": [0.001, 1, 1]}})";
inline std::string ball(const std::string& name, const std::string& radius,
                        const std::string& position) {
  return R"({"name": ")" + name + R"(", "ball": {"radius": )" + radius +
         R"(}, "pose": {"position": [)" + position + "]}}";
}
inline std::string wall_and(const std::string& keys) {
  return scene(kWall, keys);
}

class CheckTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("slider.urdf", kSlider);
    write("slider.json", R"({"hand": {"centers": [[0, 0, 0]], "radii": [0.05]}})");
    write("cell.json", wall_and(""));
    write("path.csv", "-1 0\n1 0\n");
  }

  Words command(const Words& more) const {
    return joined("check slider.urdf cell.json path.csv --spheres slider.json", more);
  }
  nlohmann::json checked(int exit_code, const Words& more = {}) {
    return expect_json(exit_code, command(more));
  }
};

}  // namespace spherule
