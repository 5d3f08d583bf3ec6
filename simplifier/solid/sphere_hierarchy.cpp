// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/solid/sphere_hierarchy.h"

#include "base/rounding.h"
#include "base/threads.h"
#include "geometry/median_split.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kLeafSize = 8;
constexpr std::size_t kLeastShared = 4096;  // the halves of fewer spheres are built in turn
// Halved at every level, so at most 32 deep; one waiting sibling a level.
constexpr std::size_t kStackSize = 40;
constexpr double kNodeSlack = 512.0 * kUnitRoundoff;  // see search()

// Frames are right-angled and of length 1 up to 16 u, and shrunk by more, so that no vector is
// shorter than its part in a frame.
constexpr double kShrink = 1.0 - 64.0 * kUnitRoundoff;

// The direction of `v`, or if it has none that can be relied on, of `other`.
Vector3d direction_of(const Vector3d& v, const Vector3d& other) {
  const double norm = v.norm();
  return norm > kLeastNorm && norm < 1e100 ? Vector3d(v / norm) : other;
}

Vector3d any_across(const Vector3d& normal) {
  int least = 0;
  normal.cwiseAbs().minCoeff(&least);
  return normal.cross(Vector3d::Unit(least)).normalized();
}

// How many nodes that many spheres make, halved down to leaves.
std::size_t node_count(std::size_t spheres) {
  if (spheres <= kLeafSize) return 1;
  return 1 + node_count(spheres / 2) + node_count(spheres - spheres / 2);
}

Vector4d numbers_of(const Sphere& s) {
  return {s.center.x(), s.center.y(), s.center.z(), s.radius};
}

// Of spheres whose numbers have this scatter matrix. Those that touch a flat wall have radii that
// are an affine function of their centres, with the wall's normal for a gradient.
Vector3d regressed_normal(const Matrix4d& scatter) {
  const Matrix3d of_centers = scatter.topLeftCorner<3, 3>();
  return of_centers.inverse() * scatter.topRightCorner<3, 1>();
}

// Least gap to spheres with radii up to max_radius whose centres are at least `ahead` plus their
// radius away in one direction and `squared_aside`, squared, in others: it shrinks with the radius.
// `ahead` plus each radius must be positive.
double gap_to(double ahead, double squared_aside, double max_radius) {
  const double a = ahead + max_radius;
  return std::sqrt(a * a + squared_aside) - max_radius;
}

}  // namespace

SphereHierarchy::SphereHierarchy(std::span<const Sphere> spheres) {
  spheres_.reserve(spheres.size());
  for (const Sphere& s : spheres) {
    spheres_.push_back({s, static_cast<std::int32_t>(spheres_.size())});
    magnitude_ = std::max(magnitude_, s.center.norm());
  }
  if (spheres_.empty()) return;
  nodes_.resize(node_count(spheres_.size()));
  nodes_[0].end = static_cast<std::int32_t>(spheres_.size());
  build(0, 1);
}

// Halved where the spheres differ most, in centre or radius.
void SphereHierarchy::build(std::size_t self, std::size_t children) {
  Node& node = nodes_[self];
  const auto count = static_cast<std::size_t>(node.end - node.begin);
  const std::span<Entry> part =
      std::span(spheres_).subspan(static_cast<std::size_t>(node.begin), count);
  node.min_radius = kInfinity;
  Vector4d mean = Vector4d::Zero();
  for (const Entry& e : part) {
    node.min_radius = std::min(node.min_radius, e.sphere.radius);
    node.max_radius = std::max(node.max_radius, e.sphere.radius);
    mean += numbers_of(e.sphere);
  }
  mean /= static_cast<double>(count);
  Matrix4d scatter = Matrix4d::Zero();
  for (const Entry& e : part) {
    const Vector4d d = numbers_of(e.sphere) - mean;
    scatter += d * d.transpose();
  }
  fit_box(node, regressed_normal(scatter));
  if (count <= kLeafSize) return;
  Eigen::Index widest = 0;
  scatter.diagonal().maxCoeff(&widest);
  const std::size_t half = split_at_median(
      part, [&](const Entry& e) { return std::pair(numbers_of(e.sphere)[widest], e.index); });
  const std::int32_t middle = node.begin + static_cast<std::int32_t>(half);
  node.children = static_cast<std::int32_t>(children);
  nodes_[children].begin = node.begin;
  nodes_[children].end = nodes_[children + 1].begin = middle;
  nodes_[children + 1].end = node.end;
  // Below the children stand the nodes below the first, then those below the second.
  const std::array<std::size_t, 2> below = {children + 2, children + 1 + node_count(half)};
  const auto build_child = [&](std::size_t i) { build(children + i, below[i]); };
  if (count >= kLeastShared) {
    parallel_for(0, 2, build_child);
  } else {
    build_child(0);
    build_child(1);
  }
}

