// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scene_files.h"

#include "bench/scenes/solids.h"
#include "collide/robot/kinematics.h"
#include "simplifier/mesh_io.h"
#include "spheretree/sphere_file.h"

#include <map>
#include <string>
#include <vector>

namespace spherule {
namespace {

struct Placed {
  TriangleMesh mesh;
  SphereFile spheres;

  void add(const Part& part, const Pose& pose) {
    append(mesh, placed(part.mesh, pose.matrix(), pose.translation()));
    for (const Sphere& sphere : part.tree->spheres()) {
      spheres.spheres.push_back({pose * sphere.center, sphere.radius});
    }
  }
};

}  // namespace

void write_scene(const Workload& workload, const JointPositions& configuration,
                 const std::filesystem::path& folder) {
  std::vector<Pose> world_from_link;
  forward_kinematics(workload.robot, configuration, world_from_link);
  std::map<std::string, Placed> groups;
  for (const Body& body : workload.bodies) {
    groups[body.part.name == "torch" ? "torch" : "robot"].add(
        body.part, world_from_link[static_cast<std::size_t>(body.link)]);
  }
  for (const Obstacle& obstacle : workload.obstacles) {
    groups[obstacle.part.name].add(obstacle.part, obstacle.world_from_part);
  }
  std::filesystem::create_directories(folder);
  for (const auto& [name, group] : groups) {
    write_stl(group.mesh, folder / (name + ".stl"));
    save_spheres(group.spheres, folder / (name + ".spheres.json"));
  }
}

}  // namespace spherule
