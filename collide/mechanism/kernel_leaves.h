// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// All pairs of leaves of a grown body and an obstacle that are not apart: a breadth-first search
// whose only branches are the ends of its queues, since what overlaps is a coin toss that a
// processor cannot predict. Part of the kernels, see mechanism_kernel_impl.h.
//
// A slot names a sphere: 8 times the node that holds it and its lane. Of a body, the node behind
// the last holds the sphere around all.

#include "collide/mechanism/kernel_search.h"

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
