// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace spherule {

// What a URDF, an SRDF and a file of a robot's spheres hold, in a few lines for a person. No mesh
// is read. Throw Error as the readers of these files.
std::string describe_urdf(const std::string& file);
std::string describe_srdf(const std::string& file);
std::string describe_robot_spheres(const std::string& file);

}  // namespace spherule
