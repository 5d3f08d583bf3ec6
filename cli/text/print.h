// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/simplify.h"

#include <span>
#include <string>
#include <vector>

namespace spherule {

// What a certificate says, in a few lines for a person. `solid` names what was to be covered.
std::string describe(const Certificate& certificate, const std::string& solid);

// A line for every level.
std::string describe(std::span<const CoverLevel> levels);

// A share in per cent.
std::string percent(double share, int digits = 2);

// A number with three digits, a bound of it in that direction.
enum class Rounding { kDown, kUp };
std::string three_digits(double value, Rounding rounding);

// A table of rows of as many cells each, of which there is one at least: columns as wide as their
// widest cell, no blanks at the ends of lines; each cell as one_line() says.
std::string aligned(std::vector<std::vector<std::string>> rows);

}  // namespace spherule
