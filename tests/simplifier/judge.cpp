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

// Most comparisons are clear in double: differences, squares and sums of squares of what is given
// are right but for some 1e-16 of themselves. What is within this share is left to long double.
constexpr double kClear = 1e-12;

using Triangle = std::array<const Vector3d*, 3>;

Triangle triangle_of(const TriangleMesh& mesh, std::size_t i) {
  const auto vertex = [&](int k) {
    return &mesh.vertices[static_cast<std::size_t>(mesh.triangles[i][k])];
  };
  return {vertex(0), vertex(1), vertex(2)};
}

Real triangle_distance(const Vector3l& p, const Triangle& t) {
  return triangle_distance(p, std::array{wide(*t[0]), wide(*t[1]), wide(*t[2])});
}

// To the triangle's bounding box.
double squared_box_distance(const Vector3d& p, const Triangle& t) {
  const Vector3d low = t[0]->cwiseMin(*t[1]).cwiseMin(*t[2]);
  const Vector3d high = t[0]->cwiseMax(*t[1]).cwiseMax(*t[2]);
  return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
}

bool is_in_open_sphere(const Vector3d& p, const Sphere& sphere) {
  const double squared_distance = (p - sphere.center).squaredNorm();
  const double squared_radius = sphere.radius * sphere.radius;
  if (squared_distance > squared_radius * (1.0 + kClear)) return false;
  if (squared_distance < squared_radius * (1.0 - kClear)) return true;
  const Real radius = sphere.radius;
  return (wide(p) - wide(sphere.center)).squaredNorm() < radius * radius;
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
  for (const Sphere& s : spheres) {
    const auto least = static_cast<double>(gap);
    const double reach = least + s.radius + kClear * (std::abs(least) + s.radius);
    if (reach > 0.0 && (p - s.center).squaredNorm() > reach * reach * (1.0 + kClear)) continue;
    gap = std::min(gap, (q - wide(s.center)).norm() - s.radius);
  }
  return gap;
}

Real judged_mesh_distance(const Vector3d& p, const TriangleMesh& mesh) {
  const std::size_t count = mesh.triangles.size();
  if (count == 0) return std::numeric_limits<Real>::infinity();
  // The one whose box is nearest comes first: few of the others are then not clearly further.
  std::size_t first = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    const double squared_distance = squared_box_distance(p, triangle_of(mesh, i));
    if (squared_distance >= nearest) continue;
    nearest = squared_distance;
    first = i;
  }
  const Vector3l q = wide(p);
  Real best = triangle_distance(q, triangle_of(mesh, first));
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle triangle = triangle_of(mesh, i);
    const auto reach = static_cast<double>(best);
    if (squared_box_distance(p, triangle) > reach * reach * (1.0 + kClear)) continue;
    best = std::min(best, triangle_distance(q, triangle));
  }
  return best;
}

bool is_in_solid(const Vector3d& p, const ExternalSpheres& external) {
  if (!external.box.contains(p)) return false;
  return std::ranges::none_of(external.spheres,
                              [&](const Sphere& s) { return is_in_open_sphere(p, s); });
}

Real zone_distance(const ZoneShape& shape, const Vector3d& at) {
  const Vector3l p = at.cast<Real>();
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return std::max(0.0L, (p - sphere->center.cast<Real>()).norm() - sphere->radius);
  }
  if (const auto* box = std::get_if<Eigen::AlignedBox3d>(&shape)) {
    const Vector3l inside =
        p.cwiseMax(box->min().cast<Real>()).cwiseMin(box->max().cast<Real>()).eval();
    return (p - inside).norm();
  }
  const auto& capsule = std::get<ZoneCapsule>(shape);
  const Vector3l from = capsule.from.cast<Real>();
  const Vector3l way = capsule.to.cast<Real>() - from;
  const Real length = way.squaredNorm();
  const Real t = length > 0.0L ? std::clamp((p - from).dot(way) / length, 0.0L, 1.0L) : 0.0L;
  return std::max(0.0L, (p - from - t * way).norm() - capsule.radius);
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
