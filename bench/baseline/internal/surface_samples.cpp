// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/internal/surface_samples.h"

#include "base/error.h"
#include "base/random.h"
#include "geometry/surface_sampling.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

bool comes_before(const Vector3d& a, const Vector3d& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

// An edge as one triangle has it.
struct Edge {
  Vector3d low, high;  // its ends in the order of comes_before
  Vector3d normal;     // of the triangle; zero if it has none
};

constexpr double kFlat = 0.95;  // cosine of the angle between normals

}  // namespace

double total_area(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) area += area_of(corners_of(mesh, t));
  return area;
}

std::vector<Vector3d> even_samples(const TriangleMesh& mesh, std::size_t count,
                                   std::size_t per_triangle, std::uint64_t seed) {
  const double area = total_area(mesh);
  std::vector<Vector3d> points;
  if (!(area > 0.0)) return points;
  Random random(seed);
  double due = random.unit();  // samples that triangles too small for a whole one have saved up
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const std::array<Vector3d, 3> t = corners_of(mesh, triangle);
    const double share = area_of(t) / area * static_cast<double>(count);
    if (!(share > 0.0)) continue;
    due += share;
    const double whole = std::floor(due);
    due -= whole;
    const std::size_t here = std::max(per_triangle, static_cast<std::size_t>(whole));
    const double start_u = random.unit();
    const double start_v = random.unit();
    for (std::size_t i = 0; i < here; ++i) {
      points.push_back(evenly_in(t, static_cast<double>(i + 1), {start_u, start_v}));
    }
  }
  return points;
}

std::vector<Vector3d> edge_samples(const TriangleMesh& mesh, std::size_t count) {
  const double spacing = std::sqrt(total_area(mesh) / static_cast<double>(count));
  std::vector<Vector3d> points;
  std::vector<Edge> edges;
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const std::array<Vector3d, 3> t = corners_of(mesh, triangle);
    const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      points.push_back(t[k]);
      const Vector3d& next = t[(k + 1) % 3];
      edges.push_back(
          {std::min(t[k], next, comes_before), std::max(t[k], next, comes_before), normal});
    }
  }
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.low != b.low ? comes_before(a.low, b.low) : comes_before(a.high, b.high);
  });
  for (auto begin = edges.begin(); begin != edges.end();) {
    const auto end = std::find_if(begin, edges.end(), [&](const Edge& e) {
      return e.low != begin->low || e.high != begin->high;
    });
    const Vector3d ends[] = {begin->low, begin->high};
    const bool is_flat = end - begin == 2 && begin->normal.dot(std::next(begin)->normal) > kFlat;
    begin = end;
    if (is_flat || !(spacing > 0.0)) continue;
    const double pieces =
        std::floor(std::min((ends[1] - ends[0]).norm() / spacing, static_cast<double>(count)));
    for (double i = 1.0; i < pieces; i += 1.0) {
      points.push_back(ends[0] + (i / pieces) * (ends[1] - ends[0]));
    }
  }
  std::sort(points.begin(), points.end(), comes_before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

std::vector<Vector3d> cover_samples(const TriangleMesh& mesh, std::size_t count,
                                    std::size_t per_triangle, std::uint64_t seed) {
  std::vector<Vector3d> points = even_samples(mesh, count, per_triangle, seed);
  if (points.empty()) throw Error("mesh", "has no area");
  const std::vector<Vector3d> edges = edge_samples(mesh, count);
  points.insert(points.end(), edges.begin(), edges.end());
  return points;
}

}  // namespace spherule::internal
