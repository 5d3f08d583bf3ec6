// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

#include <filesystem>

namespace spherule {

// The cell in one configuration, in the world's frame, for `spherule view`: FOLDER/PART.stl and
// FOLDER/PART.spheres.json for robot, torch, workpiece and table. Throws Error.
void write_scene(const Workload& workload, const ArmPositions& configuration,
                 const std::filesystem::path& folder);

}  // namespace spherule
