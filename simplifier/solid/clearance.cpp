// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/solid/clearance.h"

#include "base/rounding.h"
#include "simplifier/solid/medial_ascent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace spherule::internal {

using Eigen::Vector3d;

namespace {

double least_radius(std::span<const Sphere> spheres) {
  double least = std::numeric_limits<double>::infinity();
  for (const Sphere& s : spheres) least = std::min(least, s.radius);
  return least;
}

}  // namespace

Clearance::Clearance(const ExternalSpheres& external)
    : cells_(std::make_shared<NearestCells>(external.spheres, external.box)),
      box_(external.box),
      least_external_(least_radius(external.spheres)) {}

// A face of the box is an external sphere of infinite radius; its gap is a single difference.
ClearanceAt Clearance::operator()(const Vector3d& point, double limit) const {
  ClearanceAt result;
  double nearest = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = point[axis] - box_.min()[axis];
    const double high = box_.max()[axis] - point[axis];
    if (low < nearest) {
      nearest = low;
      result.away = Vector3d::Unit(axis);
    }
    if (high < nearest) {
      nearest = high;
      result.away = -Vector3d::Unit(axis);
    }
  }
  // The difference of two doubles is rounded to zero only if they are equal.
  result.lower = nearest == 0.0 ? 0.0 : next_down(nearest);
  result.upper = nearest == 0.0 ? 0.0 : next_up(nearest);
  const NearestSphere sphere = cells_->nearest(point, std::min(nearest, limit));
  if (sphere.index < 0) {
    if (!cells_->spheres().empty()) result.lower = std::min(result.lower, sphere.lower);
    return result;
  }
  result.lower = std::min(result.lower, sphere.lower);
  result.upper = std::min(result.upper, sphere.upper);
  result.contact = &cells_->spheres()[static_cast<std::size_t>(sphere.index)];
  const Vector3d d = point - result.contact->center;
  const double norm = d.norm();
  if (norm > 0.0) result.away = d / norm;
  return result;
}

bool Clearance::is_at_least(const Vector3d& point, double least) const {
  const double to_faces =
      std::min((point - box_.min()).minCoeff(), (box_.max() - point).minCoeff());
  return to_faces >= least && !cells_->is_any_nearer(point, least);
}

std::vector<AscentStep> ascend(const Clearance& clearance, const Eigen::Vector3d& start,
                               const AscentOptions& options) {
  constexpr double kStoppingSlope = 0.6;
  constexpr int kMaxSteps = 200;
  ClearanceAt here = clearance(start);
  std::vector<AscentStep> path{{start, here.lower}};
  double step = options.first_step;
  for (int i = 0; i < kMaxSteps && step >= options.least_step; ++i) {
    const Eigen::Vector3d next = path.back().point + step * here.away;
    // The clearance cannot grow faster than the point moves, which gives the search a limit.
    const double limit = (here.upper + step) + 1e-9 * (std::abs(here.upper) + step);
    const ClearanceAt there = clearance(next, limit);
    if (there.lower - here.lower >= kStoppingSlope * step) {
      path.push_back({next, there.lower});
      here = there;
      step *= 2.0;
    } else {
      step *= 0.5;
    }
  }
  return path;
}

}  // namespace spherule::internal
