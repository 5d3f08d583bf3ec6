// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <functional>

// How fast curves and surfaces turn: bounds of the derivatives over a range of the parameters, from
// closed forms. docs/cad.md says what is proved from them.

namespace spherule::internal {

struct Interval {
  double low = 0.0;
  double high = 0.0;

  double length() const { return high - low; }
};

// Of a curve C(t) over an interval: |C'| <= first and |C''| <= second wherever these exist; where
// C' jumps, the jumps add up to at most `jump`. The curve lies in the sphere (center, radius).
struct CurveBounds {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
  double first = 0.0;
  double second = 0.0;
  double jump = 0.0;
};

// Of a surface S(u, v) over a rectangle: norms of the partial derivatives, and on each line along
// u (v) the sum of the jumps of S_u (S_v).
struct SurfaceBounds {
  double u = 0.0;
  double v = 0.0;
  double uu = 0.0;
  double uv = 0.0;
  double vv = 0.0;
  double jump_u = 0.0;
  double jump_v = 0.0;
};

using CurveBound = std::function<CurveBounds(Interval)>;
using SurfaceBound = std::function<SurfaceBounds(Interval, Interval)>;

// point + t direction, the direction of length one.
CurveBound line_bound(const Eigen::Vector3d& point, const Eigen::Vector3d& direction);

// center + a cos(t) x + b sin(t) y, x and y orthonormal, with `major` the larger of a and b.
CurveBound ellipse_bound(const Eigen::Vector3d& center, double major);

// S(u, v) = point + u x + v y, x and y orthonormal.
SurfaceBound plane_bound();

// Radius `radius` + v sin(half_angle) about the axis, height v cos(half_angle); u is the angle. A
// cylinder is the cone of half_angle 0.
SurfaceBound cone_bound(double radius, double half_angle);

// Radius `major` + `minor` cos(v) about the axis, height `minor` sin(v); u is the angle. A sphere
// is the torus of major radius 0.
SurfaceBound torus_bound(double major, double minor);

// S(u, v) = C(u) + v direction, the direction of length one.
SurfaceBound extrusion_bound(CurveBound curve);

// C(v) turned by the angle u about the axis, whose direction has length one.
SurfaceBound revolution_bound(CurveBound curve, const Eigen::Vector3d& axis_point,
                              const Eigen::Vector3d& axis_direction);

}  // namespace spherule::internal
