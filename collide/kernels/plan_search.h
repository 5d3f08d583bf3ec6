// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Offsets of points from convex solids, in lanes. Part of the kernels, see plan_kernel_impl.h.
//
// Each shape gives, for a point p in the root's frame, the offset e of p from the nearest point of
// the solid (zero inside), in coordinates of its choice, and the product of e with a velocity. The
// computed e errs by less than `error` of the obstacle (plan_shapes.cpp) and the error of p.

#include "collide/kernels/plan_poses.h"
#include "collide/kernels/plan_vectors.h"

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

template <class Real>
SPHERULE_INLINE Point<Real> rotated(const PlanObstacle<Real>& solid, const Point<Real>& v) {
  const auto row = [&](const Real* r) { return r[0] * v.x + r[1] * v.y + r[2] * v.z; };
  return {row(solid.rotation[0]), row(solid.rotation[1]), row(solid.rotation[2])};
}

template <class V, class Real>
SPHERULE_INLINE V excess(const V& coordinate, Real half) {
  return with_sign(larger(magnitude(coordinate) - half, V{}), coordinate);
}

struct BoxShape {
  template <class Real>
  SPHERULE_INLINE static Point<Real> offset(const PlanObstacle<Real>& box, const Point<Real>& p) {
    const Point<Real> at = rotated(box, p - constant(box.center));
    return {excess(at.x, box.half[0]), excess(at.y, box.half[1]), excess(at.z, box.half[2])};
  }
  template <class Real>
  SPHERULE_INLINE static Vector<Real> along(const PlanObstacle<Real>& box, const Point<Real>& e,
                                            const Point<Real>& velocity) {
    return dot(e, rotated(box, velocity));
  }
};

// A sphere, a capsule: their radius is added elsewhere.
struct SegmentShape {
  template <class Real>
  SPHERULE_INLINE static Point<Real> offset(const PlanObstacle<Real>& solid, const Point<Real>& p) {
    const Point<Real> at = p - constant(solid.center);
    const Real* const axis = solid.rotation[2];
    const Vector<Real> along = axis[0] * at.x + axis[1] * at.y + axis[2] * at.z;
    const Vector<Real> clamped = smaller(larger(along, all(-solid.half[2])), all(solid.half[2]));
    return {at.x - axis[0] * clamped, at.y - axis[1] * clamped, at.z - axis[2] * clamped};
  }
  template <class Real>
  SPHERULE_INLINE static Vector<Real> along(const PlanObstacle<Real>&, const Point<Real>& e,
                                            const Point<Real>& velocity) {
    return dot(e, velocity);
  }
};

struct CylinderShape {
  template <class Real>
  SPHERULE_INLINE static Point<Real> offset(const PlanObstacle<Real>& solid, const Point<Real>& p) {
    const Point<Real> at = rotated(solid, p - constant(solid.center));
    const Vector<Real> from_axis = root(at.x * at.x + at.y * at.y);
    const Vector<Real> beyond = larger(from_axis - solid.half[0], Vector<Real>{});
    // The radius is above zero, and so is from_axis wherever the quotient matters.
    const Vector<Real> scale = beyond / larger(from_axis, all(solid.half[0]));
    return {at.x * scale, at.y * scale, excess(at.z, solid.half[2])};
  }
  template <class Real>
  SPHERULE_INLINE static Vector<Real> along(const PlanObstacle<Real>& solid, const Point<Real>& e,
                                            const Point<Real>& velocity) {
    return dot(e, rotated(solid, velocity));
  }
};

struct HalfSpaceShape {
  template <class Real>
  SPHERULE_INLINE static Point<Real> offset(const PlanObstacle<Real>& solid, const Point<Real>& p) {
    const Point<Real> at = p - constant(solid.center);
    const Real* const normal = solid.rotation[2];
    const Vector<Real> height = normal[0] * at.x + normal[1] * at.y + normal[2] * at.z;
    const Vector<Real> beyond = larger(height, Vector<Real>{});
    return {normal[0] * beyond, normal[1] * beyond, normal[2] * beyond};
  }
  template <class Real>
  SPHERULE_INLINE static Vector<Real> along(const PlanObstacle<Real>&, const Point<Real>& e,
                                            const Point<Real>& velocity) {
    return dot(e, velocity);
  }
};

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL

