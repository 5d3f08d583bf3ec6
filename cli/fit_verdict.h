// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/simplify.h"

#include <string>

namespace spherule {

// What a fit promised and did not keep, as sentences for standard error: that the spheres cover,
// and, where no least radius was asked for, that they protrude from the simplified solid by at most
// E. Empty where both are proved.
std::string broken_promises(const Simplification& simplification);

}  // namespace spherule
