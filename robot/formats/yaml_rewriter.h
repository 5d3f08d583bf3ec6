// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/formats/sphere_documents.h"
#include "robot/formats/yaml_nodes.h"

#include <string>
#include <vector>

namespace spherule::internal {

// A document written anew, every map and list as a block, with the spheres at a place, which is
// given by the keys from the root on. Comments are lost. Throws Error for merge keys, documents
// that are too deep or too long (an anchor may hold itself), and without the place.
std::string rewritten_yaml(const YAML::Node& document, const RobotSpheres& spheres,
                           const std::vector<std::string>& place, const SphereGatherer& gathered);

}  // namespace spherule::internal