// One test in lanes: a body against an obstacle or another body, coarse to fine, and the proof that
// a motion is free (G6). Part of the kernels, see plan_kernel_impl.h.
//
// In each lane a part of a motion (or a configuration, a part of length 0) is evaluated at its
// middle; h is half its length. Let K be a convex solid that is static, or a sphere's centre as
// seen from the link of the other side, f the distance of a moving sphere's centre p from it, e the
// offset of p from the nearest point of K, |e| = f, and v the velocity of p against K, all at the
// middle. Distance to a convex set is convex and has the gradient e / f, so that in the whole part
//     f >= f(middle) - |e . v| h / f - bend h^2   and   f >= f(middle) - speed h,
// with the bounds of plan_vectors.h: `speed` of that velocity, `bend` of half its change. The
// sphere is apart in the whole part as long as one of these exceeds the radius R; so is what it
// encloses: the nodes of a tree speak for their leaves. For two bodies K is a point, and the
// velocity is that of the offset of their centres, as seen from a link in whose directions e is
// fixed: what that link turns with adds a vector at right angles to e.
//
// Rounding. Let |e' - e| <= p for the computed offset e', d = |e'|. Then f >= d - p and |e . v| <=
// |e' . v| + p speed. A test that finds
//     d (d - R - 2 p - bend h^2) > |e' . v| h + p speed h
// proves it: with A = f - R - bend h^2 >= d - R - bend h^2 - p > 0, (d - p) A exceeds the right
// side because d p >= p A. And d > R + p + speed h proves the other. So radii are inflated by 2 p,
// split between both sides as `error`, and p speed h is added. Velocities err by `velocity_error`
// for each unit of time, which is added to bend h; it has room for the roundings of e' . v and of
// the rotated v, 6 roundoffs of speed. All other numbers are sums of terms that are not negative;
// radii and h have slack of 16 roundoffs and more for these: let the computed square be at most
// D^2 (1 + 5.1 v) where D = d, and the computed right side at least (1 - 5 v) of the exact one.
// 16 v exceed these together.
//
// Certain contact. Let g1 and g2 bound what was added to the two radii, rounding included. A test
// that finds d <= R' - 3 g1 - 3 g2, R' being the computed sum of inflated radii, has an exact
// distance of at most R' - 2 g1 - 2 g2 + rounding < r1 + r2.

