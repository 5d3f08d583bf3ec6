// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/mesh_report.h"

#include <string>

namespace spherule::internal {

// How open a link's mesh is, "its mesh is open (8 edges with one triangle, 0 with more than two)":
// what that means for the caller comes behind a colon. Of a report that says it is not closed.
std::string openness(const MeshReport& report);

}  // namespace spherule::internal
