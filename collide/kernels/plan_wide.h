// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// One test of one configuration, with eight children of a node side by side. Part of the kernels,
// see plan_kernel_impl.h.

#include "collide/kernels/plan_poses.h"
#include "collide/kernels/plan_solids.h"
#include "collide/kernels/wide_plan.h"

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
