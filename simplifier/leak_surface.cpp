// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/leak_surface.h"

#include "mesh/geometry/mesh_box.h"
#include "simplifier/proof/surface_piece.h"
#include "simplifier/solid/sphere_hierarchy.h"
#include "simplifier/support/usable_spheres.h"
#include "spheretree/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>

namespace spherule {
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
