// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace spherule::test {

// A program that links spherule_counting_new has these: calls of operator new so far, whether it
// finds no memory any more, and how many bytes it finds at most.
extern int allocations;
extern bool exhausted;

}  // namespace spherule::test
