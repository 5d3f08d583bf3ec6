// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/baseline/mesh_methods.h"
#include "geometry/mesh_distance.h"
#include "geometry/point_triangle.h"
#include "geometry/shells.h"
#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <vector>

namespace spherule {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

// Distance to the solid of a mesh.
class SolidDistance {
 public:
  explicit SolidDistance(const TriangleMesh& mesh)
      : mesh_(mesh), surface_(mesh), shells_(mesh, surface_) {}

  SurfaceDistance to_surface(const Eigen::Vector3d& point) const { return surface_(point); }
  bool is_inside(const Eigen::Vector3d& point) const {
    return shells_.is_mesh_closed() && shells_.contain(point);
  }
  // No point of the piece is farther from that triangle: distance to a convex set is convex, so its
  // maximum stands at a corner.
  double to_triangle(const Corners& piece, std::int32_t triangle) const {
    const auto [a, b, c] = corners_of(mesh_, mesh_.triangles[static_cast<std::size_t>(triangle)]);
    double farthest = 0.0;
    for (const Eigen::Vector3d& corner : piece) {
      farthest = std::max(farthest, point_triangle_distance(corner, a, b, c).upper);
    }
    return farthest;
  }

 private:
  const TriangleMesh& mesh_;
  MeshDistance surface_;
  internal::ClosedShells shells_;
};

// A piece of surface, and what no point of it is farther away than.
struct Piece {
  Corners corners;
  double bound;
  bool operator<(const Piece& other) const { return bound < other.bound; }
};

class FarthestPoint {
 public:
  FarthestPoint(const SolidDistance& solid, double tolerance, std::size_t most_pieces)
      : solid_(solid), tolerance_(tolerance), pieces_left_(most_pieces) {}

  void add(const Corners& corners) {
    if (pieces_left_ > 0) --pieces_left_;
    const Eigen::Vector3d middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    double radius = 0.0;
    for (const Eigen::Vector3d& corner : corners) {
      radius = std::max(radius, (corner - middle).norm());
    }
    const SurfaceDistance nearest = solid_.to_surface(middle);
    const double distance = nearest.upper;
    const double bound = std::min(distance + radius, solid_.to_triangle(corners, nearest.triangle));
    if (bound <= found_ + tolerance_) {  // wherever the middle is
      dropped_ = std::max(dropped_, bound);
      return;
    }
    // Tested only where the answer tells much: it takes a test of every triangle.
    if (distance > std::min(found_ + tolerance_ / 2.0, radius)) {
      const bool inside = solid_.is_inside(middle);
      // A sphere about the middle that intersects no surface is inside as a whole.
      if (inside && distance > radius) return;
      if (!inside) found_ = std::max(found_, distance);
    }
    pieces_.push({corners, bound});
  }

  Bounds search() {
    while (!pieces_.empty() && pieces_.top().bound > found_ + tolerance_ && pieces_left_ > 0) {
      const auto [a, b, c] = pieces_.top().corners;
      pieces_.pop();
      const Eigen::Vector3d ab = (a + b) / 2.0, bc = (b + c) / 2.0, ca = (c + a) / 2.0;
      add({a, ab, ca});
      add({b, bc, ab});
      add({c, ca, bc});
      add({ab, bc, ca});
    }
    const double left = pieces_.empty() ? 0.0 : pieces_.top().bound;
    return {found_, std::max({found_, left, dropped_})};
  }

  // A point of the surface, so that `found` starts high.
  void probe(const Eigen::Vector3d& point) {
    const double distance = solid_.to_surface(point).upper;
    if (distance > found_ && !solid_.is_inside(point)) found_ = distance;
  }

 private:
  const SolidDistance& solid_;
  double tolerance_;
  std::size_t pieces_left_;
  double found_ = 0.0;
  double dropped_ = 0.0;
  std::priority_queue<Piece> pieces_;
};

Bounds farthest(const TriangleMesh& from, const SolidDistance& solid, double tolerance,
                std::size_t most_pieces) {
  FarthestPoint search(solid, tolerance, most_pieces);
  for (const Eigen::Vector3i& triangle : from.triangles) {
    for (const Eigen::Vector3d& corner : corners_of(from, triangle)) search.probe(corner);
  }
  for (const Eigen::Vector3i& triangle : from.triangles) search.add(corners_of(from, triangle));
  return search.search();
}

}  // namespace

MeshDeviation measure_deviation(const TriangleMesh& original, const TriangleMesh& other,
                                const DeviationOptions& options) {
  validate(original, "original mesh");
  validate(other, "other mesh");
  if (!(options.tolerance >= 1e-6 && options.tolerance <= 1.0)) {
    throw Error("tolerance", "must be from 1e-6 to 1");
  }
  const Eigen::AlignedBox3d box = internal::box_of(original).merged(internal::box_of(other));
  const double tolerance = options.tolerance * box.diagonal().norm();
  MeshDeviation deviation;
  deviation.loss = farthest(original, SolidDistance(other), tolerance, options.most_pieces);
  deviation.excess = farthest(other, SolidDistance(original), tolerance, options.most_pieces);
  return deviation;
}

}  // namespace spherule
