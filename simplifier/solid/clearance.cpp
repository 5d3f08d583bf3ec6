// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/solid/clearance.h"

#include "simplifier/support/parallel.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace spherule::internal {

using Eigen::Vector3d;

namespace {

std::vector<Vector3d> centers_of(std::span<const Sphere> spheres) {
  std::vector<Vector3d> centers;
  centers.reserve(spheres.size());
  for (const Sphere& s : spheres) centers.push_back(s.center);
  return centers;
}

double least_radius(std::span<const Sphere> spheres) {
  double least = std::numeric_limits<double>::infinity();
  for (const Sphere& s : spheres) least = std::min(least, s.radius);
  return least;
}

// A sphere touches the mesh grown by the padding, or nearly: what is further need not be examined.
Vector3d contact_of(const Sphere& sphere, double padding, const MeshDistance& distance) {
  constexpr double kNearly = 1.001;
  const SurfaceDistance near = distance(sphere.center, kNearly * (sphere.radius + padding));
  return near.triangle < 0 ? distance(sphere.center).closest : near.closest;
}

std::vector<Vector3d> contacts_of(const ExternalSpheres& external, const MeshDistance& distance) {
  std::vector<Vector3d> contacts(external.spheres.size());
  parallel_for(0, contacts.size(), [&](std::size_t i) {
    contacts[i] = contact_of(external.spheres[i], external.padding, distance);
  });
  return contacts;
}

}  // namespace

Clearance::Clearance(const ExternalSpheres& external)
    : Clearance(external, SphereHierarchy(external.spheres)) {}

Clearance::Clearance(const ExternalSpheres& external, const MeshDistance& distance)
    : Clearance(external, SphereHierarchy(external.spheres, contacts_of(external, distance))) {}

Clearance::Clearance(const ExternalSpheres& external, SphereHierarchy spheres)
    : centers_(centers_of(external.spheres)),
      spheres_(std::move(spheres)),
      box_(external.box),
      least_external_(least_radius(external.spheres)) {}

// A face of the box is an external sphere of infinite radius; its gap is a single difference.
ClearanceAt Clearance::operator()(const Vector3d& point, double tolerance, double limit) const {
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
  const NearestSphere sphere = spheres_.nearest(point, std::min(nearest, limit), tolerance);
  if (sphere.index < 0) {
    if (!spheres_.empty()) result.lower = std::min(result.lower, sphere.lower);
    return result;
  }
  result.lower = std::min(result.lower, sphere.lower);
  result.upper = std::min(result.upper, sphere.upper);
  const Vector3d d = point - centers_[static_cast<std::size_t>(sphere.index)];
  const double norm = d.norm();
  if (norm > 0.0) result.away = d / norm;
  return result;
}

}  // namespace spherule::internal
