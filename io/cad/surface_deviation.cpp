// SPDX-License-Identifier: BSD-3-Clause
#include "io/cad/surface_deviation.h"

#include "geometry/point_triangle.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
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

namespace {

using Eigen::Vector3d;
using Corners = std::array<Parameters, 3>;

// Covers the rounding of the bounds themselves.
constexpr double kRelative = 1.0 + 1e-9;

Parameters clamped(const ParametricSurface& surface, const Parameters& p) {
  return {std::clamp(p.x(), surface.u.low, surface.u.high),
          std::clamp(p.y(), surface.v.low, surface.v.high)};
}

Interval range(const Corners& corners, int axis) {
  const auto [low, high] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
  return {low, high};
}

// How far S may be from the linear map with its values at the corners, over the triangle.
double deviation_from_linear(const ParametricSurface& surface, const Corners& corners) {
  const Interval u = range(corners, 0);
  const Interval v = range(corners, 1);
  const SurfaceBounds b = surface.bound(u, v);
  const double du = u.length();
  const double dv = v.length();
  const double second = 0.125 * (b.uu * du * du + 2.0 * b.uv * du * dv + b.vv * dv * dv) +
                        0.5 * (b.jump_u * du + b.jump_v * dv);
  const double first = 0.5 * (b.u * du + b.v * dv);
  return kRelative * std::min(first, second);
}

std::array<Vector3d, 3> corners_of(const TessellatedFace& face, std::size_t triangle) {
  std::array<Vector3d, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = face.nodes[static_cast<std::size_t>(face.triangles[triangle][k])];
  }
  return corners;
}

TriangleMesh mesh_of(const TessellatedFace& face) {
  TriangleMesh mesh{face.nodes, {}};
  for (const auto& [a, b, c] : face.triangles) mesh.triangles.emplace_back(a, b, c);
  return mesh;
}

// The largest distance of the points from the triangle, rounded up.
double farthest(const std::array<Vector3d, 3>& points, const std::array<Vector3d, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  double largest = 0.0;
  for (const Vector3d& p : points) {
    largest = std::max(largest, point_triangle_distance(p, a, b, c).upper);
  }
  return largest;
}

Corners parameters_of(const TessellatedFace& face, std::size_t triangle) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = clamped(face.surface,
                         face.parameters[static_cast<std::size_t>(face.triangles[triangle][k])]);
  }
  return corners;
}

using Side = std::pair<int, int>;  // from node, to node

// The triangle left of each directed side.
std::map<Side, std::size_t> triangle_at_side(const TessellatedFace& face) {
  std::map<Side, std::size_t> found;
  for (std::size_t t = 0; t < face.triangles.size(); ++t) {
    const auto& nodes = face.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) found.emplace(Side{nodes[k], nodes[(k + 1) % 3]}, t);
  }
  return found;
}

// Whether the sides of all triangles, each with its direction, add up to the chords of the
// boundary. Then what the chords wind around is covered by triangles.
bool bounds_what_the_boundary_does(const TessellatedFace& face) {
  std::map<Side, int> chain;
  const auto add = [&](int from, int to, int times) {
    if (from < to) chain[{from, to}] += times;
    if (to < from) chain[{to, from}] -= times;
  };
  for (const auto& nodes : face.triangles) {
    for (std::size_t k = 0; k < 3; ++k) add(nodes[k], nodes[(k + 1) % 3], 1);
  }
  for (const BoundaryArc& arc : face.boundary) add(arc.start, arc.end, -1);
  return std::all_of(chain.begin(), chain.end(), [](const auto& side) { return side.second == 0; });
}

// Corners of an arc in the parameters, and the most that what lies between the arc and these is
// from them on the surface.
struct Polyline {
  std::vector<Parameters> points;
  double extra = 0.0;
};

// The arc within `surface` as a polyline of so many parts.
Polyline divide(const ParametricSurface& surface, const ParameterCurve& curve,
                const BoundaryArc& arc, int parts) {
  Polyline result;
  std::vector<Parameters> unclamped;
  const auto parameter = [&](int k) {
    return k == parts ? arc.to : arc.from + (arc.to - arc.from) * k / parts;
  };
  for (int k = 0; k <= parts; ++k) {
    unclamped.push_back(curve.point(parameter(k)));
    result.points.push_back(clamped(surface, unclamped.back()));
  }
  for (int k = 0; k < parts; ++k) {
    const auto [low, high] = std::minmax({parameter(k), parameter(k + 1)});
    const CurveBounds c = curve.bound({low, high});
    const double step = high - low;
    double off = kRelative * std::min(0.5 * c.first * step,
                                      0.125 * c.second * step * step + 0.5 * c.jump * step);
    const auto i = static_cast<std::size_t>(k);
    // Cut off at the edge of the surface, the arc may bend there: the whole box of it then.
    if (unclamped[i] != result.points[i] || unclamped[i + 1] != result.points[i + 1]) {
      off += c.first * step;
    }
    if (off == 0.0) continue;
    const auto inflated = [&](int axis) {
      const auto [a, b] = std::minmax({result.points[i][axis], result.points[i + 1][axis]});
      const Interval& all = axis == 0 ? surface.u : surface.v;
      return Interval{std::max(a - off, all.low), std::min(b + off, all.high)};
    };
    const SurfaceBounds s = surface.bound(inflated(0), inflated(1));
    result.extra = std::max(result.extra, kRelative * off * std::hypot(s.u, s.v));
  }
  return result;
}

}  // namespace

bool SurfaceDeviation::is_done(double value) const {
  return value <= std::max({1.02 * reached_, bound_, floor_});
}

