// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/files/internal/xml_file.h"

#include <string>
#include <string_view>
#include <vector>

namespace spherule::internal {

// The <link> and <joint> elements of a URDF file depth first: the root link, then for each joint
// below a link, in the order of the file, what hangs on it. Link i + 1 is the child of joint i.
struct UrdfTree {
  std::vector<XmlElement> links;
  std::vector<XmlElement> joints;
};

// Throws Error for names that are missing or not unique, a joint between links that are not there,
// and links and joints that are no tree.
UrdfTree urdf_tree(const XmlElement& robot);

// The name of the link at an end of a joint, "parent" or "child".
std::string link_at(const XmlElement& joint, std::string_view end);

}  // namespace spherule::internal
