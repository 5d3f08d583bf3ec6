// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/exact/trees.h"

#include "tests/support/exact/spheres.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <deque>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

Sphere sphere_of(const SphereTreeData& data, std::size_t node) {
  return {{data.x.at(node), data.y.at(node), data.z.at(node)}, data.radius.at(node)};
}

bool usable(const Sphere& s) {
  for (const double value : {s.center.x(), s.center.y(), s.center.z(), s.radius}) {
    if (!std::isfinite(value) || std::abs(value) > 1e15) return false;
  }
  return s.radius >= 0.0;
}

bool identical(const Sphere& a, const Sphere& b) {
  return std::memcmp(a.center.data(), b.center.data(), 3 * sizeof(double)) == 0 &&
         std::memcmp(&a.radius, &b.radius, sizeof(double)) == 0;
}

using Wide = long double;
using WideVector = Eigen::Matrix<Wide, 3, 1>;

// A sphere that (nearly) touches the candidate from inside.
struct Contact {
  WideVector direction;  // from the sphere's centre to the candidate's
  Wide reach;            // |c - c_i| + r_i
};

struct HullPoint {
  WideVector point = WideVector::Zero();
  std::vector<std::size_t> support;  // indices of contacts
  std::vector<Wide> weights;
};

// The point of least norm in the affine hull of the chosen directions; empty support if degenerate
// or outside the convex hull.
HullPoint least_norm_in_affine_hull(const std::vector<Contact>& contacts,
                                    const std::vector<std::size_t>& chosen) {
  const auto n = static_cast<Eigen::Index>(chosen.size());
  Eigen::Matrix<Wide, Eigen::Dynamic, Eigen::Dynamic> system(n + 1, n + 1);
  system.setZero();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      system(i, j) = contacts[chosen[static_cast<std::size_t>(i)]].direction.dot(
          contacts[chosen[static_cast<std::size_t>(j)]].direction);
    }
    system(i, n) = system(n, i) = 1.0L;
  }
  Eigen::Matrix<Wide, Eigen::Dynamic, 1> right(n + 1);
  right.setZero();
  right(n) = 1.0L;
  const auto solver = system.fullPivLu();
  HullPoint result;
  if (!solver.isInvertible()) return result;
  const Eigen::Matrix<Wide, Eigen::Dynamic, 1> weights = solver.solve(right);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!(weights(i) >= 0.0L)) return {};
    const std::size_t contact = chosen[static_cast<std::size_t>(i)];
    result.point += weights(i) * contacts[contact].direction;
    result.support.push_back(contact);
    result.weights.push_back(weights(i));
  }
  return result;
}

// Least norm over the convex hull of at most five directions: all faces are tried.
HullPoint least_norm_in_hull(const std::vector<Contact>& contacts,
                             const std::vector<std::size_t>& chosen) {
  HullPoint best;
  for (unsigned mask = 1; mask < (1U << chosen.size()); ++mask) {
    std::vector<std::size_t> face;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if ((mask >> i & 1U) != 0U) face.push_back(chosen[i]);
    }
    if (face.size() > 4) continue;
    HullPoint point = least_norm_in_affine_hull(contacts, face);
    if (point.support.empty()) continue;
    if (best.support.empty() || point.point.norm() < best.point.norm()) best = std::move(point);
  }
  return best;
}

// `room` bounds the distance of the best centre from the candidate's.
Wide dual_bound(const std::vector<Contact>& contacts, Wide room) {
  HullPoint current = least_norm_in_hull(contacts, {0});
  Wide best = 0.0L;
  for (int i = 0; i < 200; ++i) {
    Wide value = -current.point.norm() * room;
    Wide sum = 0.0L;
    for (const Wide weight : current.weights) sum += weight;
    for (std::size_t k = 0; k < current.support.size(); ++k) {
      value += current.weights[k] / sum * contacts[current.support[k]].reach;
    }
    best = std::max(best, value);
    std::size_t next = 0;
    for (std::size_t k = 1; k < contacts.size(); ++k) {
      if (contacts[k].direction.dot(current.point) < contacts[next].direction.dot(current.point)) {
        next = k;
      }
    }
    std::vector<std::size_t> chosen = current.support;
    if (std::find(chosen.begin(), chosen.end(), next) != chosen.end()) break;
    chosen.push_back(next);
    HullPoint improved = least_norm_in_hull(contacts, chosen);
    if (!(improved.point.norm() < current.point.norm())) break;
    current = std::move(improved);
  }
  return best;
}

}  // namespace

