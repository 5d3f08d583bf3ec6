// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace spherule {

// For CLI::Option::check: what is wrong with the text of a number that must be finite and not
// negative, or positive, or nothing. A text that is no number is left to the conversion to refuse.
// (The messages of CLI11's own checks hold the largest number there is, of 309 digits.)
std::string check_not_negative(const std::string& text);
std::string check_positive(const std::string& text);

}  // namespace spherule
