// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// One configuration: sines of eight joints, obstacles and bodies by eight, nodes of eight spheres.
// Part of the kernels, see plan_kernel_impl.h.
//
// The error budget of poses is that of plan_poses.h: the same operations on the same numbers, in
// another order.

#include "collide/kernels/plan_cells.h"
#include "collide/kernels/plan_wide.h"

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
