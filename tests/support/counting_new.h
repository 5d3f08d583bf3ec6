// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace spherule::test {

// A program that links spherule_counting_new has this: calls of operator new so far.
extern int allocations;

}  // namespace spherule::test
