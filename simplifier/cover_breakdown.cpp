// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/cover_breakdown.h"

#include "base/threads.h"
#include "geometry/mesh_distance.h"
#include "geometry/weld.h"
#include "simplifier/concave_edges.h"
#include "simplifier/solid/cells.h"
#include "simplifier/solid/clearance.h"
#include "simplifier/solid/sphere_hierarchy.h"
#include "simplifier/stage2/cover_moves.h"
#include "simplifier/stage2/cover_problem.h"
#include "simplifier/stage2/solid_cells.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

// Shares of E.
constexpr double kEdgeSpacing = 0.25;
constexpr double kCells = 0.5;       // half diagonal of the cells that points stand for
constexpr double kOnBoundary = 0.1;  // depth of points of S that count as its boundary
constexpr double kBeyond = 0.1;      // beyond an edge of S there is nothing of it
constexpr double kThinReach = 2.0;
constexpr double kCube = 2.0;  // edge of the cubes that points are sorted into

constexpr std::size_t kMostPerEdge = 100000;

struct Edge {
  Vector3d from, to;
  std::vector<Vector3d> inward;  // of each face at it: from the edge into the face
};

using Corner = std::array<double, 3>;

// Corners count as one where their coordinates are equal.
std::vector<Edge> edges_of(const TriangleMesh& mesh) {
  std::map<std::pair<Corner, Corner>, Edge> edges;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const std::array<Vector3d, 3> corners = corners_of(mesh, t);
    for (std::size_t k = 0; k < 3; ++k) {
      Vector3d a = corners[k];
      Vector3d b = corners[(k + 1) % 3];
      const auto key = [](const Vector3d& p) { return Corner{p.x(), p.y(), p.z()}; };
      if (key(b) < key(a)) std::swap(a, b);
      const Vector3d along = (b - a).normalized();
      const Vector3d to_third = corners[(k + 2) % 3] - a;
      const Vector3d inward = to_third - along * along.dot(to_third);
      // Nothing can be said of a triangle without area.
      if (!(inward.norm() > 1e-9 * to_third.norm())) continue;
      Edge& edge = edges[{key(a), key(b)}];
      edge.from = a;
      edge.to = b;
      edge.inward.push_back(inward.normalized());
    }
  }
  std::vector<Edge> all;
  all.reserve(edges.size());
  for (auto& [key, edge] : edges) all.push_back(std::move(edge));
  return all;
}

// Points of sharp convex edges, at most one per cube of the spacing.
// `beyond_by`: how far beyond such an edge S must have ended.
Points edge_points(const TriangleMesh& mesh, const internal::Clearance& clearance, double max_error,
                   double beyond_by) {
  const double spacing = kEdgeSpacing * max_error;
  Points points;
  std::set<internal::Cube> taken;
  for (const Edge& edge : edges_of(mesh)) {
    Vector3d beyond = Vector3d::Zero();
    for (const Vector3d& inward : edge.inward) beyond -= inward;
    if (!(beyond.norm() > 1e-6)) continue;
    beyond.normalize();
    if (!std::ranges::all_of(edge.inward, [&](const Vector3d& in) {
          return in.dot(beyond) <= -internal::kCosineOfHalfSharp;
        })) {
      continue;
    }
    const double length = (edge.to - edge.from).norm();
    const auto steps = static_cast<std::size_t>(
        std::clamp(std::ceil(length / spacing), 1.0, static_cast<double>(kMostPerEdge)));
    for (std::size_t i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(steps);
      const Vector3d p = edge.from + share * (edge.to - edge.from);
      if (!taken.insert(internal::cube_of(p, 0.5 * spacing)).second) continue;
      if (clearance(p + beyond_by * beyond).upper < 0.0) points.push_back(p);
    }
  }
  return points;
}

