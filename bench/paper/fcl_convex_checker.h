// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

#include <memory>
#include <vector>

namespace spherule {

// FCL on convex parts (GJK by libccd) in place of one obstacle's mesh: the bodies and all other
// obstacles stay meshes, in hierarchies of OBBRSS in double behind exact axis-parallel boxes. The
// parts are closed, convex, with outward triangles, in the obstacle's frame. Throws Error for no
// parts.
std::unique_ptr<Checker> make_fcl_convex_checker(const Workload& workload, std::size_t obstacle,
                                                 const std::vector<TriangleMesh>& parts);

}  // namespace spherule
