// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

namespace spherule {

// Throws Error, before long work is done for nothing, if a file of `outputs` cannot be made where
// it is requested, is one of `inputs`, or is named twice. Empty paths are files not requested.
void check_outputs(const std::vector<std::filesystem::path>& outputs,
                   const std::vector<std::filesystem::path>& inputs);

}  // namespace spherule
