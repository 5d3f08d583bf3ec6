// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/internal/open_mesh.h"

namespace spherule::internal {

std::string openness(const MeshReport& report) {
  return "its mesh is open (" + std::to_string(report.boundary_edges) +
         " edges with one triangle, " + std::to_string(report.non_manifold_edges) +
         " with more than two)";
}

}  // namespace spherule::internal
