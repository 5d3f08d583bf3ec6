// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Which cells of space a method takes.
//
// @code{.cpp}
// #include <spherule/bench/baseline/filling.h>
// #include <spherule/bench/baseline/voxelisation.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto filling = spherule::Filling::kSurface;
// const auto voxels = spherule::voxelise(tetrahedron, {.step = 0.1, .filling = filling});
// assert(voxels.surface > 0 && voxels.inside == 0);
// @endcode

namespace spherule {

// Which cells of space a method takes.
enum class Filling {
  kSolid,   // those that the surface intersects and those inside
  kSurface  // those that the surface intersects
};

}  // namespace spherule
