// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The kernels of packed_mesh.h, compiled once for each instruction set; what
// tree_block.h says of those holds here, too. The including file defines
// SPHERULE_KERNEL.
//
// Error budget, v = 2^-24. Let S bound the coordinates and the distance to the origin of every
// point of the mesh and of every centre in the mesh's frame, and f how far a placed centre p may be
// from its exact place. A sphere that comes within c of a triangle in exact arithmetic is never
// found apart from it, or from a box around it, if its radius here is
//     r' >= (r + c + f + 25 v S) (1 + 8 v):
//   boxes: differences, squares and their sum as in packed_tree.h, without the 25 v S;
//   triangles: w.p - o, three products, three sums, errs by less than 4 v (|w| |p| + |o|) <= 8.1 v
//     S, m.p - k as well: 11.5 v S together. With packed_mesh.h, where 4 v S more are lost and
//     lengths are stretched by 8 v, which are at most 8 v S of r, s^2 + u^2 is at most
//     (r + c + f + 24 v S)^2 up to 5 v.
//   corners: w = V - p errs by v S for V and v |w| for the difference, its products with the
//     corners by 3 v |w| S, the comparison of squares by 5 v: less than 11 v S.
// Beyond its range a number becomes infinite or none; no comparison then finds anything apart.
//
// A corner within r' - margin of p, which rounds by less than 5 v of r' and of the corner's 2 v S,
// is inside the sphere for sure if the margin is at least 2 (r' - r) and f and 16 v S are in r' -
// r.

#include "collide/meshes/packed_mesh.h"
#include "collide/search/vectors.h"

#include <cstddef>

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

typedef float Float4Half __attribute__((vector_size(16), may_alias));
typedef double Double8 __attribute__((vector_size(64), may_alias));

// Boxes are opened while the box around them is at least so large beside the sphere; otherwise the
// sphere is, which costs a change of frame. Measured on the workload of bench/.
constexpr float kOpenBoxes = 1.5F;

SPHERULE_INLINE Float8 all(float x) {
  return x - Float8{};
}

// As the comparison has it: the second where one is none. Not left to the compiler, which does it
// lane by lane where vectors are shorter than these.
SPHERULE_INLINE Float8 larger(Float8 a, Float8 b) {
#if defined(__AVX__)
  return reinterpret_cast<Float8>(
      _mm256_max_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b)));
#elif defined(__SSE2__)
  const Float4Half* const of_a = reinterpret_cast<const Float4Half*>(&a);
  const Float4Half* const of_b = reinterpret_cast<const Float4Half*>(&b);
  const __m128 halves[2] = {
      _mm_max_ps(reinterpret_cast<__m128>(of_a[0]), reinterpret_cast<__m128>(of_b[0])),
      _mm_max_ps(reinterpret_cast<__m128>(of_a[1]), reinterpret_cast<__m128>(of_b[1]))};
  Float8 result;
  __builtin_memcpy(&result, halves, sizeof result);
  return result;
#else
  return a > b ? a : b;
#endif
}

// Of numbers.
SPHERULE_INLINE Float8 smaller(Float8 a, Float8 b) {
  return -larger(-a, -b);
}

// The square of a product above this does not underflow.
constexpr float kLeastProduct = 0x1p-50F;

// Of a sphere and a box: how far they are apart, squared, the sphere being a point.
SPHERULE_INLINE Float8 squared_gap(const Spheres& spheres, const Float8 (&low)[3],
                                   const Float8 (&high)[3]) {
  const Float8 dx = larger(larger(low[0] - spheres.x, spheres.x - high[0]), Float8{});
  const Float8 dy = larger(larger(low[1] - spheres.y, spheres.y - high[1]), Float8{});
  const Float8 dz = larger(larger(low[2] - spheres.z, spheres.z - high[2]), Float8{});
  return dx * dx + dy * dy + dz * dz;
}

// Eight spheres side by side, those of a node's children, and what they are.
struct MeshChildren {
  KernelSpheres spheres;
  std::int32_t child[8];
  unsigned present;
};

