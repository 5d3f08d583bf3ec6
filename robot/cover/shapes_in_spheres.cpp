// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"
#include "collide/solids/primitive.h"
#include "geometry/pose.h"
#include "robot/cover/primitive_mesh.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <variant>
#include <vector>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Of Pose::operator*, to first order 40 u.
double mapping_error(const Pose& pose, const Vector3d& point) {
  return mul_up(add_up(norm_upper(point), norm_upper(pose.translation())), 41.0 * kUnitRoundoff);
}

// Whether a primitive, placed by `link_from_shape`, is a subset of `sphere` in exact arithmetic.
// False also within a few units in the last place of the limit, except for a sphere about the same
// centre.
struct IsSubset {
  const Sphere& sphere;
  const Pose& link_from_shape;

  bool holds(const Vector3d& point, double reach) const {
    return certainly_contains(sphere, link_from_shape * point,
                              add_up(mapping_error(link_from_shape, point), reach));
  }

  // Convex: its corners decide.
  bool operator()(const Box& box) const {
    for (int k = 0; k < 8; ++k) {
      const Vector3d sign(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
      if (!holds(sign.cwiseProduct(box.size), 0.0)) return false;
    }
    return true;
  }
  bool operator()(const SolidSphere& inner) const {
    const Vector3d& center = link_from_shape.translation();  // exactly
    if (center == sphere.center) return inner.radius <= sphere.radius;
    return certainly_encloses(sphere, {center, inner.radius});
  }
  // The convex hull of two spheres.
  bool operator()(const Capsule& capsule) const {
    return std::ranges::all_of(std::array{0.5, -0.5}, [&](double side) {
      return holds({0.0, 0.0, side * capsule.length}, capsule.radius);
    });
  }
  // The convex hull of two circles. With d from the middle of one to the centre of the sphere, h
  // the part of d along the axis a and p the length of the rest, its farthest point is at the
  // distance sqrt(h^2 + (p + r)^2), which changes by no more than h and p do.
  //
  // Rounding, with s the sum of |d|, |t| and half the length: a is off by 35 u (pose.h), d by 41 u
  // s (mapping) and 1 u s; so h by (42 + 35 + 3) u s and d - h a by (42 + 80 + 35 + 3) u s, the sum
  // p + r by 1 u more of itself.
  bool operator()(const Cylinder& cylinder) const {
    const Vector3d axis = link_from_shape.matrix().col(2);
    return std::ranges::all_of(std::array{0.5, -0.5}, [&](double side) {
      const Vector3d middle = link_from_shape * Vector3d(0.0, 0.0, side * cylinder.length);
      const Vector3d d = sphere.center - middle;
      const double along = d.dot(axis);
      const double across = norm_upper(d - along * axis) + cylinder.radius;
      const double size = norm_upper(d) + norm_upper(link_from_shape.translation()) +
                          cylinder.length + cylinder.radius;
      return certainly_contains({Vector3d::Zero(), sphere.radius}, {along, across, 0.0},
                                mul_up(size, 256.0 * kUnitRoundoff));
    });
  }
  bool operator()(const HalfSpace&) const { return false; }
};

bool is_subset(const LinkShape& shape, const Sphere& sphere) {
  const auto* const primitive = std::get_if<Primitive>(&shape.geometry);
  return primitive != nullptr && std::visit(IsSubset{sphere, shape.link_from_shape}, *primitive);
}

// The nerve of the spheres (one vertex for each, a simplex for those that have a point in common)
// has the homology of their union. Where no sphere overlaps more than two others its components are
// paths, cycles and single triangles. None of these encloses a cavity: that takes triangles which
// form a closed surface, each vertex of which has three neighbours at least. So all of the space
// outside of the spheres is connected, and no point of it is inside of what they hold (G1).
bool enclose_no_cavity(std::span<const Sphere> spheres) {
  return std::ranges::all_of(spheres, [&](const Sphere& sphere) {
    const auto overlapping = std::ranges::count_if(
        spheres, [&](const Sphere& other) { return possibly_overlap(sphere, other); });
    return overlapping <= 3;  // itself included
  });
}

}  // namespace

bool lie_in_single_spheres(std::span<const LinkShape> shapes, std::span<const Sphere> spheres) {
  std::vector<std::size_t> holders;
  for (const LinkShape& shape : shapes) {
    const auto holds = [&](std::size_t sphere) { return is_subset(shape, spheres[sphere]); };
    if (std::ranges::any_of(holders, holds)) continue;
    std::size_t holder = 0;
    while (holder < spheres.size() && !holds(holder)) ++holder;
    if (holder == spheres.size()) return false;
    holders.push_back(holder);
  }
  std::vector<Sphere> chosen;
  for (const std::size_t holder : holders) chosen.push_back(spheres[holder]);
  return enclose_no_cavity(chosen);
}

}  // namespace spherule::internal
