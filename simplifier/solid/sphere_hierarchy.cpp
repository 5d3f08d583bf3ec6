// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/solid/sphere_hierarchy.h"

#include "spheretree/median_split.h"
#include "spheretree/rounding.h"

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
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::int32_t kLeafSize = 8;
// Halved at every level, so at most 32 deep; one waiting sibling a level.
constexpr std::size_t kStackSize = 40;

// Frames are right-angled and of length 1 up to 16 u, and shrunk by more, so that no vector is
// shorter than its part in a frame.
constexpr double kShrink = 1.0 - 64.0 * kUnitRoundoff;

// How long what is left of a unit vector without its part along another must be to be taken for a
// direction: its rounding errors, then at most 4000 u, are taken out by doing it again.
constexpr double kAcross = 1e-3;

// The direction of `v`, or if it has none that can be relied on, of `other`.
Vector3d direction_of(const Vector3d& v, const Vector3d& other) {
  const double norm = v.norm();
  return norm > 1e-100 && norm < 1e100 ? Vector3d(v / norm) : other;
}

Vector3d any_across(const Vector3d& normal) {
  int least = 0;
  normal.cwiseAbs().minCoeff(&least);
  return normal.cross(Vector3d::Unit(least)).normalized();
}

// Length of `d` without its part along the axis.
double distance_across(const Vector3d& d, const Vector3d& axis) {
  return (d - axis.dot(d) * axis).norm();
}

// Least gap to spheres with radii up to max_radius whose centres are at least `ahead` plus their
// radius away in one direction and `squared_aside`, squared, in others: it shrinks with the radius.
// `ahead` plus each radius must be positive.
double gap_to(double ahead, double squared_aside, double max_radius) {
  const double a = ahead + max_radius;
  return std::sqrt(a * a + squared_aside) - max_radius;
}

}  // namespace

SphereHierarchy::SphereHierarchy(std::span<const Sphere> spheres) : SphereHierarchy(spheres, {}) {}

SphereHierarchy::SphereHierarchy(std::span<const Sphere> spheres,
                                 std::span<const Vector3d> contacts) {
  spheres_.reserve(spheres.size());
  for (const Sphere& s : spheres) {
    spheres_.push_back({s, static_cast<std::int32_t>(spheres_.size())});
    magnitude_ = std::max(magnitude_, s.center.norm());
  }
  std::vector<Touch> touches;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    touches.push_back({contacts[i], (spheres[i].center - contacts[i]).stableNormalized()});
  }
  nodes_.reserve(spheres_.size() / 2 + 1);
  if (spheres_.empty()) return;
  nodes_.push_back({.end = static_cast<std::int32_t>(spheres_.size())});
  build(0, touches);
}

// Halved where the spheres differ most: in the point where a sphere of the least radius would have
// its centre if it touched there, so that spheres go together that touch alike, however large; or,
// where contacts are not known, in centre and radius.
void SphereHierarchy::build(std::size_t self, const std::vector<Touch>& touches) {
  Node& node = nodes_[self];
  const auto [begin, end] = std::pair(node.begin, node.end);
  node.free = -kInfinity;
  node.min_radius = kInfinity;
  for (const Entry& e : spheres_of(node)) {
    node.min_radius = std::min(node.min_radius, e.sphere.radius);
    node.max_radius = std::max(node.max_radius, e.sphere.radius);
  }
  if (touches.empty()) {
    fit_box(node, regressed_normal(node), Vector3d::Zero());
  } else {
    fit_cylinder(node, touches);
  }
  if (end - begin <= kLeafSize) return;
  const auto key = [&](const Entry& e) -> Eigen::Vector4d {
    const Vector3d& c = e.sphere.center;
    if (touches.empty()) return {c.x(), c.y(), c.z(), e.sphere.radius};
    const Touch& touch = touches[static_cast<std::size_t>(e.index)];
    const Vector3d alike = touch.contact + nodes_[0].min_radius * touch.normal;
    return {alike.x(), alike.y(), alike.z(), 0.0};
  };
  Eigen::Array4d mean = Eigen::Array4d::Zero();
  Eigen::Array4d spread = Eigen::Array4d::Zero();
  for (const Entry& e : spheres_of(node)) mean += key(e).array();
  mean /= static_cast<double>(end - begin);
  for (const Entry& e : spheres_of(node)) spread += (key(e).array() - mean).square();
  Eigen::Index widest = 0;
  spread.maxCoeff(&widest);
  const auto part = std::span(spheres_).subspan(static_cast<std::size_t>(begin),
                                                static_cast<std::size_t>(end - begin));
  const std::int32_t middle =
      begin + static_cast<std::int32_t>(split_at_median(
                  part, [&](const Entry& e) { return std::pair(key(e)[widest], e.index); }));
  const std::size_t children = nodes_.size();
  node.children = static_cast<std::int32_t>(children);
  nodes_.push_back({.begin = begin, .end = middle});
  nodes_.push_back({.begin = middle, .end = end});
  build(children, touches);
  build(children + 1, touches);
}

std::span<const SphereHierarchy::Entry> SphereHierarchy::spheres_of(const Node& node) const {
  return std::span(spheres_).subspan(static_cast<std::size_t>(node.begin),
                                     static_cast<std::size_t>(node.end - node.begin));
}

