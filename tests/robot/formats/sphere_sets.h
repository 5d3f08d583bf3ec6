// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/formats/sphere_formats.h"
#include "tests/support/random.h"

#include <string>
#include <vector>

namespace spherule {

// A set of spheres with names that a format has to quote, escape or leave alone, empty links, tiny
// and huge numbers, pairs and buffers.
RobotSpheres random_spheres(test::Random& random, std::size_t links);

// A URDF with links of these names, each with a mesh to see and one to collide with.
std::string urdf_text(const std::vector<LinkSpheres>& links);

// Says where two sets differ, bit for bit; empty if they do not.
std::string difference(const std::vector<LinkSpheres>& a, const std::vector<LinkSpheres>& b);

}  // namespace spherule
