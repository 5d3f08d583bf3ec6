// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The kernels of compiled checks, compiled once for each instruction set: the including file
// defines SPHERULE_KERNEL, a namespace of its own. Vectors are those of the compiler, which makes
// of them what the machine has. Nothing here comes from a header with inline functions, which the
// linker could share between files that were compiled for different machines.
//
// Which instructions and which order of operations are used changes the rounding, and so what is
// found apart, but not the answer: what is neither certainly apart nor certainly in contact is
// decided by the caller.

#include "collide/kernels/plan_poses.h"
#include "collide/kernels/plan_search.h"
#include "collide/kernels/plan_vectors.h"
#include "collide/kernels/plan_wide.h"

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

// So many lanes are searched one by one rather than side by side.
constexpr int kFewLanes = 3;

// One evaluation of eight configurations, or of eight parts at their middles.
template <class Real, bool kMoves>
class Evaluation {
 public:
  // `parts` only if it moves.
  Evaluation(const CheckPlan<Real>& plan, const PlanScratch<Real>& scratch, unsigned lanes,
             const PlanClient& client, PlanParts* parts)
      : plan_(plan), scratch_(scratch), parts_(parts), lanes_(lanes), context_{plan,   scratch,
                                                                               client, {},
                                                                               {},     Real(0),
                                                                               false} {
    if constexpr (kMoves) {
      context_.half = rounded(load(parts->half) * (1.0 + 0x1p-16), Real());
      context_.half_squared = context_.half * context_.half;
      context_.enough = static_cast<Real>(parts->enough);
      context_.all_contacts = parts->all_contacts;
      place_middles(plan, scratch, *parts);
    }
    ++*scratch.evaluation;
    if (scratch.wide != nullptr) ++*scratch.wide_scratch->evaluation;
    place_frames(plan, scratch);
  }

  // The same as placed, without the motion, for single tests, where one contact is enough.
  explicit Evaluation(const Evaluation<Real, true>& other)
      : plan_(other.plan_),
        scratch_(other.scratch_),
        parts_(nullptr),
        lanes_(other.lanes_),
        context_{plan_, scratch_, other.context_.client, {}, {}, Real(0), false},
        is_alone_(true) {}

  // Lanes in which there is a contact.
  unsigned run() {
    if constexpr (kMoves) {
      if (has_recent_contact()) return contacts_;
      place_twists(plan_, scratch_);
      if (!scratch_.has_bounds[0]) bound_bodies(plan_, scratch_);
      scratch_.has_bounds[0] = true;
    }
    for (std::int32_t b = 0; b < plan_.body_count && !is_done(); ++b) {
      test_obstacles(b);
      if (kMoves) search_candidates(true);
    }
    const std::int32_t pairs = context_.client.skips_never ? plan_.first_never : plan_.pair_count;
    for (std::int32_t p = 0; p < pairs && !is_done(); ++p) test_pair(p);
    if (kMoves) search_candidates(true);
    search_candidates(false);
    return contacts_;
  }

 private:
  friend class Evaluation<Real, !kMoves>;

  bool is_done() const {
    if constexpr (kMoves) return contacts_ != 0 && !parts_->all_contacts;
    return lanes_ == 0;
  }

  // Whether one of the tests that touched last touches in the middle of any part, which is found
  // without the bounds of the motion.
  bool has_recent_contact() {
    if (parts_->all_contacts || parts_->open != nullptr) return false;
    const PlanRecent& recent = *scratch_.recent;
    Evaluation<Real, false> still(*this);
    for (std::int32_t i = 0; i < recent.count; ++i) {
      contacts_ = still.test_alone(recent.tests[i]);
      if (contacts_ == 0) continue;
      remember(*scratch_.recent, recent.tests[i]);
      return true;
    }
    return false;
  }

  // Of all lanes as they are placed; the lanes that touch.
  unsigned test_alone(std::int32_t test) {
    if (test >= plan_.first_pair) {
      test_pair(test - plan_.first_pair);
    } else {
      const PlanBoxes<Real>& boxes = plan_.groups[test / kPlanLanes];
      test_obstacle(boxes.body, test, boxes.obstacle[test % kPlanLanes]);
      search_candidates(false);
    }
    return contacts_;
  }

