// SPDX-License-Identifier: BSD-3-Clause
#include "collide/internal/solid_spheres.h"

#include "collide/internal/balls_inside.h"
#include "collide/internal/mesh_inside.h"
#include "spheretree/build.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cstddef>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kFewestCells = 512;
constexpr int kMostLevels = 12;

struct Cell {
  Vector3d center;
  double half;

  Sphere ball() const { return {center, half * 1.7320508075688774 * (1.0 + 1e-12)}; }
};

}  // namespace

std::vector<Sphere> spheres_around(const SolidMesh& solid) {
  std::vector<Sphere> spheres;
  for (const Sphere& ball : solid.mesh().tree().spheres()) {
    spheres.push_back(
        {ball.center, solid.growth() > 0.0 ? add_up(ball.radius, solid.growth()) : ball.radius});
  }
  if (!solid.has_inside()) return spheres;
  const Eigen::AlignedBox3d& box = solid.inside().box();
  // A little more than half of the longest side, for the rounding of cells.
  const double reach = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  std::vector<Cell> cells = {
      {0.5 * (box.min() + box.max()), 0.5 * box.sizes().maxCoeff() * (1.0 + 1e-9) + 1e-12 * reach}};
  const Sphere around = cells.front().ball();
  const SphereTree frame = build_tree({&around, 1});
  const RelativePose pose(frame, Pose(), solid.mesh().tree(), Pose());
  const BallsInside balls(frame, solid, pose);
  const std::size_t most = std::max(kFewestCells, solid.mesh().tree().spheres().size());
  for (int level = 0; !cells.empty(); ++level) {
    std::vector<Cell> at_surface;
    for (const Cell& cell : cells) {
      const Sphere ball = cell.ball();
      if (balls.is_outside_box(cell.center, ball.radius)) continue;
      if (!balls.is_clear(cell.center, ball.radius)) {
        at_surface.push_back(cell);
      } else if (balls.contains(cell.center)) {
        spheres.push_back(ball);
      }
    }
    // Of the eight parts of a cell at the surface four are there as well.
    const bool is_last = level == kMostLevels || 4 * at_surface.size() > most;
    cells.clear();
    for (const Cell& cell : at_surface) {
      if (is_last) {
        spheres.push_back(cell.ball());
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
