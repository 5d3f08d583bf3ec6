// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// One test of one configuration, with eight children of a node side by side. Part of the kernels,
// see plan_kernel_impl.h.

#include "collide/kernels/check_plan.h"
#include "collide/kernels/plan_poses.h"
#include "collide/kernels/plan_search.h"

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

struct OneSphere {
  float x, y, z, radius;
};

// `Poses` has the frames of the configuration: entry(frame, column, row), the origin in column 3.
template <class Poses>
class WideSearch {
 public:
  // The lane is that of the client's configuration, and of the scratch's placed nodes.
  WideSearch(const CheckPlan<float>& plan, const WidePlan& wide, const WideScratch& scratch,
             const PlanClient& client, Poses poses, int lane)
      : plan_(plan),
        wide_(wide),
        scratch_(scratch),
        client_(client),
        poses_(poses),
        lane_(lane),
        first_placed_(lane * wide.placed_count) {}

  // A body and an obstacle whose boxes are not apart.
  bool touches_obstacle(std::int32_t test) {
    const PlanBoxes<float>& boxes = plan_.groups[test / kPlanLanes];
    const WideBody& body = wide_.bodies[boxes.body];
    const PlanObstacle<float>& obstacle = plan_.obstacles[boxes.obstacle[test % kPlanLanes]];
    switch (obstacle.shape) {
      case PlanShape::kBox:
        return touches_solid<BoxShape>(body, obstacle, test);
      case PlanShape::kSegment:
        return touches_solid<SegmentShape>(body, obstacle, test);
      case PlanShape::kCylinder:
        return touches_solid<CylinderShape>(body, obstacle, test);
      case PlanShape::kHalfSpace:
        return touches_solid<HalfSpaceShape>(body, obstacle, test);
      case PlanShape::kTree: {
        const WideBody& tree = wide_.bodies[wide_.tree_of[boxes.obstacle[test % kPlanLanes]]];
        return touches_body(test, body, tree,
                            {tree.center[0], tree.center[1], tree.center[2], tree.radius});
      }
    }
    return confirm(test);
  }

  // Two bodies; `all_of_second` is around the second one.
  //
  // Nodes of both sides are opened together; where one side has come to a leaf, that is kept. The
  // first leaves that may touch decide: for certain, or by the canonical test of the whole pair.
  bool touches_body(std::int32_t test, const WideBody& first, const WideBody& second,
                    const OneSphere& all_of_second) {
    const float margin = first.margin + second.margin;
    WideTask* const tasks = scratch_.tasks;
    tasks[0] = {0, 0, -1};
    for (std::int32_t top = 1; top > 0;) {
      const WideTask task = tasks[--top];
      if (task.a < 0 || task.b < 0) {
        const bool is_first = task.a < 0;  // that it is a leaf of the first
        const OneSphere leaf = is_first ? sphere_in(first, ~task.a) : sphere_in(second, ~task.b);
        const WideBody& body = is_first ? second : first;
        const std::int32_t index = is_first ? task.b : task.a;
        const Overlap hits = overlapping(body, index, leaf, margin);
        for (unsigned left = hits.near; left != 0; left &= left - 1) {
          const int hit = __builtin_ctz(left);
          const std::int32_t child = body.nodes[index].child[hit];
          if (child < 0) return (hits.certain >> hit & 1U) != 0 || confirm(test);
          tasks[top++] = is_first ? WideTask{task.a, child, 0} : WideTask{child, task.b, 0};
        }
        continue;
      }
      const OneSphere around =
          task.slot_of_b < 0 ? all_of_second : sphere_in(second, task.slot_of_b);
      for (unsigned lanes = overlapping(first, task.a, around, margin).near; lanes != 0;
           lanes &= lanes - 1) {
        const std::int32_t slot = task.a * kPlanLanes + __builtin_ctz(lanes);
        const std::int32_t child = first.nodes[task.a].child[slot % kPlanLanes];
        const Overlap hits = overlapping(second, task.b, sphere_in(first, slot), margin);
        for (unsigned left = hits.near; left != 0; left &= left - 1) {
          const int hit = __builtin_ctz(left);
          const std::int32_t other = second.nodes[task.b].child[hit];
          const std::int32_t other_slot = task.b * kPlanLanes + hit;
          if (child < 0 && other < 0) return (hits.certain >> hit & 1U) != 0 || confirm(test);
          tasks[top++] = {child < 0 ? ~slot : child, other < 0 ? ~other_slot : other, other_slot};
        }
      }
    }
    return false;
  }

