// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// One body against one obstacle: the dual-tree search over nodes of eight. Part of the kernels, see
// tree_block.h.

#include "collide/kernels/tree_kernel.h"
#include "collide/search/vectors.h"

#include <cstddef>

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

// The obstacle is opened until its sphere is smaller than this part of the body's: opening the body
// costs a change of frame. Measured on the workload of bench/, from 0.35 to 1.
constexpr float kOpenBody = 0.7F;

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

// All pairs of leaves of a grown body and an obstacle that are not apart: a breadth-first search
// whose only branches are the ends of its queues, since what overlaps is a coin toss that a
// processor cannot predict. Part of the kernels, see tree_block.h.
//
// A slot names a sphere: 8 times the node that holds it and its lane. Of a body, the node behind
// the last holds the sphere around all.

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

// Moves the chosen lanes to the front and writes all eight.
SPHERULE_INLINE void put_chosen(std::int32_t* to, Int8 lanes, unsigned chosen) {
#if defined(__AVX512VL__)
  const auto packed = reinterpret_cast<Int8>(
      _mm256_maskz_compress_epi32(static_cast<__mmask8>(chosen), reinterpret_cast<__m256i>(lanes)));
  __builtin_memcpy(to, &packed, sizeof packed);
#else
  for (; chosen != 0; chosen &= chosen - 1) *to++ = lanes[__builtin_ctz(chosen)];
#endif
}

// What waits to be opened: a sphere of one side, by its slot, and a node of the other.
class Queue {
 public:
  explicit Queue(KernelQueue& memory) : slots_(memory.slots), nodes_(memory.nodes) {}

  bool waits() const { return next_ < end_; }
  bool is_full() const { return end_ > KernelQueue::kRoom; }
  std::int32_t count() const { return end_; }
  KernelLeaves pair(std::int32_t i) const { return {slots_[i], nodes_[i]}; }
  SPHERULE_INLINE std::int32_t slot() const { return slots_[next_]; }
  SPHERULE_INLINE std::int32_t take() { return nodes_[next_++]; }
  void start_over() { next_ = end_ = 0; }

  SPHERULE_INLINE void add_nodes(std::int32_t slot, Int8 nodes, unsigned chosen) {
    const Int8 slots = slot - Int8{};
    __builtin_memcpy(slots_ + end_, &slots, sizeof slots);
    put_chosen(nodes_ + end_, nodes, chosen);
    end_ += __builtin_popcount(chosen);
  }
  SPHERULE_INLINE void add_slots(Int8 slots, std::int32_t node, unsigned chosen) {
    const Int8 nodes = node - Int8{};
    __builtin_memcpy(nodes_ + end_, &nodes, sizeof nodes);
    put_chosen(slots_ + end_, slots, chosen);
    end_ += __builtin_popcount(chosen);
  }

 private:
  std::int32_t* slots_;
  std::int32_t* nodes_;
  std::int32_t next_ = 0;
  std::int32_t end_ = 0;
};

class LeafSearch {
 public:
  LeafSearch(const KernelBody& body, const KernelObstacle& obstacle, const Placement& at,
             const KernelQueues& memory)
      : body_(body),
        obstacle_(obstacle),
        at_(at),
        memory_(memory),
        body_spheres_(memory.waiting[0]),
        body_leaves_(memory.waiting[1]),
        obstacle_spheres_(memory.waiting[2]),
        obstacle_leaves_(memory.waiting[3]),
        found_(memory.waiting[4]) {}

  // False if there is no room for all.
  bool run() {
    ++*memory_.generation;
    place(body_.node_count);
    body_spheres_.add_nodes(body_.node_count * PackedNode::kWidth, Int8{}, 1);
    do {
      while (body_spheres_.waits() && !is_full()) open_for_body_sphere();
      body_spheres_.start_over();
      while (obstacle_spheres_.waits() && !is_full()) open_for_obstacle_sphere();
      obstacle_spheres_.start_over();
      while (body_leaves_.waits() && !is_full()) open_for_body_leaf();
      body_leaves_.start_over();
      while (obstacle_leaves_.waits() && !is_full()) open_for_obstacle_leaf();
      obstacle_leaves_.start_over();
      if (is_full()) return false;
    } while (body_spheres_.waits() || obstacle_spheres_.waits() || body_leaves_.waits());
    return true;
  }

  Queue& found() { return found_; }

 private:
  static constexpr Int8 kIota = {0, 1, 2, 3, 4, 5, 6, 7};