namespace spherule::internal::SPHERULE_KERNEL {
namespace {

// What all searches of an evaluation share.
template <class Real, bool kMoves>
struct SearchContext {
  const CheckPlan<Real>& plan;
  const PlanScratch<Real>& scratch;
  const PlanClient& client;
  Vector<Real> half;
  Vector<Real> half_squared;
  Real enough;
  bool all_contacts;
};

// Spheres at centres in lanes against something: lanes that are not proved apart, those that may
// overlap as placed, by how much the sphere was inflated for its motion, and how much of that the
// motion itself is worth: what is for rounding errors does not get less in shorter parts. Where all
// before the first contact is to be proved, that is all of the motion: beside the closest approach,
// where the sides only pass each other, a shorter part may be free.
template <class Real>
struct Separation {
  unsigned near;
  unsigned overlap;
  Vector<Real> squared;
  Vector<Real> inflation;
  Vector<Real> worth;
};

// The motion of one test's sides against each other, for the lanes' parts.
template <class Real>
struct LaneMotion {
  Vector<Real> speed;     // times h
  Vector<Real> bend;      // times h^2, with the velocities' error
  Vector<Real> approach;  // to be added to |e . v| h: the offset's error times speed h
  Vector<Real> error;     // in `bend`: the velocities' error times h
};

template <class Real, bool kMoves>
SPHERULE_INLINE LaneMotion<Real> motion_of(const SearchContext<Real, kMoves>& context,
                                           const PlanMotionBound<Real>& bound, Real error) {
  if constexpr (kMoves) {
    const Vector<Real> speed = context.half * bound.speed;
    const Real velocity_error = context.plan.velocity_error * *context.scratch.total_speed;
    const Vector<Real> velocities = context.half * velocity_error;
    return {speed, context.half_squared * bound.bend + velocities, error * speed, velocities};
  } else {
    return LaneMotion<Real>();
  }
}

// `velocity` gives e . v.
template <class Real, bool kMoves, class Approach>
SPHERULE_INLINE Separation<Real> separation(const SearchContext<Real, kMoves>& context,
                                            const LaneMotion<Real>& motion, const Point<Real>& e,
                                            Real reach, unsigned lanes, const Approach& approach) {
  Separation<Real> result;
  result.squared = dot(e, e);
  if constexpr (!kMoves) {
    result.near = result.overlap = lanes & ~above(result.squared, all(reach * reach));
  } else {
    const Vector<Real> far = reach + motion.speed;
    result.near = lanes & ~above(result.squared, far * far);
    result.overlap = 0;
    if (result.near == 0) return result;
    const Vector<Real> distance = root(result.squared);
    const Vector<Real> closing = magnitude(approach()) * context.half + motion.approach;
    result.near &= ~above(result.squared, distance * (reach + motion.bend) + closing);
    if (result.near == 0) return result;
    result.overlap = result.near & ~above(result.squared, all(reach * reach));
    // Where the distance is zero the quotient is infinite or no number: then smaller() gives speed.
    result.inflation = smaller(motion.bend + closing / distance, motion.speed);
    const Vector<Real> errors = motion.approach / larger(distance, all(reach)) + motion.error;
    result.worth = context.all_contacts ? motion.speed : result.inflation - Real(2) * errors;
  }
  return result;
}

// What one test has shown so far.
template <class Real, bool kMoves>
class TestSearch {
 public:
  // With `is_confirmed` the search of a motion ends where two leaves are not proved apart all along
  // a part: confirm() goes on. With `is_proved_somewhere` spheres that touch in a configuration do
  // not make a contact where the two bodies are proved free.
  TestSearch(const SearchContext<Real, kMoves>& context, std::int32_t test, unsigned lanes,
             bool is_confirmed, bool is_proved_somewhere)
      : context_(context),
        test_(test),
        active_(lanes),
        is_confirmed_(is_confirmed),
        is_proved_somewhere_(is_proved_somewhere) {}

  unsigned near() const { return near_; }
  unsigned contacts() const { return contacts_; }
  Real inflation(int lane) const { return inflation_[lane]; }

  // The lanes in which what is below an inner node has to be tested. Where the motion matters more
  // than the size of the spheres it has not, unless they may touch as placed.
  SPHERULE_INLINE unsigned open(const Separation<Real>& found, Real largest) {
    if constexpr (!kMoves) return found.near;
    const Real worth = largest > context_.enough ? largest : context_.enough;
    const unsigned coarse = found.near & ~found.overlap & above(found.inflation, all(worth));
    if (coarse != 0) add_near(coarse, found.worth);
    if (is_confirmed_) active_ &= ~near_;
    return found.near & (is_confirmed_ ? active_ : found.overlap | ~near_);
  }

