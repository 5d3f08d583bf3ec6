// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Signed distances to the solids of collide/solids/primitive.h, in their own frames: to the
// surface, negative inside. All are convex, so that a sphere (p, r) is at least signed_distance(p)
// - r away, and where that is negative must be moved by as much to part from the solid.
//
// Each errs by less than 8 u (|p| + reach), with the reach as given (u = 2^-53), and what
// underflows:
//   box: differences u |q|, the norm of three 2.5 u, where q is at most |p| + reach; the two
//     terms of the sum are never both other than zero: 3.5 u;
//   sphere: norm 2.5 u |p|, difference 1 u (|p| + R);
//   cylinder: the norm of two, 2 u |p|; the two differences 1 u; their norm 2 u: 5 u in all;
//   capsule: z less its clamped value 1 u |p|; norm 2.5 u, difference 1 u: 4.5 u;
//   half-space: nothing.
// Half of a size is exact where it does not underflow.
//
// Planes: for any vector q whatever, a point p is no nearer to the solid than
// (q . p - support(q)) / |q|, support(q) being the largest q . x of its points x. outward(p) is the
// q for which this is the distance, up to rounding, where p is outside: that does no harm. The
// difference q . p - support(q) errs by less than 12 u |q| (|p| + reach).
//
// @code{.cpp}
// #include <spherule/collide/solids/solid_fields.h>
// #include <cassert>
//
// const auto field = spherule::internal::field_of(spherule::Box{.size = {2, 2, 2}});
// assert(field.signed_distance({3, 0, 0}) == 2.0 && field.signed_distance({0, 0, 0}) == -1.0);
// @endcode

#include "collide/solids/primitive.h"

#include <algorithm>
#include <cmath>

namespace spherule::internal {

// Of a quadrant's corner at the origin, from the excess over both sides.
inline double corner_distance(double x, double y) {
  const double outside_x = std::max(x, 0.0), outside_y = std::max(y, 0.0);
  return std::sqrt(outside_x * outside_x + outside_y * outside_y) + std::min(std::max(x, y), 0.0);
}

class BoxField {
 public:
  explicit BoxField(const Box& box) : half_(0.5 * box.size) {}

  // No point of the solid that matters lies farther from the origin.
  double reach() const { return half_.x() + half_.y() + half_.z(); }
  double signed_distance(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d excess = p.cwiseAbs() - half_;
    return excess.cwiseMax(0.0).norm() + std::min(excess.maxCoeff(), 0.0);
  }
  // The nearest point of the solid, up to rounding.
  Eigen::Vector3d nearest(const Eigen::Vector3d& p) const {
    return p.cwiseMax(-half_).cwiseMin(half_);
  }
  Eigen::Vector3d outward(const Eigen::Vector3d& p) const { return p - nearest(p); }
  double support(const Eigen::Vector3d& q) const { return q.cwiseAbs().dot(half_); }

 private:
  Eigen::Vector3d half_;
};

class SphereField {
 public:
  explicit SphereField(const SolidSphere& sphere) : radius_(sphere.radius) {}

  double reach() const { return radius_; }
  double signed_distance(const Eigen::Vector3d& p) const { return p.norm() - radius_; }
  Eigen::Vector3d nearest(const Eigen::Vector3d& p) const {
    const double norm = p.norm();
    return norm > radius_ ? Eigen::Vector3d(radius_ / norm * p) : p;
  }
  Eigen::Vector3d outward(const Eigen::Vector3d& p) const { return p; }
  double support(const Eigen::Vector3d& q) const { return radius_ * q.norm(); }

 private:
  double radius_;
};

class CylinderField {
 public:
  explicit CylinderField(const Cylinder& cylinder)
      : radius_(cylinder.radius), half_(0.5 * cylinder.length) {}

  double reach() const { return radius_ + half_; }
  double signed_distance(const Eigen::Vector3d& p) const {
    return corner_distance(from_axis(p) - radius_, std::abs(p.z()) - half_);
  }
  Eigen::Vector3d nearest(const Eigen::Vector3d& p) const {
    const double distance = from_axis(p);
    const double scale = distance > radius_ ? radius_ / distance : 1.0;
    return {scale * p.x(), scale * p.y(), std::clamp(p.z(), -half_, half_)};
  }
  Eigen::Vector3d outward(const Eigen::Vector3d& p) const { return p - nearest(p); }
  double support(const Eigen::Vector3d& q) const {
    return radius_ * from_axis(q) + half_ * std::abs(q.z());
  }

 private:
  static double from_axis(const Eigen::Vector3d& p) {
    return std::sqrt(p.x() * p.x() + p.y() * p.y());
  }

  double radius_;
  double half_;
};

class CapsuleField {
 public:
  explicit CapsuleField(const Capsule& capsule)
      : sphere_(SolidSphere{capsule.radius}), half_(0.5 * capsule.length) {}

  double reach() const { return sphere_.reach() + half_; }
  double signed_distance(const Eigen::Vector3d& p) const {
    return sphere_.signed_distance(p - on_axis(p));
  }
  Eigen::Vector3d nearest(const Eigen::Vector3d& p) const {
    return on_axis(p) + sphere_.nearest(p - on_axis(p));
  }
  Eigen::Vector3d outward(const Eigen::Vector3d& p) const { return p - on_axis(p); }
  double support(const Eigen::Vector3d& q) const {
    return sphere_.support(q) + half_ * std::abs(q.z());
  }

 private:
  Eigen::Vector3d on_axis(const Eigen::Vector3d& p) const {
    return {0.0, 0.0, std::clamp(p.z(), -half_, half_)};
  }

  SphereField sphere_;
  double half_;
};

class HalfSpaceField {
 public:
  explicit HalfSpaceField(const HalfSpace&) {}

  double reach() const { return 0.0; }
  double signed_distance(const Eigen::Vector3d& p) const { return p.z(); }
  Eigen::Vector3d nearest(const Eigen::Vector3d& p) const {
    return {p.x(), p.y(), std::min(p.z(), 0.0)};
  }
  Eigen::Vector3d outward(const Eigen::Vector3d&) const { return Eigen::Vector3d::UnitZ(); }
  double support(const Eigen::Vector3d&) const { return 0.0; }
};

inline BoxField field_of(const Box& box) {
  return BoxField(box);
}
inline SphereField field_of(const SolidSphere& sphere) {
  return SphereField(sphere);
}
inline CylinderField field_of(const Cylinder& cylinder) {
  return CylinderField(cylinder);
}
inline CapsuleField field_of(const Capsule& capsule) {
  return CapsuleField(capsule);
}
inline HalfSpaceField field_of(const HalfSpace& half_space) {
  return HalfSpaceField(half_space);
}

}  // namespace spherule::internal
