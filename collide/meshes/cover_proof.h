// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/mesh_tree.h"
#include "spheretree/sphere.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// The part of a triangle that a ball stands for: it lies within the ball and within the box, in
// exact arithmetic.
struct Patch {
  std::int32_t ball;
  std::int32_t triangle;
  Eigen::AlignedBox3d box;
};

// Shares every triangle of the mesh out among balls that contain it, by one patch for a ball and a
// triangle at most, sorted by ball and triangle: every point of the triangle is in a patch. Each
// triangle is halved until every piece lies in one ball, with outward rounding, and goes to the
// smallest such ball. Throws Error, naming a triangle, if the balls do not cover it; also where the
// proof takes so many pieces that only a gap can be the cause, or balls that meet in a point
// without any overlap; and if there are more than 2^30 patches.
std::vector<Patch> share_out(const MeshTree& mesh, std::span<const Sphere> balls);

}  // namespace spherule::internal
