// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/rounding.h"
#include "collide/solids/solid_fields.h"
#include "geometry/triangles.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>

namespace spherule::internal {

// Triangles against a solid, in the solid's frame: does any point come within `reach`?
//
// A triangle is apart if a plane keeps its corners, and so all of it, off the solid: that of the
// nearest point of the solid to its middle, or (the distance being no steeper than 1) if its middle
// is farther away than the farthest corner is from there. Else it is halved across its longest
// edge. Against a flat face the first plane decides; along a curved surface a part of length s is
// decided where the gap is more than about s^2 over the radius.
//
// Rounding. Let T bound the norms of all corners and the solid's reach together. Corners are given
// with an error of `error`; each halving computes a corner with u T more, and there are kMostHalved
// at most. Planes and distances err by 12 u |q| 2 T and 8 u 2 T (solid_fields.h), products and the
// difference from the middle by less than 8 u T. kPad u T = 96 u T is more than all but the
// halving.
template <class Field>
class TriangleField {
 public:
  TriangleField(const Field& field, double reach, double error)
      : field_(field), reach_(reach), error_(error) {}

  // Never false if a point of the exact triangle comes within the reach. True where that could not
  // be proved otherwise with kMostParts parts.
  bool comes_near(const Triangle& triangle) const {
    const double size =
        std::max({triangle[0].norm(), triangle[1].norm(), triangle[2].norm()}) + field_.reach();
    const double limit =
        reach_ * (1.0 + 8.0 * kUnitRoundoff) + error_ + (kPad + kMostHalved) * kUnitRoundoff * size;
    std::array<Part, kMostHalved + 1> waiting;
    std::size_t top = 0;
    waiting[top++] = {triangle, 0};
    for (int parts = 0; top > 0; ++parts) {
      const Part part = waiting[--top];
      const Eigen::Vector3d middle = (part.corners[0] + part.corners[1] + part.corners[2]) / 3.0;
      const double distance = field_.signed_distance(middle);
      if (distance <= reach_ || parts == kMostParts || part.depth == kMostHalved) return true;
      if (is_apart(part.corners, middle, distance, limit)) continue;
      const auto halves = halved(part.corners);
      waiting[top++] = {halves[0], part.depth + 1};
      waiting[top++] = {halves[1], part.depth + 1};
    }
    return false;
  }

 private:
  static constexpr int kMostHalved = 60;
  static constexpr int kMostParts = 2000;
  static constexpr double kPad = 96.0;

  struct Part {
    Triangle corners;
    int depth;
  };

  bool is_apart(const Triangle& t, const Eigen::Vector3d& middle, double distance,
                double limit) const {
    double farthest = 0.0;
    for (const Eigen::Vector3d& corner : t) farthest = std::max(farthest, (corner - middle).norm());
    if (distance - farthest > limit) return true;
    const Eigen::Vector3d q = field_.outward(middle);
    const double support = field_.support(q);
    const double least = std::min({q.dot(t[0]), q.dot(t[1]), q.dot(t[2])});
    return least - support > q.norm() * limit;
  }

  static std::array<Triangle, 2> halved(const Triangle& t) {
    std::size_t from = 0;
    double longest = -1.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = (t[(k + 1) % 3] - t[k]).squaredNorm();
      if (length <= longest) continue;
      longest = length;
      from = k;
    }
    const Eigen::Vector3d& a = t[from];
    const Eigen::Vector3d& b = t[(from + 1) % 3];
    const Eigen::Vector3d& c = t[(from + 2) % 3];
    const Eigen::Vector3d middle = 0.5 * a + 0.5 * b;
    return {Triangle{a, middle, c}, Triangle{middle, b, c}};
  }

  const Field& field_;
  const double reach_;
  const double error_;
};

}  // namespace spherule::internal
