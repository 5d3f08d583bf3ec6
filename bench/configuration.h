// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace spherule {

// Positions of a robot's joints, in the order of its variables.
using Configuration = std::vector<double>;

// Whether a configuration is in contact, by some engine.
using ContactTest = std::function<bool(std::span<const double>)>;

}  // namespace spherule