void SurfaceDeviation::cover(const Target& target, const Corners& parameters, std::size_t triangle,
                             double extra) {
  Piece piece{parameters, {}, triangle};
  for (std::size_t k = 0; k < 3; ++k) {
    piece.points[k] = target.face.surface.point(parameters[k]);
  }
  cover(target, piece, extra, 0);
}

// The distance to one triangle is convex, so that the linear map is nowhere farther from it than at
// a corner; the surface is at most the deviation from linear farther. Which triangle that is is
// free to choose. The one in the place of the piece will mostly do, but not about a pole: what is
// one point in space there is a whole side in the parameters.
void SurfaceDeviation::cover(const Target& target, Piece piece, double extra, int depth) {
  constexpr int kMaxDepth = 14;
  constexpr std::size_t kMaxSteps = 300'000;
  const ParametricSurface& surface = target.face.surface;
  const double nonlinearity = deviation_from_linear(surface, piece.parameters) + extra;
  const auto value_for = [&](std::size_t triangle) {
    return kRelative * (farthest(piece.points, corners_of(target.face, triangle)) + nonlinearity);
  };
  double value = value_for(piece.triangle);
  if (is_done(value)) {
    bound_ = std::max(bound_, value);
    return;
  }
  const Vector3d middle =
      surface.point((piece.parameters[0] + piece.parameters[1] + piece.parameters[2]) / 3.0);
  const auto nearest = static_cast<std::size_t>(target.distance(middle).triangle);
  if (nearest != piece.triangle) {
    const double other = value_for(nearest);
    if (other < value) {
      value = other;
      piece.triangle = nearest;
    }
  }
  std::array<Parameters, 3> halves;
  std::array<Vector3d, 3> points;
  for (std::size_t k = 0; k < 3; ++k) {
    halves[k] = 0.5 * (piece.parameters[k] + piece.parameters[(k + 1) % 3]);
    points[k] = surface.point(halves[k]);
    reached_ = std::max(reached_, target.distance(points[k]).lower);
  }
  if (is_done(value) || depth == kMaxDepth || ++steps_ > kMaxSteps) {
    bound_ = std::max(bound_, value);
    return;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t last = (k + 2) % 3;
    cover(target,
          {{piece.parameters[k], halves[k], halves[last]},
           {piece.points[k], points[k], points[last]},
           piece.triangle},
          extra, depth + 1);
  }
  cover(target, {halves, points, piece.triangle}, extra, depth + 1);
}

// What lies between the arc and its chord is covered by triangles from the chord's start to the
// sides of a polyline, but for what lies between the polyline and the arc.
void SurfaceDeviation::cover_arc(const Target& target, const BoundaryArc& arc,
                                 std::size_t triangle) {
  constexpr int kMaxParts = 256;
  const TessellatedFace& face = target.face;
  const ParameterCurve& curve = face.curves[arc.curve];
  int parts = 1;
  Polyline line = divide(face.surface, curve, arc, parts);
  while (line.extra > 0.25 * std::max(floor_, 0.02 * reached_) && parts < kMaxParts) {
    parts *= 2;
    line = divide(face.surface, curve, arc, parts);
  }
  const auto node = [&](int index) {
    return clamped(face.surface, face.parameters[static_cast<std::size_t>(index)]);
  };
  const Parameters start = node(arc.start);
  line.points.insert(line.points.begin(), start);
  line.points.push_back(node(arc.end));
  for (std::size_t k = 1; k + 1 < line.points.size(); ++k) {
    const bool is_chord = line.points[k] == start && line.points[k + 1] == line.points.back();
    // Part of the triangle, which is covered already.
    if (is_chord && line.extra == 0.0) continue;
    if (line.points[k] == line.points[k + 1] && line.extra == 0.0) continue;
    cover(target, {start, line.points[k], line.points[k + 1]}, triangle, line.extra);
  }
}

std::string SurfaceDeviation::add(const TessellatedFace& face) {
  if (!face.surface.bound) return "the derivatives of its kind of surface are not bounded";
  for (const BoundaryArc& arc : face.boundary) {
    if (!face.curves[arc.curve].bound) return "the derivatives of a boundary curve are not bounded";
  }
  if (!bounds_what_the_boundary_does(face)) {
    return "its triangles do not provably fill its boundary";
  }
  const Target target{face, MeshDistance(mesh_of(face))};
  for (std::size_t t = 0; t < face.triangles.size(); ++t) {
    cover(target, parameters_of(face, t), t, 0.0);
  }
  const std::map<Side, std::size_t> triangle_at = triangle_at_side(face);
  for (const BoundaryArc& arc : face.boundary) {
    const auto found = triangle_at.find({arc.start, arc.end});
    if (found == triangle_at.end()) return "a part of its boundary is on no triangle";
    cover_arc(target, arc, found->second);
  }
  return {};
}

double sampled_deviation(const TessellatedFace& face) {
  constexpr int kSteps = 6;
  const MeshDistance distance(mesh_of(face));
  double largest = 0.0;
  const auto sample = [&](const Parameters& p) {
    const Vector3d point = face.surface.point(clamped(face.surface, p));
    largest = std::max(largest, distance(point).upper);
  };
  for (std::size_t t = 0; t < face.triangles.size(); ++t) {
    const auto [a, b, c] = parameters_of(face, t);
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) sample((i * a + j * b + (kSteps - i - j) * c) / kSteps);
    }
  }
  for (const BoundaryArc& arc : face.boundary) {
    for (int i = 0; i <= kSteps; ++i) {
      sample(face.curves[arc.curve].point(arc.from + (arc.to - arc.from) * i / kSteps));
    }
  }
  return largest;
}

}  // namespace spherule::internal
