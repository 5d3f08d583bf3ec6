// SPDX-License-Identifier: BSD-3-Clause
// The work cell as files that the command reads: FOLDER/robot.urdf with a mesh for each link,
// torch, workpiece and table (STL, metres), cell.json and path.csv, every tenth configuration of
// the weld program's start. Usage: spherule_cell_files FOLDER

#include "bench/scenes/work_cell.h"
#include "io/mesh_io.h"

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace spherule {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPathSize = 34;  // up to where the wire comes to the metal
constexpr std::size_t kPathStep = 10;

std::ofstream open(const fs::path& path) {
  std::ofstream file(path);
  file.exceptions(std::ios::failbit | std::ios::badbit);
  file.precision(std::numeric_limits<double>::max_digits10);
  return file;
}

std::string numbers(const Eigen::Vector3d& v, const std::string& between) {
  return std::to_string(v.x()) + between + std::to_string(v.y()) + between + std::to_string(v.z());
}

// Links and joints; the origins of the robot's joints have no rotation.
void write_robot(const fs::path& folder) {
  const RobotModel robot = make_robot();
  const std::array<TriangleMesh, kJoints + 1> meshes = make_robot_links();
  std::ofstream urdf = open(folder / "robot.urdf");
  urdf << "<?xml version=\"1.0\"?>\n<robot name=\"welder\">\n";
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const std::string& name = robot.links()[i].name;
    write_stl(meshes[i], folder / (name + ".stl"));
    urdf << "  <link name=\"" << name << "\"><collision><geometry><mesh filename=\"" << name
         << ".stl\"/></geometry></collision></link>\n";
  }
  for (const Joint& joint : robot.joints()) {
    const auto name_of = [&](int link) {
      return robot.links()[static_cast<std::size_t>(link)].name;
    };
    urdf << "  <joint name=\"" << joint.name << "\" type=\"revolute\">\n    <parent link=\""
         << name_of(joint.parent_link) << "\"/><child link=\"" << name_of(joint.child_link)
         << "\"/>\n    <origin xyz=\"" << numbers(joint.parent_from_joint.translation(), " ")
         << "\"/><axis xyz=\"" << numbers(joint.axis, " ") << "\"/>\n    <limit lower=\""
         << joint.lower << "\" upper=\"" << joint.upper
         << "\" effort=\"1\" velocity=\"1\"/>\n  </joint>\n";
  }
  urdf << "</robot>\n";
}

std::string json_pose(const Pose& pose) {
  const Eigen::Quaterniond q = pose.rotation();
  return "{\"position\": [" + numbers(pose.translation(), ", ") + "], \"quaternion\": [" +
         numbers(q.vec(), ", ") + ", " + std::to_string(q.w()) + "]}";
}

void write_cell(const fs::path& folder) {
  write_stl(make_torch(), folder / "torch.stl");
  write_stl(make_workpiece(), folder / "workpiece.stl");
  write_stl(make_table(), folder / "table.stl");
  open(folder / "cell.json")
      << "{\"format\": \"spherule-scene\", \"version\": 1,\n  \"obstacles\": [\n"
      << "    {\"name\": \"workpiece\", \"mesh\": {\"file\": \"workpiece.stl\"}, \"pose\": "
      << json_pose(world_from_workpiece()) << "},\n"
      << "    {\"name\": \"table\", \"mesh\": {\"file\": \"table.stl\"}, \"pose\": "
      << json_pose(world_from_table()) << "}],\n"
      << "  \"attached\": [{\"name\": \"torch\", \"link\": \"link_6\", \"max_error\": 0.003,\n"
      << "    \"mesh\": {\"file\": \"torch.stl\"}, \"pose\": " << json_pose(link6_from_flange())
      << "}],\n"
      << "  \"allowed_contacts\": [{\"body\": \"base_link\", \"other\": \"table\"},\n"
      << "    {\"body\": \"link_6\", \"other\": \"link_4\"},\n"
      << "    {\"body\": \"torch\", \"other\": \"link_6\"}, {\"body\": \"torch\", \"other\": "
         "\"link_5\"}]}\n";
}

void write_path(const fs::path& folder) {
  const std::vector<ArmPositions> program = make_program(flange_from_wire()).configurations;
  std::ofstream path = open(folder / "path.csv");
  path << "joint_1,joint_2,joint_3,joint_4,joint_5,joint_6\n";
  for (std::size_t i = 0; i < kPathSize * kPathStep && i < program.size(); i += kPathStep) {
    for (std::size_t k = 0; k < kJoints; ++k) path << (k > 0 ? "," : "") << program[i][k];
    path << '\n';
  }
}

}  // namespace
}  // namespace spherule

int main(int argc, char** argv) {
  try {
    if (argc != 2) throw std::runtime_error("usage: spherule_cell_files FOLDER");
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    spherule::write_robot(folder);
    spherule::write_cell(folder);
    spherule::write_path(folder);
  } catch (const std::exception& error) {
    std::cerr << "spherule_cell_files: " << error.what() << '\n';
    return 2;
  }
}
