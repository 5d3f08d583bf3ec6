// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A sphere for each voxel: conservative with circumscribed spheres.
//
// @code{.cpp}
// #include <spherule/bench/baseline/voxelisation.h>
// #include <cassert>
//
// const spherule::TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
//                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
// const auto voxels = spherule::voxelise(tetrahedron, {.max_error = 0.2});
// assert(voxels.spheres.size() == voxels.surface + voxels.inside && voxels.step < 0.2);
// @endcode

#include "bench/baseline/made_conservative.h"
#include "geometry/sphere.h"
#include "geometry/triangle_mesh.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace spherule {

// The sphere that stands for a voxel.
enum class VoxelSphere {
  kCircumscribed,  // around the cube, of diameter sqrt(3) times the step: contains it
  kInscribed       // of the cube's width, as the paper has it: leaves its corners out
};

// How fine voxels are, and what stands for one.
struct VoxelisationOptions {
  // Edge of a voxel, in the unit of the mesh; or 0, and max_error says how large it may be.
  double step = 0.0;
  // E: the step is a thousandth below E / sqrt(3), so that no point of a circumscribed sphere is
  // further than E from its voxel's part of M or, where that is inside, from |M|.
  double max_error = 0.0;
  VoxelSphere sphere = VoxelSphere::kCircumscribed;
  Filling filling = Filling::kSolid;
  // t: voxels that M grown by this much intersects count as the surface's; vertex_error is added.
  double padding = 0.0;
};

// The spheres, and how many voxels there are.
struct Voxelisation {
  std::vector<Sphere> spheres;  // one a voxel, along the Morton curve
  double step = 0.0;            // edge of the voxels
  std::size_t surface = 0;      // voxels that the surface may intersect
  std::size_t inside = 0;       // the others
};

// Conservative with circumscribed spheres (with Filling::kSurface: of the surface M only); with
// inscribed ones not. A grid of cubes, so placed that the mesh stands in its middle, with a sphere
// for every cube that M intersects (supercover; by separating axes with outward rounding, so that a
// cube that M misses by less than the rounding may count, too) and for every cube inside: what
// cannot be reached from outside of the grid from cube to cube through faces, without a cube that M
// intersects. So pockets whose way in is hardly wider than a cube are filled. The paper, sections
// III ("If part of the original mesh lies within a grid section, a voxel is placed into that grid
// position otherwise it is left empty") and IV.B ("voxelised using a 5 mm grid of 5 mm diameter
// spheres"). Throws Error for a mesh that validate() refuses, for options out of range, and for a
// step that makes too many cells or spheres (2^24), with the numbers.
Voxelisation voxelise(const TriangleMesh& mesh, const VoxelisationOptions& options);

}  // namespace spherule