  // Two leaves, or a leaf and a solid.
  SPHERULE_INLINE void leaf(const Separation<Real>& found, Real reach, Real margin) {
    if (kMoves && found.near != 0) add_near(found.near, found.worth);
    if (kMoves && is_confirmed_) {
      active_ &= ~found.near;
      return;
    }
    unsigned touching = found.overlap & ~(cleared_ | contacts_);
    const PlanClient& client = context_.client;
    if (is_proved_somewhere_) {
      for (unsigned left = touching; left != 0; left &= left - 1) {
        const int lane = __builtin_ctz(left);
        if (client.is_proved_free(client.context, lane, test_)) cleared_ |= 1U << lane;
      }
      touching &= ~cleared_;
      if (!kMoves) active_ &= ~cleared_;
    }
    if (touching == 0) return;
    const Real sure = reach - margin;
    unsigned hits = sure > Real(0) ? touching & ~above(found.squared, all(sure * sure)) : 0U;
    for (unsigned left = touching & ~hits; left != 0; left &= left - 1) {
      const int lane = __builtin_ctz(left);
      if (client.touches(client.context, lane, test_)) {
        hits |= 1U << lane;
      } else {
        cleared_ |= 1U << lane;
      }
    }
    contacts_ |= hits;
    active_ &= ~hits;
    if (!kMoves) active_ &= ~cleared_;
  }

  unsigned active() const { return active_; }

  // Where spheres are not apart that stand for what only the caller can test. `speed` is that of
  // the two sides against each other.
  void confirm(Real speed) {
    const PlanClient& client = context_.client;
    near_ = client.near(client.context, test_, near_, static_cast<double>(speed));
    for (unsigned lanes = near_; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctz(lanes);
      inflation_[lane] = speed * context_.half[lane];
      if (client.touches(client.context, lane, test_)) contacts_ |= 1U << lane;
    }
  }

 private:
  SPHERULE_INLINE void add_near(unsigned lanes, const Vector<Real>& worth) {
    near_ |= lanes;
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctz(lanes);
      if (worth[lane] > inflation_[lane]) inflation_[lane] = worth[lane];
    }
  }

  const SearchContext<Real, kMoves>& context_;
  std::int32_t test_;
  unsigned active_;
  bool is_confirmed_;
  bool is_proved_somewhere_;
  unsigned near_ = 0;
  unsigned contacts_ = 0;
  unsigned cleared_ = 0;  // by the canonical test, or a proof
  Real inflation_[kPlanLanes] = {};
};

template <class Shape, class Real, bool kMoves>
SPHERULE_INLINE Separation<Real> from_solid(const SearchContext<Real, kMoves>& context,
                                            const LaneMotion<Real>& motion,
                                            const PlanBody<Real>& body, std::int32_t node,
                                            const PlanObstacle<Real>& solid, unsigned lanes) {
  const Point<Real> p = center_of(context.scratch, body, node);
  const Point<Real> e = Shape::offset(solid, p);
  return separation<Real, kMoves>(
      context, motion, e, body.nodes[node].radius + solid.radius, lanes,
      [&] { return Shape::along(solid, e, velocity_of(context.scratch.twists[body.frame], p)); });
}

// Trees of build_tree() are less than 100 levels deep.
constexpr int kDeepest = 128;

// A body, whose root is near in `lanes`, against a solid.
template <class Shape, class Real, bool kMoves>
void search_solid(const SearchContext<Real, kMoves>& context, const LaneMotion<Real>& motion,
                  const PlanBody<Real>& body, const PlanObstacle<Real>& solid,
                  TestSearch<Real, kMoves>& search) {
  std::int32_t ends[kDeepest];
  unsigned lanes[kDeepest];
  int top = 0;
  ends[0] = body.node_count;
  lanes[0] = search.active();
  std::int32_t i = body.nodes[0].sphere >= 0 ? 0 : 1;
  while (true) {
    while (i == ends[top]) {
      if (top == 0) return;
      --top;
    }
    const unsigned live = lanes[top] & search.active();
    if (live == 0) {
      i = ends[top];
      continue;
    }
    const PlanNode<Real>& node = body.nodes[i];
    const Separation<Real> found =
        from_solid<Shape, Real, kMoves>(context, motion, body, i, solid, live);
    if (node.sphere >= 0) {
      if (found.near != 0) {
        search.leaf(found, node.radius + solid.radius, body.margin + solid.margin);
      }
      ++i;
      continue;
    }
    const unsigned opened = found.near == 0 ? 0U : search.open(found, node.radius);
    if (opened == 0) {
      i = node.next;
      continue;
    }
    ++top;
    ends[top] = node.next;
    lanes[top] = opened;
    ++i;
  }
}

// The second side of a pair: spheres that move, or that are static.
template <class Real>
struct MovingSide {
  const PlanBody<Real>& body;

