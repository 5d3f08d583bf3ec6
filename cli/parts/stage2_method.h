// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/simplify.h"

#include <string>
#include <vector>

namespace spherule {

// What --method takes, the default first.
std::vector<std::string> fit_method_names();

// Has the options cover by that method. Throws Error for a name that is none of them, and for one
// that only a build with baselines knows.
void choose_method(const std::string& name, SimplifyOptions& options);

}  // namespace spherule
