// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// One body against one obstacle: the dual-tree search over nodes of eight. Part of the kernels, see
// mechanism_kernel_impl.h.

#include "collide/mechanism/kernel_vectors.h"
#include "collide/mechanism/mechanism_kernel.h"

#include <cstddef>

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

// The obstacle is opened until its sphere is smaller than this part of the body's: opening the body
// costs a change of frame. Measured on the workload of bench/, from 0.35 to 1.
constexpr float kOpenBody = 0.7F;

struct Spheres {
  Float8 x, y, z, radius;
};

// To memory, where single lanes are read.
SPHERULE_INLINE void hold(const Spheres& spheres, KernelSpheres& lanes) {
  __builtin_memcpy(lanes.x, &spheres.x, sizeof lanes.x);
  __builtin_memcpy(lanes.y, &spheres.y, sizeof lanes.y);
  __builtin_memcpy(lanes.z, &spheres.z, sizeof lanes.z);
  __builtin_memcpy(lanes.radius, &spheres.radius, sizeof lanes.radius);
}

template <class Lanes>
SPHERULE_INLINE Spheres spheres_of(const Lanes& node) {
  return {load(node.x), load(node.y), load(node.z), load(node.radius)};
}

SPHERULE_INLINE unsigned overlaps(const Spheres& spheres, float x, float y, float z, float radius) {
  const Float8 dx = spheres.x - x;
  const Float8 dy = spheres.y - y;
  const Float8 dz = spheres.z - z;
  const Float8 limit = spheres.radius + radius;
  return mask_of(dx * dx + dy * dy + dz * dz <= limit * limit);
}

// A body's place: columns and origin of its frame in single precision, and by how much its spheres
// are grown there.
struct alignas(16) Placement {
  float columns[4][4];
  float inflation = 0.0F;
};

SPHERULE_INLINE Spheres placed(const PackedNode& node, const Placement& at) {
  const auto& [x, y, z, t] = at.columns;
  const Spheres in = spheres_of(node);
  return {x[0] * in.x + y[0] * in.y + z[0] * in.z + t[0],
          x[1] * in.x + y[1] * in.y + z[1] * in.z + t[1],
          x[2] * in.x + y[2] * in.y + z[2] * in.z + t[2], in.radius + at.inflation};
}

// The search from two spheres around all that overlap. `Leaves` is told of pairs of leaves that are
// not apart, and ends the search by answering true:
//   bool operator()(std::int32_t body_sphere, std::int32_t obstacle_sphere,
//                   float squared_distance, float limit)
template <class Leaves>
class PairSearch {
 public:
  PairSearch(const KernelBody& body, const KernelObstacle& obstacle, const Placement& at,
             KernelTask* tasks, Leaves& leaves)
      : body_(body), obstacle_(obstacle), at_(at), tasks_(tasks), leaves_(leaves) {}

  // `root` is the body's sphere around all, grown. True if a pair of leaves ended the search.
  // Inlined: what is known of the leaf test and the placement then makes a check a quarter faster.
  SPHERULE_INLINE bool run(const KernelTask& root) {
    tasks_[0] = root;
    top_ = 1;
    while (top_ > 0) {
      const KernelTask& next = tasks_[--top_];
      // One number at a time: as a whole it would go through memory once more.
      const KernelTask task = {next.x, next.y, next.z, next.radius, next.body, next.obstacle};
      if (task.obstacle >= 0 ? open_obstacle(task) : open_body(task)) return true;
    }
    return false;
  }

