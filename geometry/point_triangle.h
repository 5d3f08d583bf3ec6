// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The distance between a point and a triangle.

#include "base/rounding.h"

#include <Eigen/Core>

#include <algorithm>

namespace spherule {

// Proved bounds on the distance between a point and a triangle, and a point of the triangle
// (rounded) that is as near as was found.
struct TriangleDistance {
  double lower = 0.0;
  double upper = 0.0;
  Eigen::Vector3d closest = Eigen::Vector3d::Zero();
};

// Distance between `p` and the triangle a, b, c, which may be degenerate. The closest point is
// found as in Ericson, "Real-Time Collision Detection", 5.1.5, with the edges tried as well where
// rounding spoils it; the bounds hold whatever its quality.
//
// Error budget, with everything taken relative to p (the corners a - p, b - p, c - p have one
// rounding each) and R the largest of their norms. The found point is A + v (B - A) + w (C - A)
// with v, w >= 0 and v + w <= 1 up to 4 u: corners 1 u R, differences 2 u R, products 2 u R, two
// sums 3 u R each, excess weight 8 u R, together 19 u R. So it lies within 32 u R of the triangle,
// which bounds the distance from above. From below: for the direction q from p to the found point,
// every corner V has V.q >= m, and so has the triangle; m / |q| bounds the distance from below.
// Each dot product errs by at most 3 u R |q|, the corners add 1 u R |q|, norm and quotient 5 u
// relative (at most 5 u R): 16 u R covers it. How close the two bounds are depends on how exact the
// direction is: an error e of the found point turns it by e / d at distance d, which costs R e / d
// from below. With e = 32 u R that is most at d = sqrt(32 u) R, 6e-8 R; nearer, d itself is less.
TriangleDistance point_triangle_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                         const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace spherule
