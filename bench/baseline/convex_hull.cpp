// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "bench/baseline/mesh_methods.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <libqhull_r/libqhull_r.h>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

constexpr double kLeastExtent = 1e-60;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

// Triangles of qhull's hull, facing outwards, or none if it gives up. Points relative to a centre.
std::vector<Eigen::Vector3i> run_qhull(const Points& points, const char* options) {
  static_assert(sizeof(Vector3d) == 3 * sizeof(coordT));
  Points copy = points;  // qhull wants it writable
  const std::unique_ptr<std::FILE, CloseFile> sink(std::fopen("/dev/null", "w"));
  const auto state = std::make_unique<qhT>();
  qhT* qh = state.get();
  qh_zero(qh, sink.get());
  std::string command = std::string("qhull ") + options;
  const int failure = qh_new_qhull(qh, 3, static_cast<int>(copy.size()), copy.front().data(), False,
                                   command.data(), nullptr, sink.get());
  std::vector<Eigen::Vector3i> triangles;
  if (failure == 0) {
    facetT* facet;
    FORALLfacets {
      Eigen::Vector3i triangle;
      if (qh_setsize(qh, facet->vertices) != 3) break;
      for (int k = 0; k < 3; ++k) {
        const auto* vertex = static_cast<vertexT*>(facet->vertices->e[k].p);
        triangle[k] = qh_pointid(qh, vertex->point);
      }
      if (facet->toporient) std::swap(triangle[0], triangle[1]);
      triangles.push_back(triangle);
    }
  }
  qh_freeqhull(qh, !qh_ALL);
  int blocks = 0;
  int bytes = 0;
  qh_memfreeshort(qh, &blocks, &bytes);
  return triangles;
}

// Every edge once in either direction.
bool is_closed_manifold(const std::vector<Eigen::Vector3i>& triangles) {
  std::set<std::pair<int, int>> edges;
  for (const Eigen::Vector3i& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      if (!edges.emplace(t[k], t[(k + 1) % 3]).second) return false;
    }
  }
  return std::all_of(edges.begin(), edges.end(), [&](const std::pair<int, int>& edge) {
    return edges.contains({edge.second, edge.first});
  });
}

// Only the points that triangles use, in the order of their first use.
TriangleMesh compacted(const Points& points, const std::vector<Eigen::Vector3i>& triangles) {
  TriangleMesh mesh;
  std::map<int, int> index;
  for (const Eigen::Vector3i& t : triangles) {
    Eigen::Vector3i triangle;
    for (int k = 0; k < 3; ++k) {
      const auto [entry, is_new] = index.emplace(t[k], static_cast<int>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(points[static_cast<std::size_t>(t[k])]);
      triangle[k] = entry->second;
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

// The plane of a triangle, seen from a centre c: `normal` is (b - a) x (c - a), `anchor` is a - c.
// For a point p with q = p - c, all as computed, normal.(q - anchor) differs from the exact
// determinant of b - a, c - a, p - a by less than `slack`. Proof: let d bound |p - a|, |p - c| and
// |a - c|. Every product of three differences carries at most 7 roundings beyond those of q and
// anchor, whose components are off by at most u d each; the six products add up to at most
// (sqrt 3)^3 |b - a| |c - a| d. That makes 7 * 5.2 u + 4 * 5.2 u, below 64 u, of |b - a| |c - a| d;
// 128 u leaves room for terms of order u^2 and the rounding of the slack itself.
struct Plane {
  Plane(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& center, double d)
      : normal((b - a).cross(c - a)),
        anchor(a - center),
        slack(128.0 * kUnitRoundoff * (b - a).norm() * (c - a).norm() * d + 1e-290) {}

  Vector3d normal;
  Vector3d anchor;
  double slack;
};

class Expansion {
 public:
  Expansion(const Points& points, const ConvexHullOptions& options)
      : points_(points), padding_(options.padding), share_(options.max_expansion) {
    Eigen::AlignedBox3d box;
    for (const Vector3d& p : points) box.extend(p);
    extent_ = box.diagonal().norm();
  }

  // The hull of these triangles grown until it is proved to hold all points, if that takes little.
  std::optional<ConvexHull> operator()(const std::vector<Eigen::Vector3i>& triangles) {
    const TriangleMesh hull = compacted(points_, triangles);
    center_.setZero();
    for (const Vector3d& v : hull.vertices) {
      center_ += v / static_cast<double>(hull.vertices.size());
    }
    relative_.resize(3, static_cast<Eigen::Index>(points_.size()));
    for (std::size_t i = 0; i < points_.size(); ++i) {
      relative_.col(static_cast<Eigen::Index>(i)) = points_[i] - center_;
    }
    const double most = share_ * extent_ + 10.0 * padding_;
    double share = first_share(hull);
    for (int attempt = 0; attempt < 12; ++attempt, share *= 2.0) {
      ConvexHull result = expanded(hull, share);
      if (!(result.expansion <= most)) return std::nullopt;
      if (is_proved(result.mesh)) return result;
    }
    return std::nullopt;
  }

 private:
  Plane plane(const TriangleMesh& hull, const Eigen::Vector3i& t) const {
    const auto [a, b, c] = corners_of(hull, t);
    return {a, b, c, center_, 2.0 * extent_};
  }

  // How far beyond a plane a point stands at most, times the length of the normal.
  double farthest(const Plane& plane) const {
    double value = -std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < relative_.cols(); ++i) {
      value = std::max(value, plane.normal.dot(relative_.col(i) - plane.anchor));
    }
    return value;
  }

  // By how much c-to-vertex must grow so that every plane passes all points, as far as the planes
  // of the hull as it is can tell.
  double first_share(const TriangleMesh& hull) const {
    double largest = 0.0;
    for (const Vector3d& v : hull.vertices) largest = std::max(largest, v.cwiseAbs().maxCoeff());
    double share = 0.0;
    for (const Eigen::Vector3i& t : hull.triangles) {
      const Plane p = plane(hull, t);
      const double length = p.normal.norm();
      const double rounding = 4.0 * kUnitRoundoff * largest * length;
      const double need = std::max(0.0, farthest(p)) + 2.0 * p.slack + rounding + padding_ * length;
      share = std::max(share, need / p.normal.dot(p.anchor));
    }
    return share;
  }

  ConvexHull expanded(const TriangleMesh& hull, double share) const {
    ConvexHull result{.mesh = hull, .expansion = 0.0};
    for (Vector3d& v : result.mesh.vertices) {
      const Vector3d moved = v + share * (v - center_);
      result.expansion = std::max(result.expansion, distance_upper(v, moved));
      v = moved;
    }
    return result;
  }

  bool is_proved(const TriangleMesh& hull) const {
    return std::all_of(hull.triangles.begin(), hull.triangles.end(), [&](const auto& t) {
      const Plane p = plane(hull, t);
      // |normal| as computed is off by less than the slack over the extent.
      const double room = padding_ * (p.normal.norm() * kRelativeUp + p.slack / extent_);
      return p.normal.dot(p.anchor) > p.slack && farthest(p) < -(p.slack + room) * kRelativeUp;
    });
  }

  const Points& points_;
  double padding_;
  double share_;  // of the extent, for the expansion
  double extent_ = 0.0;
  Vector3d center_ = Vector3d::Zero();
  Eigen::Matrix3Xd relative_;
};

}  // namespace

int affine_dimension(std::span<const Vector3d> points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) box.extend(p);
  const double extent = points.empty() ? 0.0 : box.diagonal().norm();
  if (extent < kLeastExtent) return 0;
  // About another point than the mean, the axes of points in a plane need not lie in it.
  Vector3d center = Vector3d::Zero();
  for (const Vector3d& p : points) center += p / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points) {
    const Vector3d q = (p - center) / extent;
    scatter += q * q.transpose();
  }
  const Eigen::Matrix3d axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors();
  Eigen::AlignedBox3d along;
  for (const Vector3d& p : points) along.extend(Vector3d(axes.transpose() * (p - center)));
  return static_cast<int>((along.sizes().array() > kFlatShare * extent).count());
}

