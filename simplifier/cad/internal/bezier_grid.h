// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/cad/internal/surface_bounds.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace spherule::internal {

// Control points of a rational Bezier patch, i along u and j along v, each (w x, w y, w z, w) with
// w > 0.
struct BezierNet {
  int rows = 0;
  int columns = 0;
  std::vector<Eigen::Vector4d> points;  // point (i, j) at i * columns + j

  const Eigen::Vector4d& at(int i, int j) const {
    return points[static_cast<std::size_t>(i * columns + j)];
  }
};

// A (rational) B-spline surface as its Bezier patches, or a curve, whose patches have one column.
// Derivatives are bounded by the control points of the derivative: a Bezier patch lies in the
// convex hull of its control points, and its derivatives are Bezier patches (Piegl and Tiller, The
// NURBS Book, 1997, 1.3 and 4.5, for the quotients of rational ones). These and those of a
// degree above three are split first: the bounds are tight on small patches only. Knots at which
// the surface is only continuous are found by the jump of the derivative across them.
class BezierGrid {
 public:
  // Patch (i, j) over [u_knots[i], u_knots[i + 1]] x [v_knots[j], v_knots[j + 1]] stands at
  // i * (v_knots.size() - 1) + j; a curve has v_knots {0, 1}. Periodic: what lies outside of the
  // knots is shifted into them by whole periods.
  BezierGrid(std::vector<double> u_knots, std::vector<double> v_knots,
             std::vector<BezierNet> patches, bool u_periodic, bool v_periodic);

  // Over a rectangle that lies within the knots where the direction is not periodic.
  SurfaceBounds bounds(Interval u, Interval v) const;
  // Of a curve.
  CurveBounds curve_bounds(Interval t) const;

 private:
  struct Sphere {
    Eigen::Vector3d center;
    double radius;
  };
  // Which spans an interval intersects, and which knots lie inside of it; knot 0 is the seam.
  struct Reach {
    std::vector<std::size_t> spans;
    std::vector<std::size_t> knots;
  };

  static Reach reach(Interval interval, const std::vector<double>& knots, bool periodic);
  std::size_t patch(std::size_t i, std::size_t j) const { return i * (v_knots_.size() - 1) + j; }

  std::vector<double> u_knots_;
  std::vector<double> v_knots_;
  bool u_periodic_;
  bool v_periodic_;
  std::vector<SurfaceBounds> bounds_;  // of each patch, without jumps
  std::vector<Sphere> spheres_;
  std::vector<double> u_jumps_;  // across the side of patch (i, j) at u_knots[i]
  std::vector<double> v_jumps_;  // across the side of patch (i, j) at v_knots[j]
};

}  // namespace spherule::internal
