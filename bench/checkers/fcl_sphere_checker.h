// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/workload.h"

#include <memory>

namespace spherule {

// The same spheres as FCL shapes: one DynamicAABBTreeCollisionManager holds the moving spheres
// (moved and updated for every configuration), one each obstacle's; manager against manager.
std::unique_ptr<Checker> make_fcl_sphere_checker(const Workload& workload);

}  // namespace spherule
