// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/baseline/mesh_methods.h"
#include "geometry/triangle_mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <hacdHACD.h>
#include <set>

namespace spherule {
namespace {

using Eigen::Vector3d;

constexpr double kDefaultConcavity = 0.01;  // share of the box diagonal
constexpr double kPlate = 1e-4;             // share of the box diagonal
// Parts are long and thin, and far from exact anyway.
constexpr double kHullExpansion = 1e-3;
constexpr double kLibraryExtent = 1000.0;  // the size for which HACD's constants are made
constexpr std::size_t kNoPart = static_cast<std::size_t>(-1);

void check(const ConvexDecompositionOptions& options) {
  if (!(options.max_concavity >= 0.0 && std::isfinite(options.max_concavity))) {
    throw Error("max concavity", "must be finite and not negative");
  }
  if (options.min_parts < 1) throw Error("min parts", "must be positive");
}

// Triangles that HACD can take: with an area, and once each.
std::vector<std::size_t> sound_triangles(const TriangleMesh& mesh) {
  std::vector<std::size_t> sound;
  std::set<std::array<int, 3>> seen;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    const auto [a, b, c] = corners_of(mesh, t);
    const Vector3d ab = b - a;
    const Vector3d ac = c - a;
    std::array<int, 3> key = {t[0], t[1], t[2]};
    std::sort(key.begin(), key.end());
    if (!(ab.cross(ac).norm() > 1e-12 * ab.norm() * ac.norm()) || !seen.insert(key).second)
      continue;
    sound.push_back(i);
  }
  return sound;
}

// The part of every triangle of `mesh`, kNoPart for those that are not sound.
std::vector<std::size_t> cluster(const TriangleMesh& mesh, const Eigen::AlignedBox3d& box,
                                 double max_concavity, int min_parts) {
  const double scale = kLibraryExtent / box.diagonal().norm();
  std::vector<HACD::Vec3<HACD::Real>> points;
  for (const Vector3d& v : mesh.vertices) {
    const Vector3d p = scale * (v - box.center());
    points.emplace_back(p.x(), p.y(), p.z());
  }
  const std::vector<std::size_t> sound = sound_triangles(mesh);
  if (sound.empty()) throw Error("mesh", "has no triangle with an area");
  std::vector<HACD::Vec3<long>> triangles;
  for (const std::size_t i : sound) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    triangles.emplace_back(t[0], t[1], t[2]);
  }
  HACD::HACD hacd;
  hacd.SetPoints(points.data());
  hacd.SetNPoints(points.size());
  hacd.SetTriangles(triangles.data());
  hacd.SetNTriangles(triangles.size());
  hacd.SetCompacityWeight(1e-4);
  hacd.SetVolumeWeight(0.0);
  hacd.SetConnectDist(0.0);
  hacd.SetConcavity(scale * max_concavity);
  hacd.SetNClusters(std::min(static_cast<std::size_t>(min_parts), triangles.size()));
  hacd.SetAddExtraDistPoints(true);
  hacd.SetAddNeighboursDistPoints(true);
  hacd.SetAddFacesPoints(true);
  hacd.Compute(true);
  std::vector<std::size_t> part(mesh.triangles.size(), kNoPart);
  for (std::size_t k = 0; k < sound.size(); ++k) {
    part[sound[k]] = static_cast<std::size_t>(hacd.GetPartition()[k]);
  }
  return part;
}

// Sends every triangle without a part to that of a triangle with which it shares a vertex, or else
// to the first.
void adopt(const TriangleMesh& mesh, std::vector<std::size_t>& part) {
  std::vector<std::size_t> part_of_vertex(mesh.vertices.size(), kNoPart);
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (part[i] == kNoPart) continue;
    for (const int v : mesh.triangles[i]) part_of_vertex[static_cast<std::size_t>(v)] = part[i];
  }
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (part[i] != kNoPart) continue;
    part[i] = 0;
    for (const int v : mesh.triangles[i]) {
      const std::size_t candidate = part_of_vertex[static_cast<std::size_t>(v)];
      if (candidate != kNoPart) part[i] = candidate;
    }
  }
}

// Points flat as they are, with a small octahedron about each.
std::vector<Vector3d> plate(const std::vector<Vector3d>& points, double half_thickness) {
  std::vector<Vector3d> inflated;
  for (const Vector3d& p : points) {
    for (int axis = 0; axis < 3; ++axis) {
      inflated.push_back(p + half_thickness * Vector3d::Unit(axis));
      inflated.push_back(p - half_thickness * Vector3d::Unit(axis));
    }
  }
  return inflated;
}

}  // namespace

TriangleMesh join_parts(const std::vector<TriangleMesh>& parts) {
  TriangleMesh all;
  for (const TriangleMesh& part : parts) {
    const auto first = static_cast<int>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const Eigen::Vector3i& t : part.triangles) {
      all.triangles.emplace_back(t.array() + first);
    }
  }
  return all;
}

ConvexDecomposition decompose(const TriangleMesh& mesh, const ConvexDecompositionOptions& options) {
  validate(mesh, "mesh");
  check(options);
  const Eigen::AlignedBox3d box = internal::box_of(mesh);
  const double diagonal = box.diagonal().norm();
  const double concavity =
      options.max_concavity > 0.0 ? options.max_concavity : kDefaultConcavity * diagonal;
  std::vector<std::size_t> part = cluster(mesh, box, concavity, options.min_parts);
  adopt(mesh, part);

  std::vector<std::vector<Vector3d>> points(*std::max_element(part.begin(), part.end()) + 1);
  for (std::size_t i = 0; i < part.size(); ++i) {
    for (const Vector3d& corner : corners_of(mesh, mesh.triangles[i])) {
      points[part[i]].push_back(corner);
    }
  }
  ConvexDecomposition result;
  for (std::vector<Vector3d>& cloud : points) {
    if (cloud.empty()) continue;
    if (affine_dimension(cloud) < 3) cloud = plate(cloud, kPlate * diagonal);
    const ConvexHull hull =
        convex_hull(cloud, {mesh.vertex_error, kHullExpansion}, "part of the mesh");
    result.volume += mesh_report(hull.mesh, {.self_intersections = false}).volume;
    result.parts.push_back(hull.mesh);
  }
  if (options.measure) {
    result.deviation = measure_deviation(mesh, join_parts(result.parts), *options.measure);
  }
  return result;
}

}  // namespace spherule
