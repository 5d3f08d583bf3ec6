// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Signed distances of points to solids in numbers of 100 digits: an oracle that shares no code with
// the library.

#include "collide/solids/primitive.h"
#include "tests/collide/exact_scene.h"

#include <algorithm>

namespace spherule::test {

// What a pose takes to `p`.
inline Vector<Real> brought_back(const Pose& pose, const Vector<Real>& p) {
  const Vector<Real> origin = transform(pose, Vector<Real>{0, 0, 0});
  const Vector<Real> way = {p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
  Vector<Real> result;
  for (std::size_t i = 0; i < 3; ++i) {
    Vector<Real> axis = {0, 0, 0};
    axis[i] = 1;
    const Vector<Real> image = transform(pose, axis);
    result[i] = (image[0] - origin[0]) * way[0] + (image[1] - origin[1]) * way[1] +
                (image[2] - origin[2]) * way[2];
  }
  return result;
}

// Negative inside: minus the distance to the surface.
class ExactSignedDistance {
 public:
  explicit ExactSignedDistance(const Vector<Real>& p) : p_(p) {}

  Real operator()(const Box& box) const {
    Real outside = 0;
    Real nearest_face = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
      const Real depth = Real(box.size[static_cast<Eigen::Index>(i)]) / 2 - abs(p_[i]);
      if (depth < 0) outside += depth * depth;
      nearest_face = std::min(nearest_face, depth);
    }
    return outside > 0 ? Real(sqrt(outside)) : -nearest_face;
  }
  Real operator()(const SolidSphere& sphere) const {
    return sqrt(p_[0] * p_[0] + p_[1] * p_[1] + p_[2] * p_[2]) - sphere.radius;
  }
  Real operator()(const Cylinder& cylinder) const {
    const Real side = cylinder.radius - sqrt(p_[0] * p_[0] + p_[1] * p_[1]);
    const Real end = Real(cylinder.length) / 2 - abs(p_[2]);
    if (side >= 0 && end >= 0) return -std::min(side, end);
    if (side >= 0) return -end;
    if (end >= 0) return -side;
    return sqrt(side * side + end * end);
  }
  Real operator()(const Capsule& capsule) const {
    const Real beyond = abs(p_[2]) - Real(capsule.length) / 2;
    const Real along = beyond > 0 ? beyond : Real(0);
    return sqrt(p_[0] * p_[0] + p_[1] * p_[1] + along * along) - capsule.radius;
  }
  Real operator()(const HalfSpace&) const { return p_[2]; }

 private:
  Vector<Real> p_;
};

// From a placed sphere to a placed solid: its distance where above zero, otherwise how far it has
// to move to part from it, with the sign changed.
inline Real exact_gap(const Sphere& sphere, const Pose& world_from_sphere, const Primitive& solid,
                      const Pose& world_from_solid) {
  const Vector<Real> center =
      brought_back(world_from_solid, transform(world_from_sphere, exact<Real>(sphere.center)));
  return std::visit(ExactSignedDistance(center), solid) - sphere.radius;
}

}  // namespace spherule::test
