// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/rounding.h"
#include "geometry/sphere.h"
#include "geometry/triangles.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>

namespace spherule::internal {

// A ray from a point that is known to within an error. What is decided holds for the ray from the
// exact point, in exactly the direction given, whose length must be in (0, 1].
//
// Budget, with everything taken relative to the point p: the corners of a triangle, of norm at most
// R, and centres of spheres err by e + u R each, where e is the error of p. With Q = R + e:
//   dot product w.a:         e + u R + 3 u R          < 2 e + 8 u Q;
//   triple product w.(a x b): 2 (e + u R) R + e^2 and for each of its six terms five roundings,
//     their absolute sum being at most sqrt(3) |a| |b|: 9 u R^2;   together < 3 e Q + 16 u Q^2;
//   triple product a.(b x c): 3 (e + u R) Q^2 and 9 u R^3;         together < 4 e Q^2 + 16 u Q^3.
class Ray {
 public:
  Ray(const Eigen::Vector3d& point, double error, const Eigen::Vector3d& direction)
      : point_(point), error_(error), direction_(direction) {}

  // False only if it does not meet the sphere.
  bool may_intersect(const Sphere& sphere) const {
    const Eigen::Vector3d c = sphere.center - point_;
    const double pad = dot_error(c.norm() * kRelativeUp) + kUnderflow;
    const double reach = sphere.radius * kRelativeUp + pad;
    // A shorter direction only makes both products smaller.
    return direction_.dot(c) >= -reach && direction_.cross(c).squaredNorm() <= reach * reach;
  }

  // If it passes through the triangle, +1 where it comes out of the side from which the corners are
  // seen counter-clockwise and -1 where it goes in there; 0 if it passes by. Nothing where that is
  // uncertain.
  std::optional<int> crossing(const Triangle& triangle) const {
    const Eigen::Vector3d a = triangle[0] - point_;
    const Eigen::Vector3d b = triangle[1] - point_;
    const Eigen::Vector3d c = triangle[2] - point_;
    const double largest = std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()});
    const double size = std::sqrt(largest) * kRelativeUp + error_ + kUnderflow;
    const double tolerance = (3.0 * error_ + 16.0 * kUnitRoundoff * size) * size + kUnderflow;
    const double sides[3] = {direction_.dot(a.cross(b)), direction_.dot(b.cross(c)),
                             direction_.dot(c.cross(a))};
    const double least = std::min({sides[0], sides[1], sides[2]});
    const double most = std::max({sides[0], sides[1], sides[2]});
    if (least < -tolerance && most > tolerance) return 0;

    const double ahead[3] = {direction_.dot(a), direction_.dot(b), direction_.dot(c)};
    const double ahead_error = dot_error(size);
    if (std::max({ahead[0], ahead[1], ahead[2]}) < -ahead_error) return 0;
    if (least <= tolerance && most >= -tolerance) return std::nullopt;

    const int turn = least > tolerance ? 1 : -1;
    if (std::min({ahead[0], ahead[1], ahead[2]}) > ahead_error) return turn;
    const double volume = a.dot(b.cross(c)) * turn;
    const double volume_error =
        (4.0 * error_ + 16.0 * kUnitRoundoff * size) * size * size + kUnderflow;
    if (volume > volume_error) return turn;
    if (volume < -volume_error) return 0;
    return std::nullopt;
  }

 private:
  double dot_error(double size) const {
    return 2.0 * error_ + 8.0 * kUnitRoundoff * (size + error_);
  }

  Eigen::Vector3d point_;
  double error_;
  Eigen::Vector3d direction_;
};

}  // namespace spherule::internal
