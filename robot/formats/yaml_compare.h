// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/formats/yaml_nodes.h"

#include <cstddef>

namespace spherule::internal {

// A copy in which no two parts are the same node, as those of an anchor are: what is changed in it
// changes nowhere else. It has no more nodes than a text of this length has without anchors (an
// anchor may hold itself); null stands for what is left out.
YAML::Node unshared_yaml(const YAML::Node& document, std::size_t text_length);

// Whether two documents say the same, whatever the order of keys. False, too, for those that are
// deeper or hold more nodes than a text of this length does without anchors.
bool is_same_yaml(const YAML::Node& a, const YAML::Node& b, std::size_t text_length);

}  // namespace spherule::internal
