// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/fit_parts.h"
#include "io/mesh_io.h"
#include "io/sphere_file.h"
#include "robot/model/kinematics.h"
#include "tests/support/solids.h"

namespace spherule {
namespace {

void add(const Part& part, const Pose& pose, PlacedParts& group) {
  append(group.mesh, placed(part.mesh, pose.matrix(), pose.translation()));
  for (const Sphere& sphere : part.tree->spheres()) {
    group.spheres.push_back({pose * sphere.center, sphere.radius});
  }
}

}  // namespace

std::map<std::string, PlacedParts> place_cell(const Workload& workload,
                                              const ArmPositions& configuration) {
  std::vector<Pose> world_from_link;
  forward_kinematics(workload.robot, configuration, world_from_link);
  std::map<std::string, PlacedParts> groups;
  for (const Body& body : workload.bodies) {
    add(body.part, world_from_link[static_cast<std::size_t>(body.link)],
        groups[body.part.name == "torch" ? "torch" : "robot"]);
  }
  for (const Obstacle& obstacle : workload.obstacles) {
    add(obstacle.part, obstacle.world_from_part, groups[obstacle.part.name]);
  }
  return groups;
}

void write_scene(const Workload& workload, const ArmPositions& configuration,
                 const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const auto& [name, group] : place_cell(workload, configuration)) {
    write_stl(group.mesh, folder / (name + ".stl"));
    SphereFile file;
    file.spheres = group.spheres;
    save_spheres(file, folder / (name + ".spheres.json"));
  }
}

}  // namespace spherule
