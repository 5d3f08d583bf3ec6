// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace spherule {

// What a result depends on beside the code: processor, compiler, the versions of FCL and Eigen, and
// those of the Debian packages that the file names, "NAME VERSION" a line, if it is there. In the
// order in which to print them.
std::vector<std::pair<std::string, std::string>> machine_facts(
    const std::filesystem::path& packages);

}  // namespace spherule