  // An inner sphere of the body and a node of the obstacle.
  SPHERULE_INLINE void open_for_body_sphere() {
    const std::int32_t slot = body_spheres_.slot();
    const std::int32_t node = body_spheres_.take();
    const PackedNode& children = obstacle_.nodes[node];
    const KernelSpheres& from = memory_.placed[slot >> 3];
    const int lane = slot & 7;
    const float radius = from.radius[lane];
    const unsigned hits = overlapping(children, from, lane);
    const unsigned leaves = leaves_of(children);
    const unsigned big = mask_of(load(children.radius) >= kOpenBody * radius);
    const std::int32_t body_node = body_.nodes[slot >> 3].child[lane];
    const Int8 slots = node * PackedNode::kWidth + kIota;
    body_spheres_.add_nodes(slot, children_of(children), hits & ~leaves & big);
    obstacle_spheres_.add_slots(slots, body_node, hits & ~leaves & ~big);
    obstacle_leaves_.add_slots(slots, body_node, hits & leaves);
  }

  // A leaf of the body and a node of the obstacle.
  SPHERULE_INLINE void open_for_body_leaf() {
    const std::int32_t slot = body_leaves_.slot();
    const PackedNode& children = obstacle_.nodes[body_leaves_.take()];
    const KernelSpheres& from = memory_.placed[slot >> 3];
    const int lane = slot & 7;
    const unsigned hits = overlapping(children, from, lane);
    const unsigned leaves = leaves_of(children);
    const std::int32_t sphere = ~body_.nodes[slot >> 3].child[lane];
    body_leaves_.add_nodes(slot, children_of(children), hits & ~leaves);
    found_.add_nodes(sphere, ~children_of(children), hits & leaves);
  }

  // An inner sphere of the obstacle and a node of the body.
  SPHERULE_INLINE void open_for_obstacle_sphere() {
    const std::int32_t slot = obstacle_spheres_.slot();
    const std::int32_t node = obstacle_spheres_.take();
    const PackedNode& from = obstacle_.nodes[slot >> 3];
    const int lane = slot & 7;
    const unsigned hits = overlapping(place(node), from, lane);
    const unsigned leaves = leaves_of(body_.nodes[node]);
    const Int8 slots = node * PackedNode::kWidth + kIota;
    body_spheres_.add_slots(slots, from.child[lane], hits & ~leaves);
    body_leaves_.add_slots(slots, from.child[lane], hits & leaves);
  }

  // A leaf of the obstacle and a node of the body.
  SPHERULE_INLINE void open_for_obstacle_leaf() {
    const std::int32_t slot = obstacle_leaves_.slot();
    const std::int32_t node = obstacle_leaves_.take();
    const PackedNode& from = obstacle_.nodes[slot >> 3];
    const int lane = slot & 7;
    const unsigned hits = overlapping(place(node), from, lane);
    const PackedNode& children = body_.nodes[node];
    const unsigned leaves = leaves_of(children);
    obstacle_leaves_.add_nodes(slot, children_of(children), hits & ~leaves);
    found_.add_slots(~children_of(children), ~from.child[lane], hits & leaves);
  }

  // The children that overlap the sphere in a lane of `from`.
  template <class Children, class Lanes>
  SPHERULE_INLINE static unsigned overlapping(const Children& children, const Lanes& from,
                                              int lane) {
    return overlaps(spheres_of(children), from.x[lane], from.y[lane], from.z[lane],
                    from.radius[lane]);
  }

  SPHERULE_INLINE static Int8 children_of(const PackedNode& node) {
    return *reinterpret_cast<const Int8*>(node.child);
  }
  SPHERULE_INLINE static unsigned leaves_of(const PackedNode& node) {
    return mask_of(children_of(node) < 0);
  }

  // The children of a node of the body where it is; computed once.
  SPHERULE_INLINE const KernelSpheres& place(std::int32_t node) {
    KernelSpheres& there = memory_.placed[node];
    if (memory_.generations[node] != *memory_.generation) {
      memory_.generations[node] = *memory_.generation;
      hold(placed(body_.nodes[node], at_), there);
    }
    return there;
  }

  // For good: what waited in a queue that is full is lost when it starts over.
  bool is_full() {
    is_overfull_ = is_overfull_ || body_spheres_.is_full() || obstacle_spheres_.is_full() ||
                   body_leaves_.is_full() || obstacle_leaves_.is_full() || found_.is_full();
    return is_overfull_;
  }

  const KernelBody& body_;
  const KernelObstacle& obstacle_;
  const Placement& at_;
  const KernelQueues& memory_;
  // What waits, by the sphere; it waits for a node of the other side.
  Queue body_spheres_;  // inner ones
  Queue body_leaves_;
  Queue obstacle_spheres_;  // inner ones
  Queue obstacle_leaves_;
  Queue found_;  // leaves of both, by their spheres
  bool is_overfull_ = false;
};

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
