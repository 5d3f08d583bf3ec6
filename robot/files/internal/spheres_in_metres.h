// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheretree/sphere.h"

#include <filesystem>
#include <vector>

namespace spherule::internal {

// The spheres of a SPHERES.json file, for robots and scenes, which are in metres. Throws Error as
// load_spheres() does, and for spheres that are in another unit, as the options of their fit say;
// where these name none, the numbers are taken as metres.
std::vector<Sphere> load_spheres_in_metres(const std::filesystem::path& path);

}  // namespace spherule::internal
