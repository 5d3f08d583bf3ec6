// SPDX-License-Identifier: BSD-3-Clause
#include "tests/soak/soak_inputs.h"

#include "base/files.h"
#include "io/mesh_io.h"
#include "io/sphere_file.h"
#include "spheretree/build.h"
#include "spheretree/tree_file.h"
#include "tests/support/shapes.h"

#include <vector>

namespace spherule {
namespace {

// A bar along x and one across it, which slides away and turns.
constexpr const char* kRobot = R"(<?xml version="1.0"?>
<robot name="bars">
  <link name="block">
    <collision><geometry><box size="0.3 0.02 0.02"/></geometry></collision>
  </link>
  <link name="carriage"/>
  <link name="tool">
    <collision><geometry><box size="0.02 0.1 0.02"/></geometry></collision>
  </link>
  <joint name="slide" type="prismatic"><parent link="block"/><child link="carriage"/>
    <origin xyz="0.22 0 0"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.5" effort="1" velocity="1"/></joint>
  <joint name="turn" type="revolute"><parent link="carriage"/><child link="tool"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
)";

constexpr const char* kRobotSpheres = R"(collision_spheres:
  block:
    - center: [-0.08, 0.0, 0.0]
      radius: 0.08
    - center: [0.08, 0.0, 0.0]
      radius: 0.09
  tool:
    - center: [0.0, 0.0, 0.0]
      radius: 0.06
)";

constexpr const char* kZones = R"({"format":"spherule-zones","version":1,"zones":[
  {"shape":"ball","center":[20,0,0],"radius":3,"max_error":2}]}
)";

constexpr const char* kScene = R"({"format":"spherule-scene","version":1,"obstacles":[
  {"name":"floor","half_space":{},"pose":{"position":[0,0,-0.2]}},
  {"name":"wall","box":{"size":[0.05,1,1]},"pose":{"position":[0.9,0,0]}}]}
)";

}  // namespace

void write_soak_inputs(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  write_stl(make_box({40.0, 2.0, 2.0}), folder / "bar.stl");
  write_stl(make_box({2.0, 2.0, 30.0}), folder / "rod.stl");
  SphereFile file;
  for (const double x : {-15.0, -5.0, 5.0}) file.spheres.push_back({{x, 0.0, 0.0}, 6.0});
  file.spheres.push_back({{15.0, 0.0, 0.0}, 5.0});
  save_spheres(file, folder / "bar.json");
  save_tree(build_tree(file.spheres), folder / "a.tree");
  for (Sphere& sphere : file.spheres) sphere.center.y() += 20.0;
  save_tree(build_tree(file.spheres), folder / "b.tree");
  write_file_atomically(folder / "zones.json", kZones);
  write_file_atomically(folder / "bars.urdf", kRobot);
  write_file_atomically(folder / "bars.yml", kRobotSpheres);
  write_file_atomically(folder / "scene.json", kScene);
  write_file_atomically(folder / "path.csv", "0 0\n0.2 0.5\n0.4 -0.5\n");
}

}  // namespace spherule