std::span<const SphereHierarchy::Entry> SphereHierarchy::spheres_of(const Node& node) const {
  return std::span(spheres_).subspan(static_cast<std::size_t>(node.begin),
                                     static_cast<std::size_t>(node.end - node.begin));
}

void SphereHierarchy::fit_box(Node& node, const Vector3d& normal) const {
  const Vector3d n = direction_of(normal, Vector3d::UnitX());
  const Vector3d a = any_across(n);
  node.normal = kShrink * n;
  node.axis = kShrink * (a - n.dot(a) * n).normalized();
  node.side = kShrink * n.cross(a).normalized();
  node.low = Vector3d::Constant(kInfinity);
  node.high = Vector3d::Constant(-kInfinity);
  node.offset = kInfinity;
  for (const Entry& e : spheres_of(node)) {
    const Vector3d& x = e.sphere.center;
    const Vector3d c(node.normal.dot(x), node.axis.dot(x), node.side.dot(x));
    node.low = node.low.cwiseMin(c);
    node.high = node.high.cwiseMax(c);
    node.offset = std::min(node.offset, c.x() - e.sphere.radius);
  }
}

// No sphere of the node has a smaller gap to the point, up to rounding. Bounds that reach `enough`
// are not improved.
double SphereHierarchy::bound(const Node& node, const Vector3d& point, double enough) const {
  const double along_normal = node.normal.dot(point);
  const double ahead = node.offset - along_normal;
  if (ahead >= enough) return ahead;
  const auto beyond = [](double x, double low, double high) {
    return std::max({low - x, x - high, 0.0});
  };
  const double above = beyond(along_normal, node.low.x(), node.high.x());
  const double along = beyond(node.axis.dot(point), node.low.y(), node.high.y());
  const double aside = beyond(node.side.dot(point), node.low.z(), node.high.z());
  const double squared_aside = along * along + aside * aside;
  double best = std::max(ahead, std::sqrt(above * above + squared_aside) - node.max_radius);
  if (best >= enough) return best;
  if (ahead + node.min_radius > 0.0) {
    best = std::max(best, gap_to(ahead, squared_aside, node.max_radius));
  }
  return best;
}

double SphereHierarchy::length_at(const Vector3d& point) const {
  return nodes_.empty() ? 0.0 : point.norm() + magnitude_ + nodes_[0].max_radius;
}

NearestSphere SphereHierarchy::nearest(const Vector3d& point, double limit,
                                       double tolerance) const {
  LeastGap least(limit);
  const double length = length_at(point);
  if (nodes_.empty()) return least.bounds(0.0, length);
  search(point, tolerance, least, [] { return false; });
  return least.bounds(tolerance, length);
}

bool SphereHierarchy::is_any_nearer(const Vector3d& point, double value) const {
  LeastGap least(value);
  if (!nodes_.empty()) search(point, 0.0, least, [&] { return least.index() >= 0; });
  return least.index() >= 0;
}

