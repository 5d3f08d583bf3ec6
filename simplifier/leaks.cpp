// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/leaks.h"

#include "base/error.h"
#include "geometry/triangle_mesh.h"
#include "geometry/weld.h"
#include "simplifier/proof/proof.h"
#include "simplifier/solid/cells.h"
#include "simplifier/solid/sphere_hierarchy.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
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

namespace {

using Eigen::Vector3d;
using internal::SphereHierarchy;
using internal::SurfacePiece;

// Pieces that are outside as a whole are left as large as this many spacings, where their depth is
// nearly linear: it is interpolated.
constexpr double kCoarse = 6.0;
// How far the depth may be from linear, in spacings.
constexpr double kNonlinearity = 0.25;
// No point of a triangle is further from the nearest corner than this share of its longest edge
// (1 / sqrt(3), where all edges are equal). A distance changes by no more than one moves.
constexpr double kReach = 0.578;

class LeakCollector {
 public:
  LeakCollector(const SphereHierarchy& spheres, double spacing)
      : spheres_(spheres), spacing_(spacing) {}

  void add_triangle(const SurfacePiece& triangle) {
    pieces_.assign(1, triangle);
    while (!pieces_.empty()) {
      const SurfacePiece piece = pieces_.back();
      pieces_.pop_back();
      add_piece(piece);
    }
  }

  LeakSurface take() { return std::move(surface_); }

 private:
  void add_piece(const SurfacePiece& piece) {
    std::array<double, 3> depths;
    for (std::size_t k = 0; k < 3; ++k) depths[k] = depth_at(piece.corner[k]);
    const std::size_t edge = internal::longest_edge(piece);
    const double size = (piece.corner[(edge + 1) % 3] - piece.corner[edge]).norm();
    const auto [least, most] = std::minmax_element(depths.begin(), depths.end());
    if (*most < -kReach * size) return;
    const bool is_small = size <= spacing_ ||
                          (size <= kCoarse * spacing_ && *least > 0.0 && is_linear(piece, depths));
    if (is_small) {
      add_outside(piece, depths);
    } else {
      internal::halve(piece, pieces_);
    }
  }

  // Whether the depth is nearly so at the middles of a piece that is outside at its corners.
  bool is_linear(const SurfacePiece& piece, const std::array<double, 3>& depths) const {
    const auto& [a, b, c] = piece.corner;
    const auto is_near = [&](const Vector3d& point, double depth) {
      const double exact = depth_at(point);
      return exact > 0.0 && std::abs(exact - depth) <= kNonlinearity * spacing_;
    };
    return is_near((a + b + c) / 3.0, (depths[0] + depths[1] + depths[2]) / 3.0) &&
           is_near((a + b) / 2.0, (depths[0] + depths[1]) / 2.0) &&
           is_near((b + c) / 2.0, (depths[1] + depths[2]) / 2.0) &&
           is_near((c + a) / 2.0, (depths[2] + depths[0]) / 2.0);
  }

  // What of a piece is outside, where depths are interpolated along its edges.
  void add_outside(const SurfacePiece& piece, const std::array<double, 3>& depths) {
    std::array<int, 4> outline;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      if (depths[k] > 0.0) outline[count++] = vertex(piece.corner[k], depths[k]);
      if ((depths[k] > 0.0) == (depths[next] > 0.0)) continue;
      // From the end outside, so that both triangles at an edge find the same point.
      const std::size_t outer = depths[k] > 0.0 ? k : next;
      const std::size_t inner = depths[k] > 0.0 ? next : k;
      const double share = depths[outer] / (depths[outer] - depths[inner]);
      const Vector3d run = piece.corner[inner] - piece.corner[outer];
      outline[count++] = vertex(piece.corner[outer] + share * run, 0.0);
    }
    for (std::size_t k = 2; k < count; ++k) {
      surface_.mesh.triangles.emplace_back(outline[0], outline[k - 1], outline[k]);
    }
  }

  int vertex(const Vector3d& point, double depth) {
    const auto [found, is_new] = indices_.try_emplace(
        {point.x(), point.y(), point.z()}, static_cast<int>(surface_.mesh.vertices.size()));
    if (is_new) {
      surface_.mesh.vertices.push_back(point);
      surface_.depths.push_back(depth);
    }
    return found->second;
  }

  double depth_at(const Vector3d& point) const { return spheres_.nearest(point).lower; }

  const SphereHierarchy& spheres_;
  double spacing_;
  std::vector<SurfacePiece> pieces_;
  std::map<std::array<double, 3>, int> indices_;
  LeakSurface surface_;
};

}  // namespace

LeakSurface leak_surface(const TriangleMesh& mesh, std::span<const Sphere> spheres,
                         const LeakSurfaceOptions& options) {
  validate(mesh, "mesh");
  internal::check_usable(spheres);
  if (!(options.spacing > 0.0) || !std::isfinite(options.spacing)) {
    throw Error("spacing", "must be positive and finite");
  }
  if (spheres.empty()) return {};
  const SphereHierarchy hierarchy(spheres);
  LeakCollector collector(hierarchy, options.spacing * internal::box_of(mesh).diagonal().norm());
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    collector.add_triangle({corners_of(mesh, triangle)});
  }
  return collector.take();
}

}  // namespace spherule
