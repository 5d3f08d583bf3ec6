// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/check/robot_checker.h"
#include "robot/check/scene_setup.h"
#include "robot/files/robot_description.h"
#include "robot/formats/sphere_formats.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace spherule {

// What Python wrote into a folder for a program in C++ that does the same: the doubles of a file,
// and the checker of arm.urdf with spheres.json in the scene cell.json.

inline std::vector<double> read_doubles(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
  const auto* const first = reinterpret_cast<const double*>(bytes.data());
  return {first, first + bytes.size() / sizeof(double)};
}

inline RobotChecker checker_in(const std::filesystem::path& folder) {
  const RobotDescription robot = read_urdf(folder / "arm.urdf");
  const SphereFormatFile spheres = read_robot_spheres(folder / "spheres.json");
  return prepare_scene(with_spheres(robot.model, spheres.spheres.links),
                       read_scene(folder / "cell.json"))
      .scene.snapshot();
}

}  // namespace spherule
