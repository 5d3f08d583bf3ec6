// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mesh_distance.h"

#include "base/rounding.h"
#include "geometry/median_split.h"
#include "geometry/point_triangle.h"
#include "geometry/triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector3d;

constexpr std::int32_t kLeafSize = 4;

// At least the square, and by more than a box's squared distance errs by; never 0.
double squared_up(double x) {
  return x * x * kRelativeUp + 0x1p-1060;
}

// Square of the distance from a point to a box: each difference and square rounded once, two sums,
// so a relative error below 6 u.
double squared_distance(const Vector3d& low, const Vector3d& high, const Vector3d& p) {
  const Vector3d d = (low - p).cwiseMax(p - high).cwiseMax(0.0);
  return d.squaredNorm();
}

// The same of two boxes, a row each.
template <class Corners>
Eigen::Array2d squared_distances(const Corners& low, const Corners& high, const Vector3d& p) {
  Eigen::Array2d sum = Eigen::Array2d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Array2d d =
        (low.col(axis) - p[axis]).max(p[axis] - high.col(axis)).max(Eigen::Array2d::Zero());
    sum += d * d;
  }
  return sum;
}

}  // namespace

MeshDistance::MeshDistance(const TriangleMesh& mesh) {
  corners_.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = corners_of(mesh, mesh.triangles[i]);
    corners_.push_back({a, b, c, static_cast<std::int32_t>(i)});
    box_.extend(a).extend(b).extend(c);
  }
  nodes_.reserve(corners_.size() / kLeafSize);
  root_ = build(0, static_cast<std::int32_t>(corners_.size())).first;
}

std::pair<std::int32_t, Eigen::AlignedBox3d> MeshDistance::build(std::int32_t begin,
                                                                 std::int32_t end) {
  const auto part = std::span(corners_).subspan(static_cast<std::size_t>(begin),
                                                static_cast<std::size_t>(end - begin));
  if (end - begin <= kLeafSize) {
    Eigen::AlignedBox3d box;
    for (const Corners& t : part) box.extend(t.a).extend(t.b).extend(t.c);
    leaves_.push_back({begin, end});
    return {~static_cast<std::int32_t>(leaves_.size() - 1), box};
  }
  Eigen::AlignedBox3d centroids;
  for (const Corners& t : part) centroids.extend(Vector3d(t.a + t.b + t.c));
  const Eigen::Index axis = internal::longest_axis(centroids);
  const std::int32_t middle =
      begin + static_cast<std::int32_t>(internal::split_at_median(part, [axis](const Corners& t) {
        return std::pair(t.a[axis] + t.b[axis] + t.c[axis], t.triangle);
      }));
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  const auto left = build(begin, middle);
  const auto right = build(middle, end);
  Node& node = nodes_[self];
  node.children = {left.first, right.first};
  node.low << left.second.min().transpose(), right.second.min().transpose();
  node.high << left.second.max().transpose(), right.second.max().transpose();
  return {static_cast<std::int32_t>(self), left.second.merged(right.second)};
}

SurfaceDistance MeshDistance::operator()(const Vector3d& point, double limit,
                                         std::size_t most_leaves) const {
  SurfaceDistance best;
  best.lower = limit;
  double reach = limit;                      // nearest upper bound so far
  double reach_squared = squared_up(reach);  // boxes beyond it are no nearer
  const auto is_beyond = [&](double squared) { return squared * kRelativeDown >= reach_squared; };
  std::array<std::pair<double, std::int32_t>, kStackSize> waiting;
  std::size_t size = 0;
  for (std::int32_t child = root_;;) {
    if (child < 0) {
      if (most_leaves-- == 0) {
        best.lower = 0.0;
        return best;
      }
      const Leaf& leaf = leaves_[static_cast<std::size_t>(~child)];
      for (auto i = leaf.begin; i < leaf.end; ++i) {
        const Corners& t = corners_[static_cast<std::size_t>(i)];
        const Vector3d low = t.a.cwiseMin(t.b).cwiseMin(t.c);
        const Vector3d high = t.a.cwiseMax(t.b).cwiseMax(t.c);
        if (is_beyond(squared_distance(low, high, point))) continue;
        const TriangleDistance d = point_triangle_distance(point, t.a, t.b, t.c);
        best.lower = std::min(best.lower, d.lower);
        if (d.upper < reach) {
          reach = d.upper;
          reach_squared = squared_up(reach);
          best.upper = d.upper;
          best.closest = d.closest;
          best.triangle = t.triangle;
        }
      }
    } else {
      const Node& node = nodes_[static_cast<std::size_t>(child)];
      const Eigen::Array2d squared = squared_distances(node.low, node.high, point);
      std::pair near(squared[0], node.children[0]);
      std::pair far(squared[1], node.children[1]);
      if (far.first < near.first) std::swap(near, far);
      if (!is_beyond(near.first)) {
        if (!is_beyond(far.first)) waiting[size++] = far;
        child = near.second;
        continue;
      }
    }
    while (size > 0 && is_beyond(waiting[size - 1].first)) --size;
    if (size == 0) return best;
    child = waiting[--size].second;
  }
}

// Where the ray is between the planes of the box: each quotient errs by 2 u of itself, and so do
// the least and the greatest of them.
bool MeshDistance::may_intersect(const Eigen::Array3d& low_corner,
                                 const Eigen::Array3d& high_corner, const Vector3d& point,
                                 const Vector3d& direction) {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = (low_corner[axis] - point[axis]) / direction[axis];
    const double high = (high_corner[axis] - point[axis]) / direction[axis];
    enter = std::max(enter, std::min(low, high));
    leave = std::min(leave, std::max(low, high));
  }
  constexpr double kSlack = 8.0 * kUnitRoundoff;
  return leave >= 0.0 && enter - kSlack * std::abs(enter) <= leave + kSlack * leave;
}

double MeshDistance::winding_number(const Vector3d& point) const {
  double angle = 0.0;
  for (const Corners& t : corners_) {
    angle += internal::solid_angle(t.a - point, t.b - point, t.c - point);
  }
  return angle / (4.0 * std::numbers::pi);
}

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
