// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cad/internal/surface_bounds.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace spherule::internal {
namespace {

// Whether `angle` plus a multiple of two pi lies in the interval, or so near that rounding hides
// it.
bool holds_angle(Interval interval, double angle) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  constexpr double kSlack = 1e-12;
  const double slack = kSlack * (1.0 + std::max(std::abs(interval.low), std::abs(interval.high)));
  const double turns = std::ceil((interval.low - slack - angle) / kTurn);
  return angle + turns * kTurn <= interval.high + slack;
}

// The values of the cosine on the interval.
Interval cosine_range(Interval interval) {
  const auto [low, high] = std::minmax({std::cos(interval.low), std::cos(interval.high)});
  return {holds_angle(interval, std::numbers::pi) ? -1.0 : low,
          holds_angle(interval, 0.0) ? 1.0 : high};
}

double largest_magnitude(Interval values) {
  return std::max(std::abs(values.low), std::abs(values.high));
}

}  // namespace

CurveBound line_bound(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) {
  return [=](Interval t) {
    return CurveBounds{.center = point + 0.5 * (t.low + t.high) * direction,
                       .radius = 0.5 * t.length(),
                       .first = 1.0};
  };
}

CurveBound ellipse_bound(const Eigen::Vector3d& center, double major) {
  return [=](Interval) {
    return CurveBounds{.center = center, .radius = major, .first = major, .second = major};
  };
}

SurfaceBound plane_bound() {
  return [](Interval, Interval) { return SurfaceBounds{.u = 1.0, .v = 1.0}; };
}

SurfaceBound cone_bound(double radius, double half_angle) {
  return [radius, slope = std::sin(half_angle)](Interval, Interval v) {
    const double around =
        std::max(std::abs(radius + slope * v.low), std::abs(radius + slope * v.high));
    return SurfaceBounds{.u = around, .v = 1.0, .uu = around, .uv = std::abs(slope)};
  };
}

SurfaceBound torus_bound(double major, double minor) {
  return [=](Interval, Interval v) {
    const Interval cosine = cosine_range(v);
    const double around =
        largest_magnitude({major + minor * cosine.low, major + minor * cosine.high});
    constexpr double kQuarter = 0.5 * std::numbers::pi;
    const double sine = largest_magnitude(cosine_range({v.low - kQuarter, v.high - kQuarter}));
    return SurfaceBounds{.u = around, .v = minor, .uu = around, .uv = minor * sine, .vv = minor};
  };
}

SurfaceBound extrusion_bound(CurveBound curve) {
  return [curve = std::move(curve)](Interval u, Interval) {
    const CurveBounds c = curve(u);
    return SurfaceBounds{.u = c.first, .v = 1.0, .uu = c.second, .jump_u = c.jump};
  };
}

SurfaceBound revolution_bound(CurveBound curve, const Eigen::Vector3d& axis_point,
                              const Eigen::Vector3d& axis_direction) {
  return [=](Interval, Interval v) {
    const CurveBounds c = curve(v);
    const double around =
        axis_direction.cross(Eigen::Vector3d(c.center - axis_point)).norm() + c.radius;
    return SurfaceBounds{
        .u = around, .v = c.first, .uu = around, .uv = c.first, .vv = c.second, .jump_v = c.jump};
  };
}

}  // namespace spherule::internal
