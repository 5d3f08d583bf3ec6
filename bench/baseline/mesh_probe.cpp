// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/random.h"
#include "bench/baseline/medial_spheres.h"
#include "geometry/median_split.h"
#include "geometry/surface_sampling.h"
#include "geometry/triangles.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr std::int32_t kLeafSize = 8;
// A group is taken as one from this many times its reach on; its error there is some thousandths.
constexpr double kFar = 3.0;

}  // namespace

MeshProbe::MeshProbe(const TriangleMesh& mesh) : distance_(mesh) {
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto [a, b, c] = corners_of(mesh, t);
    corners_.push_back({a, b, c});
  }
  build(0, static_cast<std::int32_t>(corners_.size()));
}

void MeshProbe::build(std::int32_t begin, std::int32_t end) {
  const std::size_t self = nodes_.size();
  Node node;
  node.begin = begin;
  node.end = end;
  Eigen::AlignedBox3d box;
  const auto part = std::span(corners_).subspan(static_cast<std::size_t>(begin),
                                                static_cast<std::size_t>(end - begin));
  for (const Corners& t : part) {
    for (const Vector3d& p : {t.a, t.b, t.c}) box.extend(p);
    node.area += 0.5 * (t.b - t.a).cross(t.c - t.a);
  }
  node.center = box.center();
  for (const Corners& t : part) {
    for (const Vector3d& p : {t.a, t.b, t.c}) {
      node.reach = std::max(node.reach, (p - node.center).norm());
    }
  }
  nodes_.push_back(node);
  if (end - begin <= kLeafSize) return;
  const Eigen::Index axis = longest_axis(box);
  const auto key = [axis](const Corners& t) { return t.a[axis] + t.b[axis] + t.c[axis]; };
  const std::int32_t middle = begin + static_cast<std::int32_t>(split_at_median(part, key));
  build(begin, middle);
  nodes_[self].right = static_cast<std::int32_t>(nodes_.size());
  build(middle, end);
}

double MeshProbe::solid_angle_of(std::int32_t index, const Vector3d& point) const {
  const Node& node = nodes_[static_cast<std::size_t>(index)];
  const Vector3d to = node.center - point;
  const double away = to.norm();
  if (away > kFar * node.reach) return node.area.dot(to) / (away * away * away);
  if (node.right >= 0) {
    return solid_angle_of(index + 1, point) + solid_angle_of(node.right, point);
  }
  double angle = 0.0;
  for (std::int32_t i = node.begin; i < node.end; ++i) {
    const Corners& t = corners_[static_cast<std::size_t>(i)];
    angle += solid_angle(t.a - point, t.b - point, t.c - point);
  }
  return angle;
}

bool MeshProbe::is_inside(const Vector3d& point) const {
  if (!distance_.box().contains(point)) return false;
  return std::abs(solid_angle_of(0, point)) > 2.0 * std::numbers::pi;
}

double MeshProbe::clearance(const Vector3d& point) const {
  const SurfaceDistance d = distance_(point);
  return is_inside(point) ? d.lower : -d.upper;
}

using Eigen::Vector3d;

double SimplifiedProbe::clearance(const Vector3d& point) const {
  const ClearanceAt at = clearance_(point);
  if (at.upper >= 0.0) return at.lower;
  // Out of a single sphere a point of S is as far as its surface; of several, the mesh is in S.
  const double way = -1.01 * at.lower;
  if (clearance_(point + way * at.away, way).lower >= 0.0) return -way;
  return -distance_(point).upper;
}

Vector3d SimplifiedProbe::nearest_boundary(const Vector3d& point) const {
  const ClearanceAt at = clearance_(point);
  return point - at.upper * at.away;
}

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
