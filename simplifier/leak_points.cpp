// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/leak_points.h"

#include "mesh/geometry/mesh_box.h"
#include "mesh/geometry/point_grid.h"
#include "simplifier/proof/surface_piece.h"
#include "simplifier/solid/box_cell.h"
#include "simplifier/solid/sphere_hierarchy.h"
#include "simplifier/support/usable_spheres.h"
#include "spheretree/error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace spherule {
namespace {

using Eigen::Vector3d;
using internal::SphereHierarchy;
using internal::SurfacePiece;

// Of the largest coordinate. Far smaller pieces could not be halved, for rounding.
constexpr double kLeastSpacing = 0x1p-40;

void check_share(double share, const std::string& name) {
  if (!(share > 0.0) || !std::isfinite(share)) throw Error(name, "must be positive and finite");
}

class Sampler {
 public:
  Sampler(const SphereHierarchy& spheres, double spacing) : spheres_(spheres), spacing_(spacing) {}

  void add_point(const Vector3d& point) {
    const double depth = spheres_.nearest(point).lower;
    if (depth > 0.0) found_.push_back({point, depth});
  }

  // Examines the middle of every piece with edges up to the spacing, but for those so deep in a
  // sphere that all of the piece is in it.
  void add_triangle(const SurfacePiece& triangle) {
    pieces_.assign(1, triangle);
    while (!pieces_.empty()) {
      const SurfacePiece piece = pieces_.back();
      pieces_.pop_back();
      const auto& [a, b, c] = piece.corner;
      const Vector3d middle = (a + b + c) / 3.0;
      const std::size_t edge = internal::longest_edge(piece);
      const double size = (piece.corner[(edge + 1) % 3] - piece.corner[edge]).norm();
      const double depth = spheres_.nearest(middle).lower;
      if (depth < -size) continue;
      if (size > spacing_) {
        internal::halve(piece, pieces_);
      } else if (depth > 0.0) {
        found_.push_back({middle, depth});
      }
    }
  }

  std::vector<LeakPoint> take() { return std::move(found_); }

 private:
  const SphereHierarchy& spheres_;
  double spacing_;
  std::vector<SurfacePiece> pieces_;
  std::vector<LeakPoint> found_;
};

// The deepest of them, each further than `separation` from those before.
std::vector<LeakPoint> deepest(std::vector<LeakPoint> points, double separation,
                               std::size_t max_count) {
  std::stable_sort(points.begin(), points.end(),
                   [](const LeakPoint& a, const LeakPoint& b) { return a.depth > b.depth; });
  std::vector<Vector3d> places;
  for (const LeakPoint& leak : points) places.push_back(leak.point);
  const internal::PointGrid grid(places, separation);
  std::vector<char> dropped(points.size(), 0);
  std::vector<LeakPoint> kept;
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < points.size() && kept.size() < max_count; ++i) {
    if (dropped[i]) continue;
    kept.push_back(points[i]);
    near.clear();
    grid.find(points[i].point, separation, near);
    for (const std::uint32_t other : near) dropped[other] = 1;
  }
  return kept;
}

}  // namespace

std::vector<LeakPoint> leak_points(const TriangleMesh& mesh, std::span<const Sphere> spheres,
                                   const LeakPointOptions& options) {
  validate(mesh, "mesh");
  internal::check_usable(spheres);
  check_share(options.spacing, "spacing");
  check_share(options.separation, "separation");
  if (spheres.empty()) return {};
  const Eigen::AlignedBox3d box = internal::box_of(mesh);
  const double size = box.diagonal().norm();
  const SphereHierarchy hierarchy(spheres);
  Sampler sampler(hierarchy, std::max(options.spacing * size,
                                      kLeastSpacing * internal::largest_coordinate(box)));
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const SurfacePiece piece{corners_of(mesh, triangle)};
    for (const Vector3d& corner : piece.corner) sampler.add_point(corner);
    sampler.add_triangle(piece);
  }
  return deepest(sampler.take(), options.separation * size, options.max_count);
}

}  // namespace spherule
