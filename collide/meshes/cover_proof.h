// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mesh_tree.h"
#include "spheretree/sphere.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// The part of a triangle that a sphere stands for: it lies within the sphere and within the box, in
// exact arithmetic.
struct Patch {
  std::int32_t sphere;
  std::int32_t triangle;
  Eigen::AlignedBox3d box;
};

// Shares every triangle of the mesh out among spheres that contain it, by one patch for a sphere
// and a triangle at most, sorted by sphere and triangle: every point of the triangle is in a patch.
// Each triangle is halved until every piece lies in one sphere, with outward rounding, and goes to
// the smallest such sphere. Throws Error, naming a triangle, if the spheres do not cover it; also
// where the proof takes so many pieces that only a gap can be the cause, or spheres that meet in a
// point without any overlap; and if there are more than 2^30 patches.
std::vector<Patch> share_out(const MeshTree& mesh, std::span<const Sphere> spheres);

}  // namespace spherule::internal
