// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The content of files of trees apart from the file system, for tests and fuzzers. `name` becomes
// the subject of an Error.

#include "spheretree/sphere_tree.h"

#include <string>
#include <string_view>

namespace spherule::internal {

std::string encode_tree(const SphereTree& tree);
SphereTree decode_tree(std::string_view bytes, const std::string& name);

}  // namespace spherule::internal
