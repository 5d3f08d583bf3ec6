// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace spherule::test {

// A program that links spherule_counting_new has these: calls of operator new so far, and whether
// it finds no memory any more.
extern int allocations;
extern bool exhausted;

}  // namespace spherule::test
