// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/formats/sphere_formats.h"

#include <filesystem>

// Files of the user into which the spheres of a robot are written, as `read` of FuzzTarget: where
// the file could be read before, the result reads back to these spheres; YAML and SRDF (without
// carriage returns alone) do not change when they are written into once more.

namespace spherule::test {

// What is written: the links base and arm with spheres, hand without, and three pairs.
const RobotSpheres& spheres_to_keep();

void write_into_yaml(const std::filesystem::path& file);  // cuRobo's and XRDF
void write_into_srdf(const std::filesystem::path& file);
void write_into_urdf(const std::filesystem::path& file);

}  // namespace spherule::test