// `MeshSpheres` in the frame of the mesh.
class TreeSide {
 public:
  explicit TreeSide(const MeshSpheres& spheres) : spheres_(spheres) {}

  SPHERULE_INLINE void place(std::int32_t node, MeshChildren& to) const {
    const std::int32_t first = spheres_.first_child[node];
    const std::int32_t count = spheres_.child_count[node];
    Double8 x, y, z, radius;
    if (first + 8 <= spheres_.node_count) {
      __builtin_memcpy(&x, spheres_.x + first, sizeof x);
      __builtin_memcpy(&y, spheres_.y + first, sizeof y);
      __builtin_memcpy(&z, spheres_.z + first, sizeof z);
      __builtin_memcpy(&radius, spheres_.radius + first, sizeof radius);
    } else {
      x = y = z = radius = Double8{};
      for (std::int32_t i = 0; i < count; ++i) {
        x[i] = spheres_.x[first + i];
        y[i] = spheres_.y[first + i];
        z[i] = spheres_.z[first + i];
        radius[i] = spheres_.radius[first + i];
      }
    }
    const double* const r = spheres_.rotation;
    const double* const t = spheres_.translation;
    const Spheres placed = {
        __builtin_convertvector((r[0] * x + r[1] * y) + (r[2] * z + t[0]), Float8),
        __builtin_convertvector((r[3] * x + r[4] * y) + (r[5] * z + t[1]), Float8),
        __builtin_convertvector((r[6] * x + r[7] * y) + (r[8] * z + t[2]), Float8),
        __builtin_convertvector(radius, Float8) + spheres_.inflation};
    hold(placed, to.spheres);
    for (std::int32_t i = 0; i < count; ++i) {
      const std::int32_t child = first + i;
      to.child[i] = spheres_.child_count[child] == 0 ? ~spheres_.first_child[child] : child;
    }
    to.present = (1U << count) - 1U;
  }

 private:
  const MeshSpheres& spheres_;
};

class MeshSearch {
 public:
  MeshSearch(const MeshView& mesh, const MeshSpheres& spheres, float margin, MeshTasks& tasks,
             ConfirmTriangle confirm, void* context)
      : nodes_(mesh.nodes),
        blocks_(mesh.blocks),
        spheres_(spheres),
        margin_(margin),
        tasks_(tasks.waiting),
        confirm_(confirm),
        context_(context) {}

  // From one sphere. True if a sphere and a triangle ended the search.
  bool run(const MeshTask& root) {
    tasks_[0] = root;
    top_ = 1;
    while (top_ > 0) {
      const MeshTask task = tasks_[--top_];
      const MeshBox& box = task.mesh >= 0 ? nodes_[task.mesh].around : blocks_[~task.mesh].around;
      const bool is_small = task.mesh < 0 || box.size < kOpenBoxes * task.radius;
      if (task.sphere >= 0 && is_small ? open_sphere(task, box) : open_boxes(task)) return true;
    }
    return false;
  }

 private:
  // The boxes of a node that are not apart from the sphere.
  SPHERULE_INLINE bool open_boxes(const MeshTask& task) {
    const MeshNode& node = nodes_[task.mesh];
    for (unsigned mask = near_boxes(node, task); mask != 0; mask &= mask - 1) {
      const std::int32_t child = node.child[__builtin_ctz(mask)];
      const MeshTask next = {task.x, task.y, task.z, task.radius, task.sphere, child};
      if (child >= 0 || task.sphere >= 0) {
        tasks_[top_++] = next;
      } else if (touch(next)) {
        return true;
      }
    }
    return false;
  }

  // The spheres below a node that are not apart from a box.
  SPHERULE_INLINE bool open_sphere(const MeshTask& task, const MeshBox& box) {
    MeshChildren children;
    spheres_.place(task.sphere, children);
    const KernelSpheres& spheres = children.spheres;
    const Spheres lanes = spheres_of(spheres);
    const Float8 gap = squared_gap(lanes, {all(box.low[0]), all(box.low[1]), all(box.low[2])},
                                   {all(box.high[0]), all(box.high[1]), all(box.high[2])});
    unsigned hits = children.present & ~mask_of(gap > lanes.radius * lanes.radius);
    for (; hits != 0; hits &= hits - 1) {
      const int hit = __builtin_ctz(hits);
      const MeshTask next = {spheres.x[hit],      spheres.y[hit],      spheres.z[hit],
                             spheres.radius[hit], children.child[hit], task.mesh};
      if (next.mesh >= 0 || next.sphere >= 0) {
        tasks_[top_++] = next;
      } else if (touch(next)) {
        return true;
      }
    }
    return false;
  }

