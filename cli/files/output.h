// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/files/recognize.h"

#include <filesystem>
#include <string>
#include <vector>

namespace spherule {

// Throws Error, before long work is done for nothing, if a file of `outputs` cannot be made where
// it is requested, is one of `inputs`, or is named twice. Empty paths are files not requested.
void check_outputs(const std::vector<std::filesystem::path>& outputs,
                   const std::vector<std::filesystem::path>& inputs);

// Where a command puts what it makes of `input` if no place is named: in the folder in which it
// runs, under the input's name with another ending, ".json" say. Throws Error if a file of that
// name is there that is of another kind than the command makes.
std::string default_output(const std::filesystem::path& input, const char* ending, FileKind kind);

}  // namespace spherule