 private:
  SPHERULE_INLINE bool open_obstacle(const KernelTask& task) {
    const PackedNode& node = obstacle_.nodes[task.obstacle];
    unsigned mask = overlaps(spheres_of(node), task.x, task.y, task.z, task.radius);
    if (mask == 0) return false;
    if (task.body < 0) {
      for (; mask != 0; mask &= mask - 1) {
        const int lane = __builtin_ctz(mask);
        if (node.child[lane] >= 0) {
          tasks_[top_++] = {task.x, task.y, task.z, task.radius, task.body, node.child[lane]};
        } else if (touch(task, node, lane, ~task.body, ~node.child[lane])) {
          return true;
        }
      }
      return false;
    }
    const PackedNode& body = body_.nodes[task.body];
    bool is_placed = false;
    KernelSpheres children;
    for (; mask != 0; mask &= mask - 1) {
      const int lane = __builtin_ctz(mask);
      const std::int32_t child = node.child[lane];
      if (child >= 0 && node.radius[lane] >= kOpenBody * task.radius) {
        tasks_[top_++] = {task.x, task.y, task.z, task.radius, task.body, child};
        continue;
      }
      if (!is_placed) {
        hold(placed(body, at_), children);
        is_placed = true;
      }
      const float x = node.x[lane];
      const float y = node.y[lane];
      const float z = node.z[lane];
      const float radius = node.radius[lane];
      for (unsigned hits = overlaps(spheres_of(children), x, y, z, radius); hits != 0;
           hits &= hits - 1) {
        const int hit = __builtin_ctz(hits);
        const std::int32_t body_child = body.child[hit];
        const KernelTask moved = {children.x[hit],      children.y[hit], children.z[hit],
                                  children.radius[hit], body_child,      child};
        if (child >= 0) {
          tasks_[top_++] = moved;
        } else if (body_child >= 0) {
          tasks_[top_++] = {x, y, z, radius, body_child, child};
        } else if (touch(moved, node, lane, ~body_child, ~child)) {
          return true;
        }
      }
    }
    return false;
  }

  // The sphere of the task is a leaf of the obstacle.
  SPHERULE_INLINE bool open_body(const KernelTask& task) {
    const PackedNode& body = body_.nodes[task.body];
    const Spheres placed_children = placed(body, at_);
    KernelSpheres children;
    hold(placed_children, children);
    for (unsigned hits = overlaps(placed_children, task.x, task.y, task.z, task.radius); hits != 0;
         hits &= hits - 1) {
      const int hit = __builtin_ctz(hits);
      const std::int32_t child = body.child[hit];
      if (child >= 0) {
        tasks_[top_++] = {task.x, task.y, task.z, task.radius, child, task.obstacle};
      } else if (touch(task, children, hit, ~child, ~task.obstacle)) {
        return true;
      }
    }
    return false;
  }

  template <class Lanes>
  SPHERULE_INLINE bool touch(const KernelTask& sphere, const Lanes& others, int lane,
                             std::int32_t body_sphere, std::int32_t obstacle_sphere) {
    const float dx = others.x[lane] - sphere.x;
    const float dy = others.y[lane] - sphere.y;
    const float dz = others.z[lane] - sphere.z;
    return leaves_(body_sphere, obstacle_sphere, dx * dx + dy * dy + dz * dz,
                   others.radius[lane] + sphere.radius);
  }

  const KernelBody& body_;
  const KernelObstacle& obstacle_;
  const Placement& at_;
  KernelTask* tasks_;
  std::size_t top_ = 0;
  Leaves& leaves_;
};

// Leaves that single precision cannot tell apart: in contact for sure, or so by the exact test.
class Contact {
 public:
  Contact(KernelPair pair, std::int32_t item, float margin, ConfirmContact confirm, void* context)
      : pair_(pair), item_(item), margin_(margin), confirm_(confirm), context_(context) {}

  SPHERULE_INLINE bool operator()(std::int32_t body_sphere, std::int32_t obstacle_sphere,
                                  float squared_distance, float limit) const {
    const float sure = limit - margin_;
    if (sure > 0.0F && squared_distance <= sure * sure) return true;
    return confirm_(context_, item_, pair_, body_sphere, obstacle_sphere);
  }

 private:
  KernelPair pair_;
  std::int32_t item_;
  float margin_;
  ConfirmContact confirm_;
  void* context_;
};

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
