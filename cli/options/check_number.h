// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace spherule {

// For CLI::Option::check: what is wrong with the text of a number that must be finite and not
// negative, or nothing. A text that is no number is left to the conversion to refuse.
std::string check_not_negative(const std::string& text);

}  // namespace spherule