  // Two bodies of a pair: the same, unless they are proved free.
  bool touches_pair(std::int32_t test, const WideBody& first, const WideBody& second,
                    const OneSphere& all_of_second) {
    return touches_body(test, first, second, all_of_second) &&
           !(plan_.pairs[test - plan_.first_pair].is_proved_somewhere &&
             client_.is_proved_free(client_.context, lane_, test));
  }

  // The sphere around all of a body.
  SPHERULE_INLINE OneSphere root_of(const WideBody& body) const {
    float at[3];
    for (int i = 0; i < 3; ++i) {
      at[i] = poses_.entry(body.frame, 3, i);
      for (int k = 0; k < 3; ++k) at[i] += poses_.entry(body.frame, k, i) * body.center[k];
    }
    return {at[0], at[1], at[2], body.radius};
  }

 private:
  bool confirm(std::int32_t test) { return client_.touches(client_.context, lane_, test); }

  // The children of a node of a body; computed once a configuration.
  SPHERULE_INLINE Point<float> placed(const WideBody& body, std::int32_t node) {
    const PackedNode& in = body.nodes[node];
    const Float8 cx = load(in.x);
    const Float8 cy = load(in.y);
    const Float8 cz = load(in.z);
    if (body.frame == 0) return {cx, cy, cz};
    const std::int32_t index = first_placed_ + body.first_node + node;
    WideSpheres& spheres = scratch_.placed[index];
    if (scratch_.stamps[index] == *scratch_.evaluation) return load_point(spheres.at);
    scratch_.stamps[index] = *scratch_.evaluation;
    // Not by a function: that returns vectors, which warns where the machine has none.
    Float8 at[3];
    for (int i = 0; i < 3; ++i) {
      at[i] = poses_.entry(body.frame, 0, i) * cx + poses_.entry(body.frame, 1, i) * cy +
              poses_.entry(body.frame, 2, i) * cz + poses_.entry(body.frame, 3, i);
      store(at[i], spheres.at[i]);
    }
    return {at[0], at[1], at[2]};
  }

  template <class Shape>
  bool touches_solid(const WideBody& body, const PlanObstacle<float>& solid, std::int32_t test) {
    WideTask* const tasks = scratch_.tasks;
    tasks[0] = {0, 0, 0};
    for (std::int32_t top = 1; top > 0;) {
      const std::int32_t index = tasks[--top].a;
      const PackedNode& node = body.nodes[index];
      const Point<float> e = Shape::offset(solid, placed(body, index));
      const Float8 squared = dot(e, e);
      const Float8 reach = load(node.radius) + solid.radius;
      // Places that are not used have no radius, and may lie in a half-space.
      const unsigned near = above(load(node.radius), Float8{}) & ~above(squared, reach * reach);
      if (near == 0) continue;
      const Float8 sure = reach - (body.margin + solid.margin);
      const unsigned certain = near & above(sure, Float8{}) & ~above(squared, sure * sure);
      for (unsigned left = near; left != 0; left &= left - 1) {
        const int lane = __builtin_ctz(left);
        if (node.child[lane] >= 0) {
          tasks[top++] = {node.child[lane], 0, 0};
        } else if ((certain >> lane & 1U) != 0) {
          return true;
        } else {
          return confirm(test);
        }
      }
    }
    return false;
  }