// Values are compared as LeastGap computes them, which err by at most 8 u L, L being length_at(p).
// The bounds of nodes take some 60 operations on vectors no longer than |p| + 2 |c|_max + R_max,
// none of which magnifies an error, and the frame is shrunk by 64 u: 256 u of that length, at most
// 2 L, are charged to each. So no sphere of a node that is passed over has a value as small as what
// the node's bound was compared with.
template <typename Done>
void SphereHierarchy::search(const Vector3d& point, double tolerance, LeastGap& least,
                             const Done& is_done) const {
  const double node_slack = kNodeSlack * length_at(point) + kUnderflow;
  struct Waiting {
    double bound;
    std::int32_t index;
  };
  const auto waiting = [&](std::int32_t i) -> Waiting {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    return {bound(node, point, least.value() - tolerance + node_slack) - node_slack, i};
  };
  std::array<Waiting, kStackSize> stack;
  std::size_t size = 0;
  stack[size++] = waiting(0);
  while (size > 0) {
    const Waiting top = stack[--size];
    if (top.bound >= least.value() - tolerance) continue;
    const Node& node = nodes_[static_cast<std::size_t>(top.index)];
    if (node.children < 0) {
      for (const Entry& entry : spheres_of(node)) least.examine(point, entry.sphere, entry.index);
      if (is_done()) return;
      continue;
    }
    Waiting near = waiting(node.children);
    Waiting far = waiting(node.children + 1);
    if (far.bound < near.bound) std::swap(near, far);
    if (far.bound < least.value() - tolerance) stack[size++] = far;
    if (near.bound < least.value() - tolerance) stack[size++] = near;
  }
}

// Let w be a unit vector with components w_n, w_a, w_s >= 0 in the frame of the node. For all x a
// sphere of centre c and radius r has |c - x| >= w_n (ahead(x) + r) + w_a excess_a(x) + w_s
// excess_s(x), where `ahead` is affine, and an excess over the box at least the affine function
// that it is about the centre of the cell. Less r, this falls as r grows, as w_n <= 1: the largest
// radius gives a bound for all. Where ahead + the largest radius is not positive at the centre of
// the cell, the excess along the normal stands in place of ahead + r. Of all w, the best at that
// centre.
bool SphereHierarchy::is_above(const Node& node, const BoxCell& cell, double value,
                               const Vector3d& slope) const {
  struct Excess {
    double value;
    Vector3d slope;
  };
  const auto excess = [&](const Vector3d& way, double low, double high) -> Excess {
    const double at = way.dot(cell.center);
    if (at < low) return {low - at, -way};
    if (at > high) return {at - high, way};
    return {0.0, Vector3d::Zero()};
  };
  const double ahead = node.offset - node.normal.dot(cell.center);
  const bool by_plane = ahead + node.max_radius > 0.0;
  const Excess along = excess(node.axis, node.low.y(), node.high.y());
  const Excess aside = excess(node.side, node.low.z(), node.high.z());
  const Excess first = by_plane ? Excess{ahead + node.max_radius, -node.normal}
                                : excess(node.normal, node.low.x(), node.high.x());
  const double norm = Vector3d(first.value, along.value, aside.value).norm();
  if (norm <= kLeastNorm) return false;
  const Vector3d rise =
      (first.value * first.slope + along.value * along.slope + aside.value * aside.slope) / norm;
  return norm - node.max_radius - (rise - slope).cwiseAbs().dot(cell.half) > value;
}

// As in search(), twice: once for the bound, at c and where it is carried to in the cell, and once
// for the values that are computed there. L is no less than length_at() anywhere in the cell.
void SphereHierarchy::for_each_below(const BoxCell& cell, double value, const Vector3d& slope,
                                     const std::function<bool(std::int32_t)>& visit) const {
  if (nodes_.empty()) return;
  const double length = length_at(cell.center) + cell.reach();
  const double enough = value + 2.0 * (kNodeSlack * length + kUnderflow);
  std::array<std::int32_t, kStackSize> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[static_cast<std::size_t>(stack[--size])];
    if (is_above(node, cell, enough, slope)) continue;
    if (node.children >= 0) {
      stack[size++] = node.children + 1;
      stack[size++] = node.children;
      continue;
    }
    for (const Entry& entry : spheres_of(node)) {
      if (!visit(entry.index)) return;
    }
  }
}

}  // namespace spherule::internal
