// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/meshes/mesh_tree.h"
#include "geometry/sphere.h"

#include <Eigen/Geometry>

#include <cstddef>
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

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace spherule::internal {

// A box along the axes of the mesh's frame, seen from the centre of a sphere.
struct PatchBox {
  float center[3];
  float half[3];
};

// Eight boxes, each with what is in it: a node, or ~i for triangle i. Boxes that are not there
// have a half width of -infinity, which overlaps nothing.
struct alignas(16) PatchNode {
  static constexpr int kWidth = 8;
  float center[3][kWidth];
  float half[3][kWidth];
  std::int32_t child[kWidth];

  PatchBox box(int i) const {
    return {{center[0][i], center[1][i], center[2][i]}, {half[0][i], half[1][i], half[2][i]}};
  }
};

// A bit for every box of the node that overlaps another along all axes. For any machine.
inline unsigned portable_overlaps(const PatchNode& node, const PatchBox& box) {
  unsigned mask = 0;
  for (int i = 0; i < PatchNode::kWidth; ++i) {
    unsigned all = 1;
    for (int k = 0; k < 3; ++k) {
      const float gap = node.center[k][i] - box.center[k];
      all &= (gap < 0.0F ? -gap : gap) <= node.half[k][i] + box.half[k] ? 1U : 0U;
    }
    mask |= all << i;
  }
  return mask;
}

// The same, as fast as this machine can.
inline unsigned overlaps(const PatchNode& node, const PatchBox& box) {
#if defined(__SSE2__)
  const __m128 sign = _mm_set1_ps(-0.0F);
  __m128 low = _mm_castsi128_ps(_mm_set1_epi32(-1));
  __m128 high = low;
  for (int k = 0; k < 3; ++k) {
    const __m128 center = _mm_set1_ps(box.center[k]);
    const __m128 half = _mm_set1_ps(box.half[k]);
    const auto intersects = [&](int first) {
      const __m128 gap = _mm_sub_ps(_mm_load_ps(node.center[k] + first), center);
      const __m128 limit = _mm_add_ps(_mm_load_ps(node.half[k] + first), half);
      return _mm_cmple_ps(_mm_andnot_ps(sign, gap), limit);
    };
    low = _mm_and_ps(low, intersects(0));
    high = _mm_and_ps(high, intersects(4));
  }
  return static_cast<unsigned>(_mm_movemask_ps(low) | _mm_movemask_ps(high) << 4);
#else
  return portable_overlaps(node, box);
#endif
}

// For each sphere of a cover a tree of boxes over its patches, of eight a node. Every box, its
// centre in single precision, encloses the patches below it in exact arithmetic.
class PatchTrees {
 public:
  // The patches sorted by sphere, as share_out() returns them.
  PatchTrees(std::span<const Patch> patches, std::span<const Sphere> spheres);

  // Nodes on the longest way from a root to a triangle: each has an eighth of the patches of the
  // one above it, rounded up, and there are no more than 2^30.
  static constexpr std::size_t kMaxDepth = 10;

  // The box of all patches of a sphere, and its first node; negative if it has no patches.
  struct Root {
    PatchBox box{};
    std::int32_t node = -1;
  };
  const Root& root(std::int32_t sphere) const { return roots_[static_cast<std::size_t>(sphere)]; }
  const PatchNode& node(std::int32_t i) const { return nodes_[static_cast<std::size_t>(i)]; }

 private:
  std::vector<PatchNode> nodes_;
  std::vector<Root> roots_;
};

}  // namespace spherule::internal
