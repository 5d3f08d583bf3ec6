// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/solid/clearance.h"

#include "spheretree/rounding.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace spherule {

using Eigen::Vector3d;

namespace {

std::vector<Vector3d> centers_of(std::span<const Sphere> balls) {
  std::vector<Vector3d> centers;
  centers.reserve(balls.size());
  for (const Sphere& s : balls) centers.push_back(s.center);
  return centers;
}

double least_radius(std::span<const Sphere> balls) {
  double least = std::numeric_limits<double>::infinity();
  for (const Sphere& s : balls) least = std::min(least, s.radius);
  return least;
}

// A ball touches the mesh grown by the padding, or nearly: what is further need not be looked at.
Vector3d contact_of(const Sphere& ball, double padding, const MeshDistance& distance) {
  constexpr double kNearly = 1.001;
  const SurfaceDistance near = distance(ball.center, kNearly * (ball.radius + padding));
  return near.triangle < 0 ? distance(ball.center).closest : near.closest;
}

std::vector<Vector3d> contacts_of(const ExternalSpheres& external, const MeshDistance& distance) {
  std::vector<Vector3d> contacts(external.balls.size());
  tbb::parallel_for(std::size_t{0}, contacts.size(), [&](std::size_t i) {
    contacts[i] = contact_of(external.balls[i], external.padding, distance);
  });
  return contacts;
}

}  // namespace

Clearance::Clearance(const ExternalSpheres& external)
    : Clearance(external, internal::BallHierarchy(external.balls)) {}

Clearance::Clearance(const ExternalSpheres& external, const MeshDistance& distance)
    : Clearance(external,
                internal::BallHierarchy(external.balls, contacts_of(external, distance))) {}

Clearance::Clearance(const ExternalSpheres& external, internal::BallHierarchy balls)
    : centers_(centers_of(external.balls)),
      balls_(std::move(balls)),
      box_(external.box),
      least_external_(least_radius(external.balls)) {}

// A face of the box is an external ball of infinite radius; its gap is a single difference.
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
  const internal::NearestBall ball = balls_.nearest(point, std::min(nearest, limit), tolerance);
  if (ball.index < 0) {
    if (!balls_.empty()) result.lower = std::min(result.lower, ball.lower);
    return result;
  }
  result.lower = std::min(result.lower, ball.lower);
  result.upper = std::min(result.upper, ball.upper);
  const Vector3d d = point - centers_[static_cast<std::size_t>(ball.index)];
  const double norm = d.norm();
  if (norm > 0.0) result.away = d / norm;
  return result;
}

}  // namespace spherule