  // Of a motion, what overlaps as placed is likely to touch: it is searched at once, the rest when
  // nothing else is left.
  void search_candidates(bool overlaps) {
    std::int32_t left = 0;
    for (std::int32_t i = 0; i < candidate_count_; ++i) {
      const PlanCandidate candidate = scratch_.candidates[i];
      if (is_done() || (overlaps && candidate.overlap == 0)) {
        scratch_.candidates[left++] = candidate;
      } else {
        search(candidate);
      }
    }
    candidate_count_ = left;
  }

  // The lanes in which a test has to be made.
  SPHERULE_INLINE unsigned open_lanes(std::int32_t test) const {
    if constexpr (!kMoves) return lanes_;
    if (parts_->open == nullptr) return lanes_;
    unsigned open = 0;
    for (unsigned left = lanes_; left != 0; left &= left - 1) {
      const int lane = __builtin_ctz(left);
      const std::uint64_t word = parts_->open[lane * plan_.word_count + test / 64];
      open |= static_cast<unsigned>(word >> (test % 64) & 1U) << lane;
    }
    return open;
  }

  // The tests of a group that have to be made in some lane, a bit each.
  SPHERULE_INLINE unsigned open_tests(std::int32_t group) const {
    if constexpr (!kMoves) return kAllLanes;
    if (parts_->open == nullptr) return kAllLanes;
    std::uint64_t bits = 0;
    for (unsigned left = lanes_; left != 0; left &= left - 1) {
      bits |= parts_->open[__builtin_ctz(left) * plan_.word_count + group / 8];
    }
    return static_cast<unsigned>(bits >> (group % 8 * 8)) & kAllLanes;
  }