  const PlanNode<Real>& node(std::int32_t i) const { return body.nodes[i]; }
  SPHERULE_INLINE Point<Real> center(const PlanScratch<Real>& scratch, std::int32_t i) const {
    return center_of(scratch, body, i);
  }
  SPHERULE_INLINE Point<Real> relative(const PlanScratch<Real>& scratch,
                                       const Point<Real>& velocity,
                                       const Point<Real>& center) const {
    return velocity - velocity_of(scratch.twists[body.frame], center);
  }
  Real margin() const { return body.margin; }
};

template <class Real>
struct StaticSide {
  const PlanObstacle<Real>& tree;

  const PlanNode<Real>& node(std::int32_t i) const { return tree.nodes[i]; }
  SPHERULE_INLINE Point<Real> center(const PlanScratch<Real>&, std::int32_t i) const {
    return constant(tree.nodes[i].center);
  }
  SPHERULE_INLINE Point<Real> relative(const PlanScratch<Real>&, const Point<Real>& velocity,
                                       const Point<Real>&) const {
    return velocity;
  }
  Real margin() const { return tree.margin; }
};

template <class Real, bool kMoves, class Side>
SPHERULE_INLINE Separation<Real> from_side(const SearchContext<Real, kMoves>& context,
                                           const LaneMotion<Real>& motion,
                                           const PlanBody<Real>& body, std::int32_t a,
                                           const Side& side, std::int32_t b, unsigned lanes) {
  const Point<Real> p = center_of(context.scratch, body, a);
  const Point<Real> q = side.center(context.scratch, b);
  const Point<Real> e = p - q;
  return separation<Real, kMoves>(
      context, motion, e, body.nodes[a].radius + side.node(b).radius, lanes, [&] {
        const Point<Real> velocity = velocity_of(context.scratch.twists[body.frame], p);
        return dot(e, side.relative(context.scratch, velocity, q));
      });
}

// Two trees whose roots are near in `lanes`, the larger sphere opened first.
template <class Real, bool kMoves, class Side>
void search_side(const SearchContext<Real, kMoves>& context, const LaneMotion<Real>& motion,
                 const PlanBody<Real>& body, const Side& side, TestSearch<Real, kMoves>& search) {
  PlanTask* const tasks = context.scratch.tasks;
  tasks[0] = {0, 0, search.active()};
  for (std::int32_t top = 1; top > 0;) {
    const PlanTask task = tasks[--top];
    const unsigned live = task.lanes & search.active();
    if (live == 0) continue;
    const PlanNode<Real>& a = body.nodes[task.a];
    const PlanNode<Real>& b = side.node(task.b);
    const Separation<Real> found =
        from_side<Real, kMoves>(context, motion, body, task.a, side, task.b, live);
    if (found.near == 0) continue;
    if (a.sphere >= 0 && b.sphere >= 0) {
      search.leaf(found, a.radius + b.radius, body.margin + side.margin());
      continue;
    }
    const unsigned opened = search.open(found, a.radius > b.radius ? a.radius : b.radius);
    if (opened == 0) continue;
    if (a.sphere >= 0 || (b.sphere < 0 && a.radius < b.radius)) {
      for (std::int32_t child = task.b + 1; child < b.next; child = side.node(child).next) {
        tasks[top++] = {task.a, child, opened};
      }
    } else {
      for (std::int32_t child = task.a + 1; child < a.next; child = body.nodes[child].next) {
        tasks[top++] = {child, task.b, opened};
      }
    }
  }
}

}  // namespace
}  // namespace spherule::internal::SPHERULE_KERNEL
