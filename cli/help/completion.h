// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/help/command_specification.h"

#include <string>

namespace spherule {

// Scripts by which a shell completes the command that is outlined: commands, options, the words
// that options take, files and folders. Each is whole: it does not run the command.
std::string bash_completion(const CommandSpecification& command);
std::string zsh_completion(const CommandSpecification& command);
std::string fish_completion(const CommandSpecification& command);

}  // namespace spherule