  // Obstacles whose boxes are clear of all lanes' spheres are not tested at all.
  void test_obstacles(std::int32_t index) {
    const PlanBody<Real>& body = plan_.bodies[index];
    bool has_box = false;
    Vector<Real> lower[3];
    Vector<Real> upper[3];
    for (std::int32_t g = body.first_group; g < body.first_group + body.group_count; ++g) {
      unsigned tests = open_tests(g);
      if (tests == 0) continue;
      if (!has_box) bound_lanes(index, lower, upper);
      has_box = true;
      const PlanBoxes<Real>& boxes = plan_.groups[g];
      Vector<Real> gap = all(Real(-1));
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        gap = larger(gap, larger(load(boxes.lower[i]) - upper[i], lower[i] - load(boxes.upper[i])));
      }
      tests &= ~above(gap, Vector<Real>{});
      for (; tests != 0; tests &= tests - 1) {
        const int lane = __builtin_ctz(tests);
        test_obstacle(index, g * kPlanLanes + lane, boxes.obstacle[lane]);
        if (is_done()) return;
      }
    }
  }

  SPHERULE_INLINE void bound_lanes(std::int32_t index, Vector<Real>* lower,
                                   Vector<Real>* upper) const {
    const PlanBody<Real>& body = plan_.bodies[index];
    const Point<Real> p = center_of(scratch_, body, 0);
    Vector<Real> reach = all(body.nodes[0].radius);
    if constexpr (kMoves) reach += context_.half * scratch_.body_bounds[index].speed;
    if (lanes_ != kAllLanes) reach = only<Real>(lanes_, reach);
    lower[0] = all(lowest(p.x - reach));
    lower[1] = all(lowest(p.y - reach));
    lower[2] = all(lowest(p.z - reach));
    upper[0] = all(highest(p.x + reach));
    upper[1] = all(highest(p.y + reach));
    upper[2] = all(highest(p.z + reach));
  }

  LaneMotion<Real> motion_against(std::int32_t body, const PlanObstacle<Real>& obstacle) const {
    return motion_of(context_, scratch_.body_bounds[body],
                     plan_.bodies[body].error + obstacle.error);
  }

  LaneMotion<Real> motion_of_pair(std::int32_t pair) const {
    const PlanPair& both = plan_.pairs[pair];
    return motion_of(context_, scratch_.pair_bounds[pair],
                     plan_.bodies[both.first].error + plan_.bodies[both.second].error);
  }

  void test_obstacle(std::int32_t index, std::int32_t test, std::int32_t obstacle_index) {
    const unsigned open = open_lanes(test);
    if (open == 0) return;
    const PlanBody<Real>& body = plan_.bodies[index];
    const PlanObstacle<Real>& obstacle = plan_.obstacles[obstacle_index];
    const LaneMotion<Real> motion = motion_against(index, obstacle);
    const auto solid = [&](auto shape) {
      return from_solid<decltype(shape), Real, kMoves>(context_, motion, body, 0, obstacle, open);
    };
    Separation<Real> found;
    switch (obstacle.shape) {
      case PlanShape::kBox:
        found = solid(BoxShape());
        break;
      case PlanShape::kSegment:
        found = solid(SegmentShape());
        break;
      case PlanShape::kCylinder:
        found = solid(CylinderShape());
        break;
      case PlanShape::kHalfSpace:
        found = solid(HalfSpaceShape());
        break;
      case PlanShape::kTree:
        found =
            from_side<Real, kMoves>(context_, motion, body, 0, StaticSide<Real>{obstacle}, 0, open);
        break;
    }
    add({test, index, found.near, found.overlap}, body.is_confirmed || obstacle.is_confirmed);
  }

  // Whether two bodies are apart in all lanes for any motion of theirs against the root. One that
  // joints of the other alone move against the root moves against it by no more than these give it.
  SPHERULE_INLINE bool are_far(const PlanPair& both) const {
    const PlanBody<Real>& first = plan_.bodies[both.first];
    const PlanBody<Real>& second = plan_.bodies[both.second];
    const Point<Real> e = center_of(scratch_, first, 0) - center_of(scratch_, second, 0);
    const Real speed = scratch_.body_bounds[both.first].speed +
                       (both.second_moves ? scratch_.body_bounds[both.second].speed : Real(0));
    const Vector<Real> far = first.nodes[0].radius + second.nodes[0].radius + context_.half * speed;
    return above(dot(e, e), far * far) == kAllLanes;
  }

  void test_pair(std::int32_t pair) {
    const std::int32_t test = plan_.first_pair + pair;
    const unsigned open = open_lanes(test);
    if (open == 0) return;
    const PlanPair& both = plan_.pairs[pair];
    if constexpr (kMoves) {
      bool& has_bounds = scratch_.has_bounds[1 + pair / kPlanLanes];
      if (!has_bounds) {
        if (are_far(both)) return;
        bound_pairs(plan_, scratch_, pair / kPlanLanes);
        has_bounds = true;
      }
    }
    const LaneMotion<Real> motion = motion_of_pair(pair);
    const Separation<Real> found =
        from_side<Real, kMoves>(context_, motion, plan_.bodies[both.first], 0,
                                MovingSide<Real>{plan_.bodies[both.second]}, 0, open);
    if (found.near == 0) return;
    const unsigned near = found.near & ~lanes_in_free_cells<Real, kMoves>(
                                           plan_.free_cells[pair], scratch_, parts_, found.near);
    if constexpr (kMoves) {
      const PlanClient& client = context_.client;
      const bool may_be_proved = near != 0 && both.is_proved_somewhere;
      if (may_be_proved && client.is_motion_proved(client.context, test)) return;
    }
    add({test, both.first, near, found.overlap & near},
        plan_.bodies[both.first].is_confirmed || plan_.bodies[both.second].is_confirmed);
  }

  // What the caller confirms is searched last.
  SPHERULE_INLINE void add(PlanCandidate candidate, bool is_confirmed) {
    if (candidate.near == 0) return;
    if (is_confirmed) candidate.overlap = 0;
    if (kMoves || is_confirmed) {
      scratch_.candidates[candidate_count_++] = candidate;
    } else {
      search(candidate);
    }
  }

  void search(const PlanCandidate& candidate) {
    const std::int32_t test = candidate.test;
    const PlanBody<Real>& body = plan_.bodies[candidate.body];
    const bool is_pair = test >= plan_.first_pair;
    const std::int32_t pair = test - plan_.first_pair;
    const PlanBody<Real>* const other = is_pair ? &plan_.bodies[plan_.pairs[pair].second] : nullptr;
    const PlanObstacle<Real>* const obstacle =
        is_pair ? nullptr
                : &plan_.obstacles[plan_.groups[test / kPlanLanes].obstacle[test % kPlanLanes]];
    if constexpr (!kMoves && sizeof(Real) == sizeof(float)) {
      const unsigned near = candidate.near & lanes_;
      if (scratch_.wide != nullptr && (is_alone_ || __builtin_popcount(near) <= kFewLanes)) {
        contacts_ |= LaneSearch(plan_, scratch_, context_.client).touches(test, near, is_alone_);
        lanes_ &= ~contacts_;
        return;
      }
    }
    const bool is_confirmed =
        body.is_confirmed || (is_pair ? other->is_confirmed : obstacle->is_confirmed);
    const unsigned lanes = kMoves ? candidate.near : candidate.near & lanes_;
    const bool is_proved_somewhere = is_pair && plan_.pairs[pair].is_proved_somewhere;
    TestSearch<Real, kMoves> search(context_, test, lanes, is_confirmed, is_proved_somewhere);
    if (is_pair) {
      search_side<Real, kMoves>(context_, motion_of_pair(pair), body, MovingSide<Real>{*other},
                                search);
    } else {
      search_obstacle(candidate.body, *obstacle, search);
    }
    if (kMoves && is_confirmed && search.near() != 0) {
      search.confirm(is_pair ? scratch_.pair_bounds[pair].speed
                             : scratch_.body_bounds[candidate.body].speed);
    }
    contacts_ |= search.contacts();
    if constexpr (kMoves) {
      if (search.contacts() != 0) remember(*scratch_.recent, test);
      unsigned near = search.near() | search.contacts();
      if (near != 0 && is_proved_somewhere) {
        const PlanClient& client = context_.client;
        near &= ~client.proved_parts(client.context, test, near);
      }
      conclude(test, near, search);
    } else {
      lanes_ &= ~search.contacts();
    }
  }

  void search_obstacle(std::int32_t index, const PlanObstacle<Real>& obstacle,
                       TestSearch<Real, kMoves>& search) {
    const PlanBody<Real>& body = plan_.bodies[index];
    const LaneMotion<Real> motion = motion_against(index, obstacle);
    switch (obstacle.shape) {
      case PlanShape::kBox:
        return search_solid<BoxShape>(context_, motion, body, obstacle, search);
      case PlanShape::kSegment:
        return search_solid<SegmentShape>(context_, motion, body, obstacle, search);
      case PlanShape::kCylinder:
        return search_solid<CylinderShape>(context_, motion, body, obstacle, search);
      case PlanShape::kHalfSpace:
        return search_solid<HalfSpaceShape>(context_, motion, body, obstacle, search);
      case PlanShape::kTree:
        return search_side<Real, kMoves>(context_, motion, body, StaticSide<Real>{obstacle},
                                         search);
    }
  }

  // Notes the lanes in which the test is not proved apart.
  void conclude(std::int32_t test, unsigned near, const TestSearch<Real, kMoves>& search) {
    parts_->any_near |= near;
    for (unsigned left = near; left != 0; left &= left - 1) {
      const int lane = __builtin_ctz(left);
      parts_->near[lane * plan_.word_count + test / 64] |= std::uint64_t{1} << (test % 64);
      if (!(static_cast<double>(search.inflation(lane)) > parts_->enough)) {
        parts_->given_up |= 1U << lane;
      }
    }
  }

  const CheckPlan<Real>& plan_;
  const PlanScratch<Real>& scratch_;
  PlanParts* parts_;
  unsigned lanes_;
  unsigned contacts_ = 0;
  std::int32_t candidate_count_ = 0;
  SearchContext<Real, kMoves> context_;
  bool is_alone_ = false;
};

unsigned check_lanes(const CheckPlan<float>& plan, const PlanScratch<float>& scratch,
                     unsigned lanes, const PlanClient& client) {
  return Evaluation<float, false>(plan, scratch, lanes, client, nullptr).run();
}

template <class Real>
void evaluate(const CheckPlan<Real>& plan, const PlanScratch<Real>& scratch, PlanParts& parts,
              const PlanClient& client) {
  parts.any_near = parts.given_up = parts.contacts = 0;
  for (std::int32_t i = 0; i < kPlanLanes * plan.word_count; ++i) parts.near[i] = 0;
  parts.contacts = Evaluation<Real, true>(plan, scratch, parts.lanes, client, &parts).run();
}

bool check_one(const CheckPlan<float>& plan, const WidePlan& wide, const WideScratch& scratch,
               const PlanClient& client) {
  return SingleCheck(plan, wide, scratch, client).run();
}

constexpr PlanKernelSet kPlanKernels = {&evaluate<float>, &evaluate<double>, &check_lanes,
                                        &check_one};

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
