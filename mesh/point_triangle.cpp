// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/point_triangle.h"

#include <cmath>

namespace spherule {
namespace {

using Eigen::Vector3d;

// The point of the segment nearest to the origin.
Vector3d nearest_on_segment(const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double length_squared = ab.squaredNorm();
  if (!(length_squared > 0.0)) return a;
  const double t = std::clamp(-a.dot(ab) / length_squared, 0.0, 1.0);
  return a + t * ab;
}

// The point of the triangle nearest to the origin, by the Voronoi regions of its features; not
// finite where the triangle is degenerate.
Vector3d nearest_on_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a;
  const Vector3d ac = c - a;
  const double d1 = -ab.dot(a);
  const double d2 = -ac.dot(a);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const double d3 = -ab.dot(b);
  const double d4 = -ac.dot(b);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + (d1 / (d1 - d3)) * ab;
  const double d5 = -ab.dot(c);
  const double d6 = -ac.dot(c);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return b + t * (c - b);
  }
  const double scale = 1.0 / (va + vb + vc);
  const double v = vb * scale;
  const double w = vc * scale;
  if (!(v >= 0.0 && w >= 0.0 && v + w <= 1.0)) return Vector3d::Constant(std::nan(""));
  return a + v * ab + w * ac;
}

// Along q, whose norm is given.
double lower_bound(const Vector3d& q, double norm, const Vector3d& a, const Vector3d& b,
                   const Vector3d& c, double reach) {
  if (!(norm > 1e-140)) return 0.0;
  const double m = std::min({q.dot(a), q.dot(b), q.dot(c)});
  return std::max(0.0, m / norm - 16.0 * kUnitRoundoff * reach - kUnderflow);
}

}  // namespace

TriangleDistance point_triangle_distance(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                                         const Vector3d& c) {
  const Vector3d ra = a - p;
  const Vector3d rb = b - p;
  const Vector3d rc = c - p;
  const double reach =
      std::sqrt(std::max({ra.squaredNorm(), rb.squaredNorm(), rc.squaredNorm()})) * kRelativeUp;
  Vector3d q = nearest_on_triangle(ra, rb, rc);
  double norm = q.norm();
  double lower = std::isfinite(norm) ? lower_bound(q, norm, ra, rb, rc, reach) : 0.0;
  // A needle's Voronoi regions are lost in rounding; its edges are not.
  if (!(norm - lower <= 1e-10 * reach)) {
    for (const Vector3d& candidate :
         {nearest_on_segment(ra, rb), nearest_on_segment(rb, rc), nearest_on_segment(rc, ra)}) {
      if (!q.allFinite() || candidate.squaredNorm() < q.squaredNorm()) q = candidate;
    }
    norm = q.norm();
    lower = std::max(lower, lower_bound(q, norm, ra, rb, rc, reach));
  }
  return {lower, norm_upper(q) + 32.0 * kUnitRoundoff * reach, p + q};
}

}  // namespace spherule
