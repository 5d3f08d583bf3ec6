// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"
#include "geometry/pose.h"

#include <filesystem>

namespace spherule {

// The same cell with the published visual meshes of the ABB IRB 4400L and a real torch, from a
// folder that holds robots/abb_irb4400l and torch/torch.stl. Throws Error if they are not there.
Workload make_real_cell(const std::filesystem::path& models);

// Where the end of the wire of its torch is, as flange_from_wire() of scenes/torch.h. Throws Error
// as well.
Pose real_flange_from_wire(const std::filesystem::path& models);

}  // namespace spherule
