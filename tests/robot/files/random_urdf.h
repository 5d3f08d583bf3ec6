// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/support/random.h"

#include <string>

namespace spherule::test {

// A URDF file of a random tree of joints of all types that move, and fixed ones: turned origins,
// axes of any length, mimics in chains and of joints that come later, shapes, and elements in no
// order.
std::string random_urdf(Random& random, int joints);

}  // namespace spherule::test
