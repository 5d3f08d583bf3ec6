// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// What a search for contacts of spheres and triangles works on, as plain data, and the kernels that
// do it, one for each instruction set. It takes place in the frame of the mesh.

#include "geometry/sphere.h"
#include "geometry/triangles.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::internal {

struct MeshBox {
  float low[3];
  float high[3];
  float size;  // half of the diagonal
};

// Eight boxes, as one wide test reads them.
struct alignas(64) MeshNode {
  static constexpr int kWidth = 8;

  float low[3][kWidth];
  float high[3][kWidth];
  // In the box: a node, or ~i for block i. Lanes without one are boxes that nothing reaches.
  std::int32_t child[kWidth];
  MeshBox around;
};

// Eight triangles, see packed_mesh.h. Lanes without one are planes that nothing reaches.
struct alignas(64) MeshBlock {
  static constexpr int kWidth = 8;

  float normal[3][kWidth];
  float offset[kWidth];
  float side[3][3][kWidth];  // of an edge, an axis
  float side_offset[3][kWidth];
  float corner[3][3][kWidth];  // of a corner, an axis; rounded to nearest
  std::int32_t triangle[kWidth];
  MeshBox around;
};

struct MeshView {
  const MeshNode* nodes;
  const MeshBlock* blocks;
};

// A sphere, in the mesh's frame, and where the search goes on: below `sphere` (a node of the
// spheres, or ~i for sphere i) and `mesh` (a node, or ~i for block i).
struct MeshTask {
  float x, y, z, radius;
  std::int32_t sphere;
  std::int32_t mesh;
};

// What waits. Every step takes one and leaves at most eight, a node of which lies a level deeper,
// so that at most seven wait for every level of the two trees.
struct MeshTasks {
  static constexpr int kRoom = 1024;
  // Levels of both trees together that there is room for: the 99 of a tree of build_tree with as
  // many spheres as it takes, and more than a mesh can have.
  static constexpr int kLevels = (kRoom - 1) / 7 - 1;

  MeshTask waiting[kRoom];
};

// A sphere tree as it is (spheretree/sphere_tree.h), with at most eight children a node; the way to
// the mesh's frame; and by how much its spheres are grown there.
struct MeshSpheres {
  const double* x;
  const double* y;
  const double* z;
  const double* radius;
  const std::int32_t* first_child;
  const std::int32_t* child_count;
  std::int32_t node_count;
  double rotation[9];  // by rows
  double translation[3];
  float inflation;
  MeshTask root;  // the sphere around all, there and grown
};

// A sphere and a triangle that single precision cannot tell apart: whether they touch.
using ConfirmTriangle = bool (*)(void* context, std::int32_t sphere, std::int32_t triangle);

// True if a sphere intersects a triangle for sure, a corner being inside by `margin` at least, or
// is confirmed to; false if none does.
using MeshKernel = bool (*)(const MeshView& mesh, const MeshSpheres& spheres, float margin,
                            MeshTasks& tasks, ConfirmTriangle confirm, void* context);

MeshKernel portable_mesh_kernel();
#if defined(SPHERULE_X86_KERNELS)
MeshKernel avx2_mesh_kernel();
MeshKernel avx512_mesh_kernel();
#endif

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
  // Below this a triangle is as good as a segment, see triangle_leaves.h.
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
