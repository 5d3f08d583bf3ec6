// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/structure/sources.h"

#include <string>
#include <vector>

namespace spherule {

// Of one of the sources or headers: the headers of the language and of others that it uses names
// of, and that neither it nor a header of ours that it includes, directly or not, does include.
// Where headers are precompiled or sources joined (packaging/cmake/SpherulePrecompiled.cmake), no
// compiler notices. Goes by a list of names, the usual ones. A line each, "std::span needs <span>".
std::vector<std::string> missing_standard_headers(const Sources& sources, const std::string& file);

}  // namespace spherule
