// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/certificate.h"
#include "simplifier/levels.h"

#include <span>
#include <string>

namespace spherule {

// What a certificate says, in a few lines for a person. `solid` names what was to be covered.
std::string describe(const Certificate& certificate, const std::string& solid);

// A line for every level.
std::string describe(std::span<const CoverLevel> levels);

}  // namespace spherule
