// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/ball_hierarchy.h"

#include "spheretree/rounding.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr std::int32_t kLeafSize = 8;
// Halved at every level, so at most 32 deep; one waiting sibling a level.
constexpr std::size_t kStackSize = 40;

}  // namespace

BallHierarchy::BallHierarchy(std::span<const Sphere> balls) {
  balls_.reserve(balls.size());
  for (const Sphere& s : balls) {
    balls_.push_back({s, static_cast<std::int32_t>(balls_.size())});
    magnitude_ = std::max(magnitude_, s.center.norm());
  }
  nodes_.reserve(balls_.size() / 2 + 1);
  if (!balls_.empty()) build(0, static_cast<std::int32_t>(balls_.size()));
}

void BallHierarchy::build(std::int32_t begin, std::int32_t end) {
  Eigen::AlignedBox3d centers;
  double least = std::numeric_limits<double>::infinity();
  double greatest = 0.0;
  for (auto i = begin; i < end; ++i) {
    const Sphere& s = balls_[static_cast<std::size_t>(i)].ball;
    centers.extend(s.center);
    least = std::min(least, s.radius);
    greatest = std::max(greatest, s.radius);
  }
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  nodes_[self].low = centers.min();
  nodes_[self].high = centers.max();
  nodes_[self].max_radius = greatest;
  nodes_[self].begin = begin;
  nodes_[self].end = end;
  fit_half_space(nodes_[self]);
  if (end - begin <= kLeafSize) return;
  int axis = 0;
  const bool by_radius = greatest - least > centers.sizes().maxCoeff(&axis);
  const auto key = [=](const Entry& e) { return by_radius ? e.ball.radius : e.ball.center[axis]; };
  const std::int32_t middle = begin + (end - begin) / 2;
  std::nth_element(balls_.begin() + begin, balls_.begin() + middle, balls_.begin() + end,
                   [key](const Entry& a, const Entry& b) {
                     return key(a) < key(b) || (key(a) == key(b) && a.index < b.index);
                   });
  build(begin, middle);
  nodes_[self].right = static_cast<std::int32_t>(nodes_.size());
  build(middle, end);
}

void BallHierarchy::fit_half_space(Node& node) const {
  const auto balls = std::span(balls_).subspan(static_cast<std::size_t>(node.begin),
                                               static_cast<std::size_t>(node.end - node.begin));
  Vector3d mean = Vector3d::Zero();
  double mean_radius = 0.0;
  for (const Entry& e : balls) {
    mean += e.ball.center;
    mean_radius += e.ball.radius;
  }
  mean /= static_cast<double>(balls.size());
  mean_radius /= static_cast<double>(balls.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Vector3d slope = Vector3d::Zero();
  for (const Entry& e : balls) {
    const Vector3d d = e.ball.center - mean;
    covariance += d * d.transpose();
    slope += d * (e.ball.radius - mean_radius);
  }
  const Vector3d normal = covariance.inverse() * slope;
  const double norm = normal.norm();
  // Without a usable direction the half-space is all of space.
  const bool usable = std::isfinite(norm) && norm > 0.0;
  node.normal = usable ? Vector3d(normal / (norm * kRelativeUp)) : Vector3d::Zero();
  node.offset = std::numeric_limits<double>::infinity();
  for (const Entry& e : balls) {
    node.offset = std::min(node.offset, node.normal.dot(e.ball.center) - e.ball.radius);
  }
}

// Values are compared as computed and the rounding is charged once, at the end. For a ball at
// distance d with radius R the computed v = d - R errs by at most 3.5 u d + u |v|, and the test d^2
// < (v + R)^2 that saves the root by 5 u (v + R); with d = v + R both are below 8 u (|v| + R). A
// node's bound (box distance less largest radius) errs by no more, with the largest radius of all
// in the place of R; a half-space's (offset less normal.p, |normal| <= 1) errs by at most 8 u (|c|
// + |p|) + 2 u R. As v - 8 u |v| grows with v, whatever was skipped or compared less favourably is
// exactly at least v - 8 u (|v| + R_max + |c|_max + |p|) for the v that is returned, less the
// tolerance.
NearestBall BallHierarchy::nearest(const Vector3d& point, double limit, double tolerance) const {
  NearestBall best{limit, limit, -1};
  if (nodes_.empty()) return best;
  double nearest = limit;
  struct Waiting {
    double bound;
    std::int32_t index;
  };
  // Infinite if the half-space alone rules the node out.
  const auto bound = [&](std::int32_t i) -> Waiting {
    const Node& n = nodes_[static_cast<std::size_t>(i)];
    const double half_space = n.offset - n.normal.dot(point);
    if (half_space >= nearest - tolerance) return {std::numeric_limits<double>::infinity(), i};
    const Vector3d d = (n.low - point).cwiseMax(point - n.high).cwiseMax(0.0);
    return {std::max(d.norm() - n.max_radius, half_space), i};
  };
  std::array<Waiting, kStackSize> stack;
  std::size_t size = 0;
  stack[size++] = bound(0);
  while (size > 0) {
    const Waiting top = stack[--size];
    if (top.bound >= nearest - tolerance) continue;
    const Node& node = nodes_[static_cast<std::size_t>(top.index)];
    if (node.right < 0) {
      for (auto i = node.begin; i < node.end; ++i) {
        const Entry& entry = balls_[static_cast<std::size_t>(i)];
        const double squared = (point - entry.ball.center).squaredNorm();
        const double reach = nearest + entry.ball.radius;
        if (reach <= 0.0 || squared >= reach * reach) continue;
        nearest = std::min(nearest, std::sqrt(squared) - entry.ball.radius);
        best.index = entry.index;
      }
      continue;
    }
    Waiting near = bound(top.index + 1);
    Waiting far = bound(node.right);
    if (far.bound < near.bound) std::swap(near, far);
    if (far.bound < nearest - tolerance) stack[size++] = far;
    if (near.bound < nearest - tolerance) stack[size++] = near;
  }
  if (std::isinf(nearest)) return best;
  const double slack =
      8.0 * kUnitRoundoff * (std::abs(nearest) + nodes_[0].max_radius + magnitude_ + point.norm()) +
      kUnderflow;
  best.lower = sub_down(sub_down(nearest, tolerance), slack);
  best.upper = best.index < 0 ? limit : add_up(nearest, slack);
  return best;
}

}  // namespace spherule::internal