  // Of a node that has been placed.
  SPHERULE_INLINE OneSphere sphere_in(const WideBody& body, std::int32_t slot) const {
    const PackedNode& node = body.nodes[slot / kPlanLanes];
    const int lane = slot % kPlanLanes;
    if (body.frame == 0) return {node.x[lane], node.y[lane], node.z[lane], node.radius[lane]};
    const std::int32_t index = first_placed_ + body.first_node + slot / kPlanLanes;
    const WideSpheres& spheres = scratch_.placed[index];
    return {spheres.at[0][lane], spheres.at[1][lane], spheres.at[2][lane], node.radius[lane]};
  }

  // The children of a node that may overlap a sphere, and those that certainly do.
  struct Overlap {
    unsigned near;
    unsigned certain;
  };

  SPHERULE_INLINE Overlap overlapping(const WideBody& body, std::int32_t node,
                                      const OneSphere& sphere, float margin) {
    const Point<float> at = placed(body, node);
    const Float8 dx = at.x - sphere.x;
    const Float8 dy = at.y - sphere.y;
    const Float8 dz = at.z - sphere.z;
    const Float8 squared = dx * dx + dy * dy + dz * dz;
    const Float8 reach = load(body.nodes[node].radius) + sphere.radius;
    const unsigned near = kAllLanes & ~above(squared, reach * reach);
    if (near == 0) return {0, 0};
    const Float8 sure = reach - margin;
    return {near, near & above(sure, Float8{}) & ~above(squared, sure * sure)};
  }

  const CheckPlan<float>& plan_;
  const WidePlan& wide_;
  const WideScratch& scratch_;
  const PlanClient& client_;
  Poses poses_;
  int lane_;
  std::int32_t first_placed_;
};

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL

// What only a few of eight configurations have to search, one configuration after the other. Part
// of the kernels, see plan_kernel_impl.h.

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

// Lanes' configurations one by one.
class LaneSearch {
 public:
  LaneSearch(const CheckPlan<float>& plan, const PlanScratch<float>& scratch,
             const PlanClient& client)
      : plan_(plan), wide_(*scratch.wide), scratch_(scratch), client_(client) {}

  // Those of the lanes in which a test touches; of these one, if one is enough.
  unsigned touches(std::int32_t test, unsigned lanes, bool one_is_enough) const {
    unsigned contacts = 0;
    for (; lanes != 0 && (contacts == 0 || !one_is_enough); lanes &= lanes - 1) {
      const int lane = __builtin_ctz(lanes);
      WideSearch<LanePoses> search(plan_, wide_, *scratch_.wide_scratch, client_,
                                   LanePoses{scratch_.poses, lane}, lane);
      contacts |= (touches(test, search) ? 1U : 0U) << lane;
    }
    return contacts;
  }

 private:
  struct LanePoses {
    const PlanPose<float>* poses;
    int lane;
    float entry(std::int32_t frame, int column, int row) const {
      return poses[frame].columns[column][row][lane];
    }
  };

  bool touches(std::int32_t test, WideSearch<LanePoses>& search) const {
    if (test < plan_.first_pair) return search.touches_obstacle(test);
    const PlanPair& pair = plan_.pairs[test - plan_.first_pair];
    const WideBody& second = wide_.bodies[pair.second];
    return search.touches_pair(test, wide_.bodies[pair.first], second, search.root_of(second));
  }

  const CheckPlan<float>& plan_;
  const WidePlan& wide_;
  const PlanScratch<float>& scratch_;
  const PlanClient& client_;
};

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL

// One configuration: sines of eight joints, obstacles and bodies by eight, nodes of eight spheres.
// Part of the kernels, see plan_kernel_impl.h.
//
// The error budget of poses is that of plan_poses.h: the same operations on the same numbers, in
// another order.

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

typedef float Float4 __attribute__((vector_size(16), may_alias));

// Memory that need not be aligned to more than a number.
SPHERULE_INLINE Float8 load_anywhere(const float* p) {
  Float8 x;
  __builtin_memcpy(&x, p, sizeof x);
  return x;
}
SPHERULE_INLINE Double8 load_anywhere(const double* p) {
  Double8 x;
  __builtin_memcpy(&x, p, sizeof x);
  return x;
}
SPHERULE_INLINE void store_anywhere(const Float8& x, float* p) {
  __builtin_memcpy(p, &x, sizeof x);
}