std::string fault_of(const SphereTreeData& data) {
  const std::size_t count = data.radius.size();
  if (count == 0 || data.spheres.empty()) return "empty";
  std::vector<int> visits(count, 0);
  std::vector<int> leaves(data.spheres.size(), 0);
  std::deque<std::size_t> open = {0};
  std::size_t expected = 0;
  while (!open.empty()) {
    const std::size_t node = open.front();
    open.pop_front();
    const std::string name = "node " + std::to_string(node);
    if (node != expected++) return name + " is out of breadth-first order";
    if (++visits.at(node) > 1) return name + " is visited twice";
    const Sphere sphere = sphere_of(data, node);
    if (!usable(sphere)) return name + " is not usable";
    const auto first = data.first_child.at(node);
    const auto children = data.child_count.at(node);
    if (children == 0) {
      const auto index = static_cast<std::size_t>(first);
      if (++leaves.at(index) > 1) return name + ": the sphere has two leaves";
      if (!identical(sphere, data.spheres[index])) return name + " differs from its sphere";
      continue;
    }
    if (children < 0 || children > 16) return name + " has too many children";
    for (std::int32_t i = 0; i < children; ++i) {
      const auto child = static_cast<std::size_t>(first + i);
      if (child <= node) return name + " comes after its child";
      if (!encloses_exactly(sphere, sphere_of(data, child)))
        return name + " does not enclose a child";
      open.push_back(child);
    }
  }
  if (std::count(visits.begin(), visits.end(), 1) != static_cast<std::ptrdiff_t>(count)) {
    return "a node is not reached";
  }
  if (std::count(leaves.begin(), leaves.end(), 1) != static_cast<std::ptrdiff_t>(leaves.size())) {
    return "a sphere has no leaf";
  }
  return {};
}

int depth_of(const SphereTreeData& data) {
  int deepest = 0;
  std::vector<std::pair<std::size_t, int>> open = {{0, 0}};
  while (!open.empty()) {
    const auto [node, depth] = open.back();
    open.pop_back();
    deepest = std::max(deepest, depth);
    for (std::int32_t i = 0; i < data.child_count[node]; ++i) {
      open.emplace_back(static_cast<std::size_t>(data.first_child[node] + i), depth + 1);
    }
  }
  return deepest;
}

long double smallest_radius_lower_bound(const Sphere& candidate, std::span<const Sphere> spheres) {
  const WideVector center = candidate.center.cast<Wide>();
  const Wide radius = candidate.radius;
  Wide bound = 0.0L;
  // Slack of the contacts tried: what touches exactly is found among the tight ones, what is only
  // near the limit (centres rounded to double) among the loose ones. Every choice gives a bound.
  std::vector<Contact> all;
  Wide room = radius;
  for (const Sphere& sphere : spheres) {
    bound = std::max(bound, static_cast<Wide>(sphere.radius));
    const WideVector offset = center - sphere.center.cast<Wide>();
    const Wide length = offset.stableNorm();
    room = std::min(room, length + radius - sphere.radius);
    if (length > 0.0L) all.push_back({offset / length, length + sphere.radius});
  }
  for (const Wide slack : {1e-15L, 1e-14L, 1e-13L, 1e-12L, 1e-10L, 1e-8L, 1e-6L}) {
    std::vector<Contact> contacts;
    for (const Contact& contact : all) {
      if (contact.reach >= radius * (1.0L - slack)) contacts.push_back(contact);
    }
    if (!contacts.empty()) bound = std::max(bound, dual_bound(contacts, room));
  }
  return bound;
}

}  // namespace spherule::test
