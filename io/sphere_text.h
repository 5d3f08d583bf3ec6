// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The content of files of spheres apart from the file system, for tests and fuzzers. `name` becomes
// the subject of an Error.

#include "io/sphere_file.h"

#include <string>
#include <string_view>

namespace spherule::internal {

std::string encode_spheres(const SphereFile& file, const std::string& name);
SphereFile decode_spheres(std::string_view text, const std::string& name);

}  // namespace spherule::internal
