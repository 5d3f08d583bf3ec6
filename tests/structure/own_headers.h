// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/structure/sources.h"

#include <string>
#include <vector>

namespace spherule {

// Where sources are joined to few (SPHERULE_PRECOMPILE), one may use what only another includes. Of
// the sources and headers: names of types, constants and functions that one uses, that neither it
// nor any header that it includes, directly or not, seems to declare, and that headers among them
// declare which its room may include. Goes by names alone (source_names.h); a name that any of the
// headers declares as anything is not looked into. A line each,
// "a.cpp: Sphere needs geometry/sphere.h".
std::vector<std::string> missing_own_headers(const Sources& sources);

}  // namespace spherule
