// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace spherule {

// A configuration of the first weld, for pictures.
inline constexpr std::size_t kShownConfiguration = 300;

// Parts in their places, in the world's frame, as meshes and as spheres.
struct PlacedParts {
  TriangleMesh mesh;
  std::vector<Sphere> spheres;
};

// The cell in one configuration: robot, torch, workpiece and table, by these names.
std::map<std::string, PlacedParts> place_cell(const Workload& workload,
                                              const ArmPositions& configuration);

// The same for `spherule view`: FOLDER/PART.stl and FOLDER/PART.spheres.json. Throws Error.
void write_scene(const Workload& workload, const ArmPositions& configuration,
                 const std::filesystem::path& folder);

}  // namespace spherule
