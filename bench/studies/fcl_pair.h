// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/studies/pair_engine.h"
#include "geometry/triangle_mesh.h"

#include <vector>

namespace spherule {

// FCL on two meshes in every setting that is not far slower than another: oriented boxes, or these
// with rectangle-swept spheres, or the latter alone for distances; in double from the packaged
// library and in float.
std::vector<NamedPairEngine> fcl_collide_engines(const TriangleMesh& a, const TriangleMesh& b);
// The same behind a test of the exact boxes along the world's axes.
std::vector<NamedPairEngine> fcl_boxed_collide_engines(const TriangleMesh& a,
                                                       const TriangleMesh& b);
std::vector<NamedPairEngine> fcl_distance_engines(const TriangleMesh& a, const TriangleMesh& b);

}  // namespace spherule
