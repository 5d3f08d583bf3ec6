// SPDX-License-Identifier: BSD-3-Clause
#include "collide/solids/solid_spheres.h"

#include "collide/search/one_tree.h"
#include "collide/solids/mesh_inside.h"
#include "collide/solids/spheres_inside.h"
#include "spheretree/build.h"
#include "spheretree/moved_from.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Cells at the surface are split down to this part of the mean radius of the triangles' spheres, as
// long as there are not more of them than so many for each triangle.
constexpr double kSmallestCell = 1.0;
constexpr std::size_t kCellsATriangle = 4;
constexpr std::size_t kFewestCells = 512;
constexpr int kMostLevels = 12;

struct Cell {
  Vector3d center;
  double half;

  // Halves are powers of two of the first one, but centres err by a few units in the last place.
  Sphere sphere() const {
    return {center, half * 1.7320508075688774 * (1.0 + 1e-9) + 1e-14 * center.cwiseAbs().sum()};
  }
};

// Whether the sphere around one triangle holds all of another sphere.
class FindHolder {
 public:
  FindHolder(const SphereTree& tree, const Sphere& sphere) : tree_(tree), sphere_(sphere) {}

  bool afford(std::int32_t, std::int32_t) const { return true; }
  bool enters(std::int32_t node) const {
    const Sphere around = tree_.sphere(static_cast<std::size_t>(node));
    return add_up(distance_upper(around.center, sphere_.center), sphere_.radius) <= around.radius;
  }
  bool leaf(std::int32_t) {
    found_ = true;
    return false;
  }
  bool found() const { return found_; }

 private:
  const SphereTree& tree_;
  const Sphere sphere_;
  bool found_ = false;
};

bool is_held(const SolidMesh& solid, const Sphere& sphere) {
  FindHolder query(solid.mesh().tree(), sphere);
  search_tree(solid.mesh().tree(), query);
  return query.found();
}

}  // namespace

std::vector<Sphere> spheres_around(const SolidMesh& solid) {
  require_content(solid.mesh().tree().node_count() > 0, "SolidMesh");
  std::vector<Sphere> spheres;
  double sum = 0.0;
  for (const Sphere& sphere : solid.mesh().tree().spheres()) {
    sum += sphere.radius;
    spheres.push_back({sphere.center, solid.inflation() > 0.0
                                          ? add_up(sphere.radius, solid.inflation())
                                          : sphere.radius});
  }
  if (!solid.has_inside()) return spheres;
  const Eigen::AlignedBox3d& box = solid.inside().box();
  // A little more than half of the longest side, for the rounding of cells.
  const double reach = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  std::vector<Cell> cells = {
      {0.5 * (box.min() + box.max()), 0.5 * box.sizes().maxCoeff() * (1.0 + 1e-9) + 1e-12 * reach}};
  const Sphere around = cells.front().sphere();
  const SphereTree frame = build_tree({&around, 1});
  const Pose same;  // kept by reference
  const RelativePose pose(frame, same, solid.mesh().tree(), same);
  const SpheresInside inside(frame, solid, pose);
  const double smallest = kSmallestCell * sum / static_cast<double>(spheres.size());
  const std::size_t most = std::max(kFewestCells, kCellsATriangle * spheres.size());
  for (int level = 0; !cells.empty(); ++level) {
    std::vector<Cell> at_surface;
    for (const Cell& cell : cells) {
      const Sphere sphere = cell.sphere();
      if (inside.is_outside_box(cell.center, sphere.radius)) continue;
      if (!inside.is_clear(cell.center, sphere.radius)) {
        if (!is_held(solid, sphere)) at_surface.push_back(cell);
      } else if (inside.contains(cell.center)) {
        spheres.push_back(sphere);
      }
    }
    // Of the eight parts of a cell at the surface four are there as well.
    const bool is_last = level == kMostLevels || 4 * at_surface.size() > most ||
                         (!at_surface.empty() && at_surface.front().sphere().radius <= smallest);
    cells.clear();
    for (const Cell& cell : at_surface) {
      if (is_last) {
        spheres.push_back(cell.sphere());
        continue;
      }
      for (int part = 0; part < 8; ++part) {
        const double quarter = 0.5 * cell.half;
        const Vector3d to((part & 1) == 0 ? -quarter : quarter,
                          (part & 2) == 0 ? -quarter : quarter,
                          (part & 4) == 0 ? -quarter : quarter);
        cells.push_back({cell.center + to, quarter * (1.0 + 1e-12)});
      }
    }
  }
  return spheres;
}

}  // namespace spherule::internal
