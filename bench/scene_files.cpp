// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scene_files.h"

#include "bench/placed_cell.h"
#include "io/mesh_io.h"
#include "io/sphere_file.h"

namespace spherule {

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
