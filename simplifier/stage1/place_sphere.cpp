// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage1/place_sphere.h"

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

// Whether each point of a cube lies in the ball, or nearer than `near` to `q`.
bool is_held(const Vector3d& center, double half_edge, double half_diagonal, const Sphere& ball,
             const Vector3d& q, double near, int depth) {
  const double from_q = distance_upper(center, q);
  if (add_up(from_q, half_diagonal) < near) return true;
  const double from_ball = distance_upper(center, ball.center);
  if (add_up(from_ball, half_diagonal) <= ball.radius) return true;
  if (depth == kDepth || (from_q >= near && from_ball > ball.radius)) return false;
  const double quarter = 0.5 * half_edge;
  for (int k = 0; k < 8; ++k) {
    const Vector3d child =
        center + Vector3d((k & 1) != 0 ? quarter : -quarter, (k & 2) != 0 ? quarter : -quarter,
                          (k & 4) != 0 ? quarter : -quarter);
    if (!is_held(child, quarter, 0.5 * half_diagonal, ball, q, near, depth + 1)) return false;
  }
  return true;
}

}  // namespace

std::optional<Sphere> sphere_of_places(const MeshDistance& distance, double padding,
                                       const PlaceCell& cell) {
  const double edge = 2.0 * cell.half_edge;
  const double rho = cell.least_radius;
  const double surface_at_most = rho + padding + 2.0 * cell.half_diagonal + 2.0 * edge;
  const SurfaceDistance nearest = distance(cell.center, surface_at_most);
  if (nearest.triangle < 0) return std::nullopt;
  const Vector3d q = nearest.closest;
  const Vector3d away = cell.center - q;
  const double height = away.norm();
  if (!(height > 0.0)) return std::nullopt;

  const double ratio = edge / cell.step;
  const double wanted = kRadius * rho * ratio * ratio;
  const Vector3d normal = away / height;
  Sphere ball{q + (wanted + padding) * normal, 0.0};
  const double limit = (wanted + padding) * SphereWay::kLimitUp;
  ball.radius = sub_down(distance(ball.center, limit).lower, padding);
  if (ball.radius < wanted / kRadius || distance_upper(cell.center, ball.center) > ball.radius) {
    return std::nullopt;
  }

  // q is computed: a point of the surface, up to rounding.
  const SurfaceDistance at_q = distance(q, 1e-6 * cell.step);
  if (at_q.triangle < 0) return std::nullopt;
  const double near = sub_down(add_down(rho, padding), at_q.upper);
  if (!is_held(cell.center, cell.half_edge, cell.half_diagonal, ball, q, near, 0)) {
    return std::nullopt;
  }

  const double scallop = cell.step * cell.step / (4.0 * rho) + padding;
  const double aside = std::sqrt(2.0) * cell.half_edge;
  const double down = std::sqrt(std::max(0.0, ball.radius * ball.radius - aside * aside));
  const Vector3d first = normal.unitOrthogonal();
  const Vector3d second = normal.cross(first);
  for (const Vector3d& direction : {first, Vector3d(-first), second, Vector3d(-second)}) {
    const Vector3d rim = ball.center - down * normal + aside * direction;
    if (distance(rim, scallop).triangle < 0) return std::nullopt;
  }
  return ball;
}

}  // namespace spherule::internal
