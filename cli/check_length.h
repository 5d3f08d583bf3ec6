// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace spherule {

// For CLI::Option::check: what is wrong with the text of a length, or nothing. A text that is no
// number is left to the conversion to refuse.
std::string check_length(const std::string& text);

}  // namespace spherule