ConvexHull convex_hull(std::span<const Vector3d> points, const ConvexHullOptions& options,
                       const std::string& subject) {
  if (!(options.padding >= 0.0 && std::isfinite(options.padding))) {
    throw Error("padding", "must be finite and not negative");
  }
  if (!(options.max_expansion > 0.0)) throw Error("max expansion", "must be above zero");
  const auto less = [](const Vector3d& a, const Vector3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  Points distinct(points.begin(), points.end());
  std::sort(distinct.begin(), distinct.end(), less);
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  if (distinct.empty()) throw Error(subject, "has no vertices");
  const int dimension = affine_dimension(distinct);
  if (dimension < 3) {
    static const char* const kWhat[] = {"coincide", "lie on a line", "lie in a plane"};
    throw Error(subject, std::string("its vertices ") + kWhat[dimension] +
                             ": they have no convex hull with an inside");
  }

  // Small numbers about the centre, so that qhull's own tolerances fit.
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : distinct) box.extend(p);
  Points unit = distinct;
  for (Vector3d& p : unit) p = (p - box.center()) / box.diagonal().norm();
  Expansion expand(distinct, options);
  // Triangulated facets first. Where points that are almost in line make triangles too thin to be
  // grown, facets are merged over more and more of a bend, which leaves such points out of the
  // vertices; joggled input last.
  for (const char* way : {"Qt", "Qt C-1e-12", "Qt C-1e-10", "Qt C-1e-8", "QJ"}) {
    const std::vector<Eigen::Vector3i> triangles = run_qhull(unit, way);
    if (triangles.empty() || !is_closed_manifold(triangles)) continue;
    if (std::optional<ConvexHull> hull = expand(triangles)) return *std::move(hull);
  }
  throw Error(subject, "no convex hull could be proved: the vertices are too close to flat");
}

ConvexHull convex_hull(const TriangleMesh& mesh, const ConvexHullOptions& options) {
  validate(mesh, "mesh");
  Points used;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (const Vector3d& corner : corners_of(mesh, t)) used.push_back(corner);
  }
  return convex_hull(used, {options.padding + mesh.vertex_error, options.max_expansion}, "mesh");
}

}  // namespace spherule
