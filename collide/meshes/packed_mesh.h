// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/meshes/mesh_kernel.h"
#include "mesh/geometry/triangle_pair.h"
#include "spheretree/sphere.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

// Triangles for filters in single precision: boxes along the axes, eight to a node, over blocks of
// eight triangles. v = 2^-24.
//
// Boxes are rounded outward. A triangle in a block is known by its plane and its three edges: unit
// vectors w across the plane and m across an edge, within the plane and away from the third corner,
// with offsets o and k, all in single precision. However they were found, they are checked: for
// every corner V, in exact arithmetic and up to the rounding of double,
//     |w.V - o| <= 4 v B,   m.V <= k,   |w|^2, |m|^2 <= 1 + 8 v,   |w.m| <= 8 v,
// where B bounds all coordinates, and the distance to the origin, of the corners. So V -> (w.V,
// m.V) stretches no distance by more than 1 + 8 v, and with s = w.p - o, u = max(0, m.p - k) the
// distance from p to the triangle is at least
//     sqrt((|s| - 4 v B)^2 + u^2) / (1 + 8 v)   (the first square zero where |s| is smaller).
// Triangles for which that does not hold, and those lower than kLowest of their longest edge, have
// lanes of not-a-numbers instead, which nothing finds apart; boxes hold their spheres.
class PackedMesh {
 public:
  // Below this a triangle is as good as a segment, see sphere_triangle.h.
  static constexpr double kLowest = 0x1p-24;

  // `spheres` enclose the triangles one by one.
  PackedMesh(std::span<const Triangle> triangles, std::span<const Sphere> spheres);

  MeshView view() const { return {nodes_.data(), blocks_.data()}; }
  // Nodes and blocks on the longest way from the root.
  int depth() const { return depth_; }

 private:
  std::vector<MeshNode> nodes_;  // the root is the first
  std::vector<MeshBlock> blocks_;
  int depth_ = 0;
};

}  // namespace spherule::internal