Points boundary_points(const internal::SolidCells& cells, const internal::Clearance& clearance,
                       double max_error) {
  const Points sample = cells.sample();
  std::vector<char> outer(sample.size());
  internal::parallel_for(0, sample.size(), [&](std::size_t i) {
    outer[i] = clearance(sample[i]).lower <= kOnBoundary * max_error ? 1 : 0;
  });
  Points points;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    if (outer[i] != 0) points.push_back(sample[i]);
  }
  return points;
}

// For each sphere whether it is the only one that covers some of the points.
std::vector<char> alone_at(const Points& points, std::span<const Sphere> spheres,
                           double max_error) {
  const internal::PointGrid grid(points, kCube * max_error);
  std::vector<std::vector<std::uint32_t>> held(spheres.size());
  internal::parallel_for(0, spheres.size(), [&](std::size_t i) {
    grid.find(spheres[i].center, spheres[i].radius, held[i]);
  });
  std::vector<std::uint32_t> times(points.size(), 0);
  for (const auto& some : held) {
    for (const std::uint32_t p : some) ++times[p];
  }
  std::vector<char> alone(spheres.size(), 0);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    alone[i] = std::ranges::any_of(held[i], [&](std::uint32_t p) { return times[p] == 1; }) ? 1 : 0;
  }
  return alone;
}

bool is_thin_at(const internal::Clearance& clearance, const Vector3d& center, double max_error) {
  const internal::ClearanceAt at = clearance(center);
  if (at.lower > kThinReach * max_error) return false;
  for (const double reach : {0.25, 0.5, 0.75, 1.0}) {
    const Vector3d other = center + reach * kThinReach * max_error * at.away;
    if (clearance(other).upper < 0.0) return true;
  }
  return false;
}

}  // namespace

CoverBreakdown cover_breakdown(const TriangleMesh& mesh, const ExternalSpheres& external,
                               std::span<const Sphere> spheres, double max_error, int threads) {
  validate(mesh, "mesh");
  internal::check_external(external);
  internal::check_usable(spheres);
  internal::check_max_error(max_error);
  const internal::ThreadLimit limit(threads);
  const MeshDistance distance(mesh);
  const internal::Clearance clearance(external);
  const internal::LocalError error(max_error, {});
  const internal::SolidCells cells(clearance, distance, error, max_error, kCells, 1.0);
  // S holds M grown by the padding, and of that the box has the corners.
  const double beyond_by = kBeyond * max_error + 2.0 * external.padding;
  const std::vector<char> at_edge =
      alone_at(edge_points(mesh, clearance, max_error, beyond_by), spheres, max_error);
  const std::vector<char> at_boundary =
      alone_at(boundary_points(cells, clearance, max_error), spheres, max_error);
  CoverBreakdown result;
  result.roles.resize(spheres.size());
  internal::parallel_for(0, spheres.size(), [&](std::size_t i) {
    SphereRole& role = result.roles[i];
    if (at_edge[i] != 0) {
      role = SphereRole::kEdge;
    } else if (at_boundary[i] == 0) {
      role = SphereRole::kInside;
    } else {
      role = is_thin_at(clearance, spheres[i].center, max_error) ? SphereRole::kThin
                                                                 : SphereRole::kFace;
    }
  });
  const auto count = [&](SphereRole role) {
    return static_cast<std::size_t>(std::ranges::count(result.roles, role));
  };
  result.edges = count(SphereRole::kEdge);
  result.thin = count(SphereRole::kThin);
  result.faces = count(SphereRole::kFace);
  result.inside = count(SphereRole::kInside);
  return result;
}

std::size_t spheres_in_thin_parts(const ExternalSpheres& external, std::span<const Sphere> spheres,
                                  double max_error) {
  internal::check_external(external);
  internal::check_usable(spheres);
  internal::check_max_error(max_error);
  const internal::Clearance clearance(external);
  return static_cast<std::size_t>(std::ranges::count_if(
      spheres, [&](const Sphere& sphere) { return clearance(sphere.center).upper < max_error; }));
}

}  // namespace spherule
