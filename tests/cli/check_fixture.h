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

// A wall of a millimetre at x = 0, and what else is given.
inline std::string wall_and(const std::string& keys) {
  return R"({"format": "spherule-scene", "version": 1, "obstacles": [
    {"name": "wall", "box": {"size": [0.001, 1, 1]}}])" +
         (keys.empty() ? "" : ", " + keys) + "}";
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

  std::vector<std::string> command(const std::vector<std::string>& more) const {
    std::vector<std::string> line = {"check",    "slider.urdf", "cell.json",
                                     "path.csv", "--spheres",   "slider.json"};
    line.insert(line.end(), more.begin(), more.end());
    return line;
  }
  nlohmann::json checked(int exit_code, const std::vector<std::string>& more = {}) {
    std::vector<std::string> line = command(more);
    line.push_back("--json");
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }
};

}  // namespace spherule
