// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/files/xml_file.h"

#include <map>
#include <string>

namespace spherule::internal {

// A link that stands for a sphere of the link that it is fixed to (sphere_formats.h).
struct SphereLeaf {
  XmlElement link;
  XmlElement joint;
  std::string parent;
};

// All of a URDF's <robot>, by name. Throws Error for names that are missing or there twice.
std::map<std::string, SphereLeaf> sphere_leaves(const XmlElement& robot);

}  // namespace spherule::internal
