// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace spherule {

// Makes a folder of what the soak's commands read: bar.stl, rod.stl, bar.json (spheres that do not
// cover the bar), zones.json, bars.urdf, bars.yml (its spheres), a.tree, b.tree,
// scene.json, path.csv. All small, so that a command takes some tenths of a second.
void write_soak_inputs(const std::filesystem::path& folder);

}  // namespace spherule
