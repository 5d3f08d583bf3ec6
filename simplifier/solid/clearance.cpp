// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/solid/clearance.h"

#include "spheretree/rounding.h"

#include <algorithm>
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

}  // namespace spherule::internal
