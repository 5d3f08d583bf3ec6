// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage1/sphere_of_places.h"

#include "simplifier/stage1/sphere_way.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cmath>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// The radius that is asked for, over the one whose scallop is as high as those of the finest cells:
// the rest is for surfaces that curve away from the sphere.
constexpr double kRadius = 1.5;
// How often the cell is halved to prove that two balls hold it.
constexpr int kDepth = 3;
// Of the hierarchy over the mesh, for one distance: more are near only inside of round shapes.
constexpr std::size_t kMostLeaves = 24;

double scallop(const PlaceCell& cell) {
  return cell.step * cell.step / (4.0 * cell.rho);
}

// Whether each point of a cube lies in the ball, or nearer than `near` to `q`.
bool is_held(const Vector3d& center, double half_edge, double rounding, const Sphere& ball,
             const Vector3d& q, double near, int depth = 0) {
  const double half_diagonal = 1.7320508075688773 * half_edge * (1.0 + 1e-9);
  const double from_q = distance_upper(center, q);
  if (add_up(from_q, half_diagonal) < near) return true;
  const double from_ball = distance_upper(center, ball.center);
  if (add_up(from_ball, half_diagonal) <= ball.radius) return true;
  if (depth == kDepth || (from_q >= near && from_ball > ball.radius)) return false;
  const double half = 0.5 * half_edge;
  for (int k = 0; k < 8; ++k) {
    const Vector3d child =
        center + Vector3d((k & 1) != 0 ? half : -half, (k & 2) != 0 ? half : -half,
                          (k & 4) != 0 ? half : -half);
    // Wider by what the centre was rounded by.
    if (!is_held(child, half + rounding, rounding, ball, q, near, depth + 1)) return false;
  }
  return true;
}

}  // namespace

std::optional<SphereOfPlaces> wanted_sphere(const MeshDistance& distance, double padding,
                                            const PlaceCell& cell) {
  const SurfaceDistance nearest =
      distance(cell.center, cell.surface_at_most * SphereWay::kLimitUp, kMostLeaves);
  const Vector3d away = cell.center - nearest.closest;
  const double height = away.norm();
  if (nearest.triangle < 0 || !(height > 0.0)) return std::nullopt;
  const double ratio = 2.0 * cell.half_edge / cell.step;
  SphereOfPlaces wanted{.sphere = {Vector3d::Zero(), kRadius * cell.rho * ratio * ratio},
                        .foot = nearest.closest,
                        .normal = away / height};
  wanted.sphere.center = wanted.foot + (wanted.sphere.radius + padding) * wanted.normal;
  if (!is_usable(wanted.sphere) || !is_held(cell.center, cell.half_edge, cell.rounding,
                                            wanted.sphere, wanted.foot, cell.rho + padding)) {
    return std::nullopt;
  }
  return wanted;
}

std::optional<Sphere> sphere_of_places(const MeshDistance& distance, double padding,
                                       const PlaceCell& cell, const SphereOfPlaces& wanted) {
  Sphere ball = wanted.sphere;
  const double limit = (ball.radius + padding) * SphereWay::kLimitUp;
  ball.radius = sub_down(distance(ball.center, limit, kMostLeaves).lower, padding);
  if (ball.radius < wanted.sphere.radius - scallop(cell)) return std::nullopt;

  // The foot is computed: a point of the surface, up to rounding.
  const SurfaceDistance at_foot = distance(wanted.foot, 1e-6 * cell.step, kMostLeaves);
  const double near = sub_down(add_down(cell.rho, padding), at_foot.upper);
  if (!(near > 0.0) ||
      !is_held(cell.center, cell.half_edge, cell.rounding, ball, wanted.foot, near)) {
    return std::nullopt;
  }

  const double aside = std::sqrt(2.0) * cell.half_edge;
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
