// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/measure.h"
#include "bench/workload.h"

#include <vector>

namespace spherule {

// The engines of the comparison, in the order of the table; the workload must be fitted and outlive
// them. FCL's mesh engine appears in every setting under a name of its own; results.json names the
// best of them fcl-mesh-fastest.
std::vector<Method> make_methods(const Workload& workload);

// Names in results.json.
inline constexpr const char* kUsualFcl = "fcl-mesh-obbrss";
inline constexpr const char* kFastestFcl = "fcl-mesh-fastest";

}  // namespace spherule