SPHERULE_INLINE Float4 column_of(const float* p) {
  return *reinterpret_cast<const Float4*>(p);
}

struct SinglePoses {
  const WidePose* poses;
  float entry(std::int32_t frame, int column, int row) const {
    return poses[frame].columns[column][row];
  }
};

class SingleCheck {
 public:
  SingleCheck(const CheckPlan<float>& plan, const WidePlan& wide, const WideScratch& scratch,
              const PlanClient& client)
      : plan_(plan),
        wide_(wide),
        scratch_(scratch),
        client_(client),
        search_(plan, wide, scratch, client, SinglePoses{scratch.poses}, 0) {}

  // Whether any test touches.
  bool run() {
    ++*scratch_.evaluation;
    place_frames();
    place_roots();
    const PlanRecent& recent = *scratch_.recent;
    for (std::int32_t i = 0; i < recent.count; ++i) {
      if (touches(recent.tests[i])) return true;
    }
    for (std::int32_t b = 0; b < plan_.body_count; ++b) {
      if (touches_obstacles(b)) return true;
    }
    return touches_bodies();
  }

 private:
  SPHERULE_INLINE void place_frames() {
    for (std::int32_t i = 0; i < plan_.position_count; i += kPlanLanes) {
      Float8 sine, cosine;
      sine_and_cosine(load_anywhere(scratch_.positions + i), sine, cosine);
      store_anywhere(sine, scratch_.sines + i);
      store_anywhere(cosine, scratch_.cosines + i);
    }
    WidePose& base = scratch_.poses[0];
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) base.columns[i][j] = i == j ? 1.0F : 0.0F;
    }
    for (std::int32_t f = 1; f < plan_.frame_count; ++f) {
      const WideFrame& frame = wide_.frames[f];
      const Float4 f0 = column_of(frame.rotation[0]);
      const Float4 f1 = column_of(frame.rotation[1]);
      const Float4 f2 = column_of(frame.rotation[2]);
      Float4 m0 = f0;
      Float4 m1 = f1;
      Float4 m3 = column_of(frame.origin);
      if (frame.prismatic) {
        m3 += static_cast<float>(scratch_.positions[frame.position]) * f2;
      } else {
        const float sine = scratch_.sines[frame.position];
        const float cosine = scratch_.cosines[frame.position];
        m0 = cosine * f0 + sine * f1;
        m1 = cosine * f1 - sine * f0;
      }
      const WidePose& parent = scratch_.poses[frame.parent];
      const Float4 p0 = column_of(parent.columns[0]);
      const Float4 p1 = column_of(parent.columns[1]);
      const Float4 p2 = column_of(parent.columns[2]);
      auto* const pose = reinterpret_cast<Float4*>(scratch_.poses[f].columns);
      pose[0] = p0 * m0[0] + p1 * m0[1] + p2 * m0[2];
      pose[1] = p0 * m1[0] + p1 * m1[1] + p2 * m1[2];
      pose[2] = p0 * f2[0] + p1 * f2[1] + p2 * f2[2];
      pose[3] = column_of(parent.columns[3]) + p0 * m3[0] + p1 * m3[1] + p2 * m3[2];
    }
  }

  SPHERULE_INLINE void place_roots() {
    for (std::int32_t b = 0; b < plan_.body_count; ++b) {
      const WideBody& body = wide_.bodies[b];
      const auto* const pose = reinterpret_cast<const Float4*>(scratch_.poses[body.frame].columns);
      const Float4 at =
          pose[0] * body.center[0] + pose[1] * body.center[1] + pose[2] * body.center[2] + pose[3];
      for (int i = 0; i < 3; ++i) scratch_.roots[i][b] = at[i];
    }
  }

  bool remember(std::int32_t test) {
    spherule::internal::SPHERULE_KERNEL::remember(*scratch_.recent, test);
    return true;
  }

  // Of a single test, whatever is known of the spheres around all.
  bool touches(std::int32_t test) {
    if (test < plan_.first_pair) {
      const PlanBoxes<float>& boxes = plan_.groups[test / kPlanLanes];
      const unsigned near = near_obstacles(boxes, boxes.body) >> (test % kPlanLanes) & 1U;
      return near != 0 && search_.touches_obstacle(test) && remember(test);
    }
    const PlanPair& pair = plan_.pairs[test - plan_.first_pair];
    return touches_pair(test, pair.first, pair.second) && remember(test);
  }

  // Obstacles of a group whose boxes the sphere around all of a body overlaps.
  SPHERULE_INLINE unsigned near_obstacles(const PlanBoxes<float>& boxes, std::int32_t b) const {
    Float8 squared = {};
    for (int i = 0; i < 3; ++i) {
      const Float8 center = all(scratch_.roots[i][b]);
      const Float8 outside =
          larger(larger(load(boxes.lower[i]) - center, center - load(boxes.upper[i])), Float8{});
      squared += outside * outside;
    }
    const float radius = wide_.bodies[b].radius;
    return kAllLanes & ~above(squared, all(radius * radius * (1.0F + 0x1p-20F)));
  }

  bool touches_obstacles(std::int32_t b) {
    const PlanBody<float>& body = plan_.bodies[b];
    for (std::int32_t g = body.first_group; g < body.first_group + body.group_count; ++g) {
      for (unsigned near = near_obstacles(plan_.groups[g], b); near != 0; near &= near - 1) {
        const std::int32_t test = g * kPlanLanes + __builtin_ctz(near);
        if (search_.touches_obstacle(test)) return remember(test);
      }
    }
    return false;
  }

  bool touches_bodies() {
    const std::int32_t count = client_.skips_never ? wide_.touching_count : wide_.partners_count;
    for (std::int32_t i = 0; i < count; ++i) {
      const WidePartners& entry = wide_.partners[i];
      const unsigned partners = entry.partners;
      unsigned near = near_bodies(entry.body, entry.group) & partners;
      if (client_.skips_never) near &= ~static_cast<unsigned>(entry.never);
      for (; near != 0; near &= near - 1) {
        const int lane = __builtin_ctz(near);
        const std::int32_t rank = __builtin_popcount(partners & ((1U << lane) - 1));
        const std::int32_t test = wide_.pair_tests[entry.first_test + rank];
        const std::int32_t other = entry.group * WidePartners::kGroup + lane;
        if (touches_pair(test, entry.body, other)) return remember(test);
      }
    }
    return false;
  }

  // Those of a group whose spheres around all are not apart from that of a body.
  SPHERULE_INLINE unsigned near_bodies(std::int32_t a, std::int32_t group) const {
    unsigned near = 0;
    for (int half = 0; half < 2; ++half) {
      const std::int32_t first = group * WidePartners::kGroup + half * kPlanLanes;
      Float8 squared = {};
      for (int i = 0; i < 3; ++i) {
        const Float8 offset = load_anywhere(scratch_.roots[i] + first) - scratch_.roots[i][a];
        squared += offset * offset;
      }
      const Float8 reach = load_anywhere(scratch_.radii + first) + scratch_.radii[a];
      near |= (kAllLanes & ~above(squared, reach * reach)) << (half * kPlanLanes);
    }
    return near;
  }

  bool touches_pair(std::int32_t test, std::int32_t a, std::int32_t b) {
    if (is_in_free_cell(plan_.free_cells[test - plan_.first_pair], scratch_.positions)) {
      return false;
    }
    const WideBody& second = wide_.bodies[b];
    return search_.touches_pair(
        test, wide_.bodies[a], second,
        {scratch_.roots[0][b], scratch_.roots[1][b], scratch_.roots[2][b], second.radius});
  }

  const CheckPlan<float>& plan_;
  const WidePlan& wide_;
  const WideScratch& scratch_;
  const PlanClient& client_;
  WideSearch<SinglePoses> search_;
};

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
