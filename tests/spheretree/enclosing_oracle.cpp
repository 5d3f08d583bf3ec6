// SPDX-License-Identifier: BSD-3-Clause
#include "tests/spheretree/enclosing_oracle.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace spherule::test {
namespace {

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;

// A sphere that (nearly) touches the candidate from inside.
struct Contact {
  Vector direction;  // from the sphere's centre to the candidate's
  Real reach;        // |c - c_i| + r_i
};

struct HullPoint {
  Vector point = Vector::Zero();
  std::vector<std::size_t> support;  // indices of contacts
  std::vector<Real> weights;
};

// The point of least norm in the affine hull of the chosen directions; empty support if degenerate
// or outside the convex hull.
HullPoint least_norm_in_affine_hull(const std::vector<Contact>& contacts,
                                    const std::vector<std::size_t>& chosen) {
  const auto n = static_cast<Eigen::Index>(chosen.size());
  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> system(n + 1, n + 1);
  system.setZero();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      system(i, j) = contacts[chosen[static_cast<std::size_t>(i)]].direction.dot(
          contacts[chosen[static_cast<std::size_t>(j)]].direction);
    }
    system(i, n) = system(n, i) = 1.0L;
  }
  Eigen::Matrix<Real, Eigen::Dynamic, 1> right(n + 1);
  right.setZero();
  right(n) = 1.0L;
  const auto solver = system.fullPivLu();
  HullPoint result;
  if (!solver.isInvertible()) return result;
  const Eigen::Matrix<Real, Eigen::Dynamic, 1> weights = solver.solve(right);
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
Real dual_bound(const std::vector<Contact>& contacts, Real room) {
  HullPoint current = least_norm_in_hull(contacts, {0});
  Real best = 0.0L;
  for (int i = 0; i < 200; ++i) {
    Real value = -current.point.norm() * room;
    Real sum = 0.0L;
    for (const Real weight : current.weights) sum += weight;
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

long double smallest_radius_lower_bound(const Sphere& candidate, std::span<const Sphere> spheres) {
  const Vector center = candidate.center.cast<Real>();
  const Real radius = candidate.radius;
  Real bound = 0.0L;
  // Slack of the contacts tried: what touches exactly is found among the tight ones, what is only
  // near the limit (centres rounded to double) among the loose ones. Every choice gives a bound.
  std::vector<Contact> all;
  Real room = radius;
  for (const Sphere& sphere : spheres) {
    bound = std::max(bound, static_cast<Real>(sphere.radius));
    const Vector offset = center - sphere.center.cast<Real>();
    const Real length = offset.stableNorm();
    room = std::min(room, length + radius - sphere.radius);
    if (length > 0.0L) all.push_back({offset / length, length + sphere.radius});
  }
  for (const Real slack : {1e-15L, 1e-14L, 1e-13L, 1e-12L, 1e-10L, 1e-8L, 1e-6L}) {
    std::vector<Contact> contacts;
    for (const Contact& contact : all) {
      if (contact.reach >= radius * (1.0L - slack)) contacts.push_back(contact);
    }
    if (!contacts.empty()) bound = std::max(bound, dual_bound(contacts, room));
  }
  return bound;
}

}  // namespace spherule::test
