// SPDX-License-Identifier: BSD-3-Clause
#include "tests/simplifier/judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using Vector3l = Eigen::Matrix<Real, 3, 1>;

Vector3l wide(const Vector3d& v) {
  return v.cast<Real>();
}

Real segment_distance(const Vector3l& p, const Vector3l& a, const Vector3l& b) {
  const Vector3l ab = b - a;
  const Real length_squared = ab.squaredNorm();
  if (!(length_squared > 0.0L)) return (p - a).norm();
  const Real t = std::clamp((p - a).dot(ab) / length_squared, 0.0L, 1.0L);
  return (p - a - t * ab).norm();
}

Real triangle_distance(const Vector3l& p, const std::array<Vector3l, 3>& t) {
  Real best = std::numeric_limits<Real>::infinity();
  const Vector3l normal = (t[1] - t[0]).cross(t[2] - t[0]);
  bool above = normal.squaredNorm() > 0.0L;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3l& from = t[k];
    const Vector3l& to = t[(k + 1) % 3];
    best = std::min(best, segment_distance(p, from, to));
    above = above && normal.cross(to - from).dot(p - from) >= 0.0L;
  }
  return above ? std::min(best, std::abs(normal.dot(p - t[0])) / normal.norm()) : best;
}

// By the triangle's bounding box, which takes a tenth of the time of the distance.
bool surely_further(const Vector3l& p, const std::array<Vector3l, 3>& triangle, Real distance) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
    if (low - p[axis] > distance || p[axis] - high > distance) return true;
  }
  return false;
}

bool is_in_open_sphere(const Vector3l& p, const Sphere& sphere) {
  const Real radius = sphere.radius;
  return (p - wide(sphere.center)).squaredNorm() < radius * radius;
}

// Points on the way from a point of the sphere to its centre are tried at these shares of the
// error.
constexpr std::array kShares{0.0, 0.25, 0.5, 0.75, 0.9, 1.0};

}  // namespace

Real judged_distance(const Vector3d& a, const Vector3d& b) {
  return (wide(a) - wide(b)).norm();
}

Real gap_to_spheres(const Vector3d& p, std::span<const Sphere> spheres) {
  const Vector3l q = wide(p);
  Real gap = std::numeric_limits<Real>::infinity();
  for (const Sphere& s : spheres) gap = std::min(gap, (q - wide(s.center)).norm() - s.radius);
  return gap;
}

Real judged_mesh_distance(const Vector3d& p, const TriangleMesh& mesh) {
  const Vector3l q = wide(p);
  Real best = std::numeric_limits<Real>::infinity();
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto vertex = [&](int k) { return wide(mesh.vertices[static_cast<std::size_t>(t[k])]); };
    const std::array<Vector3l, 3> triangle{vertex(0), vertex(1), vertex(2)};
    if (surely_further(q, triangle, best)) continue;
    best = std::min(best, triangle_distance(q, triangle));
  }
  return best;
}

bool is_in_solid(const Vector3d& p, const ExternalSpheres& external) {
  if (!external.box.contains(p)) return false;
  const Vector3l q = wide(p);
  return std::ranges::none_of(external.spheres,
                              [&](const Sphere& s) { return is_in_open_sphere(q, s); });
}

std::vector<Vector3d> points_on_surface(const TriangleMesh& mesh, std::size_t count,
                                        Random& random) {
  std::vector<double> areas;
  double total = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto vertex = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    areas.push_back((vertex(1) - vertex(0)).cross(vertex(2) - vertex(0)).norm());
    total += areas.back();
  }
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    const auto vertex = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k % 3])]; };
    for (int k = 0; k < 3; ++k) {
      points.push_back(vertex(k));
      points.push_back(vertex(k) + random.unit() * (vertex(k + 1) - vertex(k)));
    }
    const double share = total > 0.0 ? areas[i] / total : 0.0;
    const auto inner = 1 + static_cast<std::size_t>(share * static_cast<double>(count));
    for (std::size_t n = 0; n < inner; ++n) {
      const double u = random.unit();
      const double v = random.unit();
      const bool flip = u + v > 1.0;
      points.push_back(vertex(0) + (flip ? 1.0 - u : u) * (vertex(1) - vertex(0)) +
                       (flip ? 1.0 - v : v) * (vertex(2) - vertex(0)));
    }
  }
  return points;
}

std::vector<Vector3d> points_of_solid(const ExternalSpheres& external, std::size_t count,
                                      Random& random) {
  std::vector<Vector3d> points;
  const auto keep = [&](const Vector3d& p) {
    if (is_in_solid(p, external)) points.push_back(p);
  };
  // A thin solid is met seldom.
  for (std::size_t i = 0; i < 8 * count && points.size() < count; ++i) {
    Vector3d p = random.in_box(external.box);
    switch (random.index(4)) {
      case 0:
        break;
      case 1: {
        const auto axis = static_cast<int>(random.index(3));
        p[axis] = random.index(2) == 0 ? external.box.min()[axis] : external.box.max()[axis];
        break;
      }
      default:
        if (external.spheres.empty()) break;
        const Sphere& sphere = external.spheres[random.index(external.spheres.size())];
        p = sphere.center + sphere.radius * (1.0 + 1e-12) * random.direction();
        break;
    }
    keep(p);
  }
  return points;
}

Judgement judge_cover(std::span<const Vector3d> points, std::span<const Sphere> spheres) {
  Judgement judgement;
  judgement.points = points.size();
  for (const Vector3d& p : points) {
    const Real gap = gap_to_spheres(p, spheres);
    if (gap > 0.0L) ++judgement.uncovered;
    if (gap > judgement.depth) {
      judgement.depth = gap;
      judgement.deepest = p;
    }
  }
  return judgement;
}

ProtrusionJudgement judge_protrusion(std::span<const Sphere> spheres, const TriangleMesh& mesh,
                                     const ExternalSpheres& external, double max_error,
                                     std::size_t per_sphere, Random& random) {
  ProtrusionJudgement judgement;
  for (const Sphere& sphere : spheres) {
    for (std::size_t i = 0; i < per_sphere; ++i) {
      const Vector3d direction = random.direction();
      const Vector3d y = sphere.center + sphere.radius * direction;
      ++judgement.points;
      const auto is_in_solid_further_in = [&](double share) {
        const double way = std::min(share * max_error, sphere.radius);
        return is_in_solid(sphere.center + (sphere.radius - way) * direction, external);
      };
      if (std::ranges::any_of(kShares, is_in_solid_further_in)) continue;
      if (judged_mesh_distance(y, mesh) <= max_error) continue;
      ++judgement.beyond;
      judgement.example = y;
    }
  }
  return judgement;
}

}  // namespace spherule::test
