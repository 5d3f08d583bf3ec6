// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage1/sphere_of_places.h"

#include "simplifier/stage1/sphere_displacement.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cmath>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// The radius of a wanted sphere, over the one whose scallop is as high as those of the finest
// cells: the rest is for surfaces that curve away from the sphere.
constexpr double kRadius = 1.5;
// How often the cell is halved, across one axis each time, to prove that two balls hold it.
constexpr int kMostHalvings = 9;
// Of the hierarchy over the mesh, for one distance: more are near only inside of round shapes.
constexpr std::size_t kMostLeaves = 24;

double scallop(const PlaceCell& cell) {
  return cell.step * cell.step / (4.0 * cell.rho);
}

// Whether each point of a cell lies in the ball, or nearer than `near` to `q`.
bool is_held(const BoxCell& cell, const Sphere& ball, const Vector3d& q, double near,
             int halvings = kMostHalvings) {
  if (cell.furthest(q) < near || cell.furthest(ball.center) <= ball.radius) return true;
  const bool is_center_out = distance_upper(cell.center, q) >= near &&
                             distance_upper(cell.center, ball.center) > ball.radius;
  if (halvings == 0 || is_center_out) return false;
  const auto [low, high] = cell.halves();
  return is_held(low, ball, q, near, halvings - 1) && is_held(high, ball, q, near, halvings - 1);
}

}  // namespace

std::optional<SphereOfPlaces> wanted_sphere(const MeshDistance& distance, double padding,
                                            const PlaceCell& cell) {
  const SurfaceDistance nearest =
      distance(cell.box.center, cell.surface_at_most * SphereDisplacement::kLimitUp, kMostLeaves);
  const Vector3d away = cell.box.center - nearest.closest;
  const double height = away.norm();
  if (nearest.triangle < 0 || !(height > 0.0)) return std::nullopt;
  const double ratio = 2.0 * cell.box.half[0] / cell.step;
  SphereOfPlaces wanted{.sphere = {Vector3d::Zero(), kRadius * cell.rho * ratio * ratio},
                        .foot = nearest.closest,
                        .normal = away / height};
  wanted.sphere.center = wanted.foot + (wanted.sphere.radius + padding) * wanted.normal;
  if (!is_usable(wanted.sphere) ||
      !is_held(cell.box, wanted.sphere, wanted.foot, cell.rho + padding)) {
    return std::nullopt;
  }
  return wanted;
}

std::optional<Sphere> sphere_of_places(const MeshDistance& distance, double padding,
                                       const PlaceCell& cell, const SphereOfPlaces& wanted) {
  Sphere ball = wanted.sphere;
  const double limit = (ball.radius + padding) * SphereDisplacement::kLimitUp;
  ball.radius = sub_down(distance(ball.center, limit, kMostLeaves).lower, padding);
  if (ball.radius < wanted.sphere.radius - scallop(cell)) return std::nullopt;

  // The foot is computed: a point of the surface, up to rounding.
  const SurfaceDistance at_foot = distance(wanted.foot, 1e-6 * cell.step, kMostLeaves);
  const double near = sub_down(add_down(cell.rho, padding), at_foot.upper);
  if (!(near > 0.0) || !is_held(cell.box, ball, wanted.foot, near)) {
    return std::nullopt;
  }

  const double aside = std::sqrt(2.0) * cell.box.half[0];
  const double down = std::sqrt(std::max(0.0, ball.radius * ball.radius - aside * aside));
  const Vector3d first = wanted.normal.unitOrthogonal();
  const Vector3d second = wanted.normal.cross(first);
  for (const Vector3d& direction : {first, Vector3d(-first), second, Vector3d(-second)}) {
    const Vector3d rim = ball.center - down * wanted.normal + aside * direction;
    const double surface = distance(rim, scallop(cell) + padding, kMostLeaves).upper;
    if (!(surface <= scallop(cell) + padding)) return std::nullopt;
  }
  return ball;
}

}  // namespace spherule::internal
