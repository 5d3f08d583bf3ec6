// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh/triangle_mesh.h"

namespace spherule::internal {

// The same triangles over distinct vertices that are all used: vertices are one if their
// coordinates are equal bit for bit (zeros of both signs count as equal). In order of first use.
TriangleMesh weld(const TriangleMesh& mesh);

}  // namespace spherule::internal
