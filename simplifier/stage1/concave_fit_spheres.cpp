// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage1/concave_fit_spheres.h"

#include "spheretree/rounding.h"

#include <algorithm>
#include <vector>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Of the step.
constexpr double kGain = 0.06;
constexpr double kFinest = 0.2;

}  // namespace

std::vector<Sphere> ConcaveFitSpheres::operator()(const FloodGrid::Frontier& frontier) const {
  std::vector<Sphere> found;
  const Sphere& node = frontier.neighbour;
  const double to_surface = node.radius + padding_ + (frontier.center - node.center).norm();
  sample(frontier, frontier.center, to_surface, 0.5 * frontier.step, found);
  return found;
}

void ConcaveFitSpheres::sample(const FloodGrid::Frontier& frontier, const Vector3d& start,
                               double to_surface, double apart, std::vector<Sphere>& found) const {
  const Pushed here = pushed(frontier, start, to_surface, found);
  const bool is_found = here.sphere.radius > 0.0;
  if (is_found) found.push_back(here.sphere);
  const bool is_first = apart == 0.5 * frontier.step;
  if (!(is_found || (is_first && !here.is_flat)) || apart < kFinest * frontier.step) return;
  for (int k = 0; k < 8; ++k) {
    const Vector3d aside((k & 1) != 0 ? apart : -apart, (k & 2) != 0 ? apart : -apart,
                         (k & 4) != 0 ? apart : -apart);
    sample(frontier, start + aside, here.to_surface + aside.norm(), 0.5 * apart, found);
  }
}

ConcaveFitSpheres::Pushed ConcaveFitSpheres::pushed(const FloodGrid::Frontier& frontier,
                                                    const Vector3d& start, double to_surface,
                                                    std::span<const Sphere> found) const {
  constexpr int kMaxPushes = 6;
  const Vector3d& from = frontier.neighbour.center;
  const double rho = diameter_.on_segment(frontier.center, from);
  const double wanted = rho + 0.02 * frontier.step;
  Vector3d x = start;
  Pushed result;
  for (int push = 0; push <= kMaxPushes; ++push) {
    const SurfaceDistance d = distance_(x, to_surface * SphereDisplacement::kLimitUp);
    if (push == 0) result.to_surface = d.upper;
    const double clearance = sub_down(d.lower, padding_);
    if (clearance >= rho) {
      const Sphere sphere{x, clearance};
      const Sphere& node = frontier.neighbour;
      const bool reached = push > 0 && takes_something(sphere, start, frontier.step, node, found) &&
                           diameter_.on_segment(from, x) <= rho &&
                           displacement_.is_free(node, sphere, rho);
      if (reached) result.sphere = sphere;
      result.is_flat = push < 2;
      break;
    }
    const Vector3d away = x - d.closest;
    const double norm = away.norm();
    if (d.triangle < 0 || !(norm > 0.0)) break;
    x += away * ((wanted - clearance) / norm);
    to_surface = d.upper + (wanted - clearance);
    if ((x - start).norm() > 2.0 * frontier.step) break;
  }
  return result;
}

bool ConcaveFitSpheres::takes_something(const Sphere& sphere, const Vector3d& start, double step,
                                        const Sphere& node, std::span<const Sphere> found) const {
  const double enough = kGain * step;
  const Vector3d tip = sphere.center + sphere.radius * (start - sphere.center).normalized();
  const auto holds = [&](const Sphere& other) {
    return (tip - other.center).norm() - other.radius < enough;
  };
  if (holds(node) || std::ranges::any_of(found, holds)) return false;
  return !(reached_.nearest(tip, enough, enough).upper < enough);
}

}  // namespace spherule::internal
