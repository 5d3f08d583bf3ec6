// SPDX-License-Identifier: BSD-3-Clause
#include "tests/robot/check/solid_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

Vector3d onto_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  return a + std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0) * along;
}

Vector3d onto_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a);
  const Vector3d foot = p - (p - a).dot(normal) / normal.squaredNorm() * normal;
  const auto is_left = [&](const Vector3d& from, const Vector3d& to) {
    return (to - from).cross(foot - from).dot(normal) >= 0.0;
  };
  if (is_left(a, b) && is_left(b, c) && is_left(c, a)) return foot;
  Vector3d best = onto_segment(p, a, b);
  for (const Vector3d& other : {onto_segment(p, b, c), onto_segment(p, c, a)}) {
    if ((other - p).squaredNorm() < (best - p).squaredNorm()) best = other;
  }
  return best;
}

struct Nearest {
  const Vector3d& p;

  Vector3d operator()(const Box& box) const {
    return p.cwiseMin(0.5 * box.size).cwiseMax(-0.5 * box.size);
  }
  Vector3d operator()(const SolidSphere& sphere) const {
    return p.normalized() * std::min(p.norm(), sphere.radius);
  }
  Vector3d operator()(const Cylinder& cylinder) const {
    const double side = std::hypot(p.x(), p.y());
    const double scale = side > cylinder.radius ? cylinder.radius / side : 1.0;
    const double half = 0.5 * cylinder.length;
    return {scale * p.x(), scale * p.y(), std::clamp(p.z(), -half, half)};
  }
  Vector3d operator()(const Capsule& capsule) const {
    const double half = 0.5 * capsule.length;
    const Vector3d axis(0.0, 0.0, std::clamp(p.z(), -half, half));
    const Vector3d off = p - axis;
    return axis + off * std::min(1.0, capsule.radius / std::max(off.norm(), 1e-300));
  }
  Vector3d operator()(const HalfSpace&) const { return {p.x(), p.y(), std::min(p.z(), 0.0)}; }
};

}  // namespace

Projection onto_tetrahedron(const std::array<Vector3d, 4>& corners) {
  return [corners](const Vector3d& p) -> Vector3d {
    Vector3d best = p;
    double least = std::numeric_limits<double>::infinity();
    bool is_inside = true;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector3d &a = corners[(k + 1) % 4], &b = corners[(k + 2) % 4],
                     &c = corners[(k + 3) % 4];
      const Vector3d normal = (b - a).cross(c - a);
      is_inside = is_inside && (p - a).dot(normal) * (corners[k] - a).dot(normal) >= 0.0;
      const Vector3d near = onto_triangle(p, a, b, c);
      if ((near - p).squaredNorm() >= least) continue;
      least = (near - p).squaredNorm();
      best = near;
    }
    return is_inside ? p : best;
  };
}

Projection onto_primitive(const Primitive& solid, const Pose& world_from_solid) {
  return [solid, world_from_solid,
          solid_from_world = world_from_solid.inverse()](const Vector3d& p) -> Vector3d {
    const Vector3d local = solid_from_world * p;
    return world_from_solid * std::visit(Nearest{local}, solid);
  };
}

Projection onto_sphere(const Vector3d& center, double radius) {
  return [center, radius](const Vector3d& p) -> Vector3d {
    const Vector3d off = p - center;
    return off.norm() <= radius ? p : Vector3d(center + radius / off.norm() * off);
  };
}

// The distance of two points, one of each. The ways between them get shorter with every round; it
// ends where that is by less than 1e-12, or after 3,000 rounds: in these tests then within 1e-4.
double distance_between(const Projection& a, const Projection& b, const Vector3d& from) {
  Vector3d at = from;
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 3000; ++round) {
    const Vector3d of_b = b(at);
    at = a(of_b);
    const double distance = (at - of_b).norm();
    if (distance < 1e-9 || last - distance < 1e-13) return distance;
    last = distance;
  }
  return last;
}

}  // namespace spherule::test
