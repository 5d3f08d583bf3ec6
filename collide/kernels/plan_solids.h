// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Offsets of points from convex solids, in lanes. Part of the kernels, see plan_kernel_impl.h.
//
// Each shape gives, for a point p in the root's frame, the offset e of p from the nearest point of
// the solid (zero inside), in coordinates of its choice, and the product of e with a velocity. The
// computed e errs by less than `error` of the obstacle (plan_shapes.cpp) and the error of p.

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
