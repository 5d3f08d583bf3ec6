// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// How fast curves and surfaces turn: bounds of the derivatives over a range of the parameters, from
// closed forms. docs/cad.md says what is proved from them.

#include "geometry/mesh_distance.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

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

using Parameters = Eigen::Vector2d;  // (u, v)

struct ParametricSurface {
  std::function<Eigen::Vector3d(const Parameters&)> point;
  SurfaceBound bound;  // empty where no bound is known
  // Where the surface is defined; infinite along directions without end.
  Interval u;
  Interval v;
};

// A curve in the parameters of a surface, with the third coordinate zero in its bounds.
struct ParameterCurve {
  std::function<Parameters(double)> point;
  CurveBound bound;  // empty where no bound is known
};

// A piece of the boundary of a face, from one node of the triangulation to another, with the face
// on its left.
struct BoundaryArc {
  int start = 0;
  int end = 0;
  std::size_t curve = 0;
  double from = 0.0;  // parameters of the curve at `start` and `end`
  double to = 0.0;
};

// A piece of a surface cut out by curves, and the triangles put in its place. Triangles turn in the
// parameters as u to v.
struct TessellatedFace {
  ParametricSurface surface;
  std::vector<ParameterCurve> curves;
  std::vector<BoundaryArc> boundary;
  std::vector<Parameters> parameters;  // of each node
  std::vector<Eigen::Vector3d> nodes;
  std::vector<std::array<int, 3>> triangles;
};

// How far points of faces are from the triangles in their place, over all faces added.
//
// bound(): proved, for every point S(u, v) of every face for which add() gave no reason, (u, v)
// being enclosed by the boundary of the face: the distance to the nearest triangle of that face is
// at most this, if S is computed exactly. (docs/cad.md has the proof.)
// reached(): the distance from the triangles of the face that was found at some point of it, or of
// its surface beside its boundary: a bound below it cannot be proved in this way.
// The search stops when the bound is within 2 % of what was reached, or below `floor`, or when it
// has taken too many steps.
class SurfaceDeviation {
 public:
  // Lengths below `floor` > 0 are not told apart.
  explicit SurfaceDeviation(double floor) : floor_(floor) {}

  // An empty text, or why no bound is proved for the face; that face then does not count.
  std::string add(const TessellatedFace& face);

  double bound() const { return bound_; }
  double reached() const { return reached_; }

 private:
  struct Piece {
    std::array<Parameters, 3> parameters;
    std::array<Eigen::Vector3d, 3> points;  // of the surface at these
    std::size_t triangle;                   // the one it is compared with
  };
  struct Target {
    const TessellatedFace& face;
    MeshDistance distance;
  };

  // `extra` is to be added to what is found.
  void cover(const Target& target, const std::array<Parameters, 3>& parameters,
             std::size_t triangle, double extra);
  void cover(const Target& target, Piece piece, double extra, int depth);
  void cover_arc(const Target& target, const BoundaryArc& arc, std::size_t triangle);
  bool is_done(double value) const;

  double floor_;
  double bound_ = 0.0;
  double reached_ = 0.0;
  std::size_t steps_ = 0;
};

// The largest distance found at samples of the face, those beyond the chords of its boundary among
// them, from its triangles. No bound.
double sampled_deviation(const TessellatedFace& face);

}  // namespace spherule::internal