  SPHERULE_INLINE static unsigned near_boxes(const MeshNode& node, const MeshTask& sphere) {
    const Spheres lanes = {all(sphere.x), all(sphere.y), all(sphere.z), all(sphere.radius)};
    const Float8 gap = squared_gap(lanes, {load(node.low[0]), load(node.low[1]), load(node.low[2])},
                                   {load(node.high[0]), load(node.high[1]), load(node.high[2])});
    return mask_of(gap > lanes.radius * lanes.radius) ^ 0xffU;
  }

  // A sphere and the triangles of a block.
  SPHERULE_INLINE bool touch(const MeshTask& sphere) {
    const MeshBlock& block = blocks_[~sphere.mesh];
    const auto along = [&](const float(&axis)[3][8], const float(&offset)[8]) {
      return (load(axis[0]) * sphere.x + load(axis[1]) * sphere.y) +
             (load(axis[2]) * sphere.z - load(offset));
    };
    const Float8 height = along(block.normal, block.offset);
    const Float8 outside = larger(larger(along(block.side[0], block.side_offset[0]),
                                         along(block.side[1], block.side_offset[1])),
                                  larger(along(block.side[2], block.side_offset[2]), Float8{}));
    unsigned near =
        mask_of(height * height + outside * outside > all(sphere.radius * sphere.radius)) ^ 0xffU;
    if (near == 0) return false;
    Spheres corners[3];  // seen from the sphere
    for (int i = 0; i < 3; ++i) {
      corners[i].x = load(block.corner[i][0]) - sphere.x;
      corners[i].y = load(block.corner[i][1]) - sphere.y;
      corners[i].z = load(block.corner[i][2]) - sphere.z;
    }
    const Float8 aa = dot(corners[0], corners[0]);
    const Float8 bb = dot(corners[1], corners[1]);
    const Float8 cc = dot(corners[2], corners[2]);
    const float sure = sphere.radius - margin_;
    if (sure > 0.0F && mask_of(smaller(smaller(aa, bb), cc) <= all(sure * sure)) != 0) {
      return true;
    }
    const Float8 ab = dot(corners[0], corners[1]);
    const Float8 bc = dot(corners[1], corners[2]);
    const Float8 ca = dot(corners[2], corners[0]);
    near &= ~(separates(aa, ab, ca, sphere.radius) | separates(bb, bc, ab, sphere.radius) |
              separates(cc, ca, bc, sphere.radius));
    for (; near != 0; near &= near - 1) {
      if (confirm_(context_, ~sphere.sphere, block.triangle[__builtin_ctz(near)])) return true;
    }
    return false;
  }

  SPHERULE_INLINE static Float8 dot(const Spheres& a, const Spheres& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }

  // By the axis from the sphere's centre to a corner, of this length squared: where it is nearest.
  SPHERULE_INLINE static unsigned separates(Float8 square, Float8 one, Float8 other, float radius) {
    const Float8 least = smaller(smaller(one, other), square);
    return mask_of(least > all(kLeastProduct)) &
           mask_of(least * least > square * (radius * radius));
  }

  const MeshNode* nodes_;
  const MeshBlock* blocks_;
  const TreeSide spheres_;
  float margin_;
  MeshTask* tasks_;
  std::size_t top_ = 0;
  ConfirmTriangle confirm_;
  void* context_;
};

bool intersects(const MeshView& mesh, const MeshSpheres& spheres, float margin, MeshTasks& tasks,
                ConfirmTriangle confirm, void* context) {
  return MeshSearch(mesh, spheres, margin, tasks, confirm, context).run(spheres.root);
}

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