// Spheres that touch a flat wall have radii that are an affine function of their centres, with the
// wall's normal for a gradient.
Vector3d SphereHierarchy::regressed_normal(const Node& node) const {
  const std::span<const Entry> spheres = spheres_of(node);
  Vector3d mean = Vector3d::Zero();
  double mean_radius = 0.0;
  for (const Entry& e : spheres) {
    mean += e.sphere.center;
    mean_radius += e.sphere.radius;
  }
  mean /= static_cast<double>(spheres.size());
  mean_radius /= static_cast<double>(spheres.size());
  Matrix3d covariance = Matrix3d::Zero();
  Vector3d slope = Vector3d::Zero();
  for (const Entry& e : spheres) {
    const Vector3d d = e.sphere.center - mean;
    covariance += d * d.transpose();
    slope += d * (e.sphere.radius - mean_radius);
  }
  return covariance.inverse() * slope;
}

// The axis is the direction that the normals have least in common with, and the focus the point
// nearest to the lines along the normals through the contacts. Any others would give a true bound.
void SphereHierarchy::fit_cylinder(Node& node, const std::vector<Touch>& touches) const {
  const std::span<const Entry> spheres = spheres_of(node);
  Vector3d normal = Vector3d::Zero();
  Matrix3d common = Matrix3d::Zero();
  Matrix3d across = Matrix3d::Zero();
  Vector3d sum = Vector3d::Zero();
  for (const Entry& e : spheres) {
    const Touch& touch = touches[static_cast<std::size_t>(e.index)];
    const Matrix3d along = touch.normal * touch.normal.transpose();
    const Matrix3d rest = Matrix3d::Identity() - along;
    normal += touch.normal;
    common += along;
    across += rest;
    sum += rest * touch.contact;
  }
  constexpr double kLeastShare = 1e-3;  // keeps the inverse finite
  common += kLeastShare * static_cast<double>(spheres.size()) * Matrix3d::Identity();
  const Matrix3d inverse = common.inverse();
  Vector3d axis(0.48, 0.6, 0.64);
  for (int i = 0; i < 6; ++i) axis = (inverse * axis).normalized();
  fit_box(node, normal, axis);
  node.focus = across.inverse() * sum;
  if (!node.focus.allFinite() || node.focus.norm() > magnitude_) return;
  node.free = kInfinity;
  for (const Entry& e : spheres) {
    const double distance = distance_across(e.sphere.center - node.focus, node.axis);
    node.free = std::min(node.free, distance - e.sphere.radius);
  }
  if (node.free <= 0.0) node.free = -kInfinity;
}

void SphereHierarchy::fit_box(Node& node, const Vector3d& normal, const Vector3d& axis) const {
  const Vector3d n = direction_of(normal, Vector3d::UnitX());
  const Vector3d across = axis - n.dot(axis) * n;
  const Vector3d a = across.norm() > kAcross ? across.normalized() : any_across(n);
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
  if (best >= enough || std::isinf(node.free)) return best;
  const double around = node.free - distance_across(point - node.focus, node.axis);
  if (around + node.min_radius > 0.0) {
    best = std::max(best, gap_to(around, along * along, node.max_radius));
  }
  return best;
}

// Values are compared as computed and the rounding is charged at the end. For a sphere at distance
// d with radius R the computed v = d - R errs by at most 3.5 u d + u |v|, and the test d^2 < (v +
// R)^2 that saves the root by 5 u (v + R); with d = v + R both are below 8 u (|v| + R). As v - 8 u
// |v| grows with v, a sphere that compared less favourably is exactly at least v - 8 u (|v| + R_max
// + |c|_max + |p|) for the v that is returned. The bounds of nodes take some 60 operations on
// vectors no longer than |p| + 2 |c|_max + R_max (|focus| <= |c|_max), none of which magnifies an
// error, and the frame is shrunk by 64 u: 256 u of that length is charged to each.
NearestSphere SphereHierarchy::nearest(const Vector3d& point, double limit,
                                       double tolerance) const {
  NearestSphere best{limit, limit, -1};
  if (nodes_.empty()) return best;
  double nearest = limit;
  const double length = point.norm() + magnitude_ + nodes_[0].max_radius;
  const double node_slack = 512.0 * kUnitRoundoff * length + kUnderflow;
  struct Waiting {
    double bound;
    std::int32_t index;
  };
  const auto waiting = [&](std::int32_t i) -> Waiting {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    return {bound(node, point, nearest - tolerance + node_slack) - node_slack, i};
  };
  std::array<Waiting, kStackSize> stack;
  std::size_t size = 0;
  stack[size++] = waiting(0);
  while (size > 0) {
    const Waiting top = stack[--size];
    if (top.bound >= nearest - tolerance) continue;
    const Node& node = nodes_[static_cast<std::size_t>(top.index)];
    if (node.children < 0) {
      for (auto i = node.begin; i < node.end; ++i) {
        const Entry& entry = spheres_[static_cast<std::size_t>(i)];
        const double squared = (point - entry.sphere.center).squaredNorm();
        const double reach = nearest + entry.sphere.radius;
        if (reach <= 0.0 || squared >= reach * reach) continue;
        nearest = std::min(nearest, std::sqrt(squared) - entry.sphere.radius);
        best.index = entry.index;
      }
      continue;
    }
    Waiting near = waiting(node.children);
    Waiting far = waiting(node.children + 1);
    if (far.bound < near.bound) std::swap(near, far);
    if (far.bound < nearest - tolerance) stack[size++] = far;
    if (near.bound < nearest - tolerance) stack[size++] = near;
  }
  if (std::isinf(nearest)) return best;
  const double slack = 8.0 * kUnitRoundoff * (std::abs(nearest) + length) + kUnderflow;
  best.lower = sub_down(sub_down(nearest, tolerance), slack);
  best.upper = best.index < 0 ? limit : add_up(nearest, slack);
  return best;
}

}  // namespace spherule::internal
