// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace spherule::test {

// A program that links spherule_counting_new has these: calls of operator new so far, and how many
// bytes it finds at most.
extern int allocations;
extern std::size_t most_bytes;

}  // namespace spherule::test
