// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>

namespace spherule::internal {

// Whether one of seven axes proves that the distance from `p` to a triangle, which may be
// degenerate, is above `reach` - 8 u S: across its plane, from p to the nearest point of the line
// of each edge, and from p to each corner (the nearest point of a triangle lies in one of these
// directions). S bounds |p| + |V| for every corner V, and reach <= S.
//
// True only if the distance is above that. Proof: for any axis n, the computed n.(V - p) errs by u
// |n| S for the difference and 3 u |n| S for the product; the comparison of the squares by 4 u of
// both sides, which are below S: less than 8 u S.
//
// True whenever the exact distance d is above reach + 2^-23 S and at least 2^-22 S, the height of
// the triangle on its longest edge L is at least 2^-24 L and L^2 at least 2^-200. Proof: let x be
// the nearest point as seen from p, |x| = d, and n the computed axis of its feature, scaled so that
// |n - x| = e is least. Every corner has V.x >= d^2, so n.V >= d^2 - e R, where R <= S is the
// farthest corner's distance, and |n| <= d + e. So n is found to separate if
//     d^2 - e R - 8 u S (d + e) > (d + e) reach,   for which   e < 2^-25 d  is enough,
// as 2^-23 S d > e (R + d) + ... is then left.
//   corner: e <= u R.
//   edge: the edge's direction errs by u, the share of it that leads to the foot by 5 u R / |edge|
//     for the product and 7 u for the quotient, in lengths below 2 R: e < 30 u R.
//     Both are below 2^-48 S < 2^-25 d.
//   plane: the normal, from two edges of at most L, errs by less than 8 u L^2 and is at least 2^-24
//     L^2 long: e < 2^-26 d.
// Axes whose squares might underflow are not queried: with L as it is they are none of these.
bool are_apart(const Eigen::Vector3d& p, const std::array<Eigen::Vector3d, 3>& triangle,
               double reach);

}  // namespace spherule::internal
