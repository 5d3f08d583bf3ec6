// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/solid_sampling.h"

#include "simplifier/internal/box_cell.h"
#include "spheretree/rounding.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// What to do with a cell: leave it, or leave it with a point, or halve it.
enum class Step { kDrop, kEmit, kHalve };

struct Cell {
  BoxCell box;
  bool inside = false;  // wholly in S
};

// Visits the cells of a subdivision of the box of S from coarse to fine, level by level and in
// parallel within a level, and returns the points of the emitted ones in a fixed order.
// visit(cell, reach, point) may set cell.inside and gives the point to emit.
template <typename Visit>
std::vector<Vector3d> subdivide(const Clearance& clearance, Visit visit) {
  std::vector<Cell> level{{BoxCell::around(clearance.box())}};
  std::vector<Vector3d> points;
  std::vector<Vector3d> found;
  std::vector<Step> steps;
  while (!level.empty()) {
    steps.assign(level.size(), Step::kDrop);
    found.resize(level.size());
    tbb::parallel_for(std::size_t{0}, level.size(), [&](std::size_t i) {
      found[i] = level[i].box.center;
      steps[i] = visit(level[i], level[i].box.reach(), found[i]);
    });
    std::vector<Cell> next;
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (steps[i] == Step::kEmit) points.push_back(found[i]);
      if (steps[i] != Step::kHalve) continue;
      for (const BoxCell& half : level[i].box.halves()) next.push_back({half, level[i].inside});
    }
    level = std::move(next);
  }
  return points;
}

}  // namespace

std::vector<Vector3d> sample_solid(const Clearance& clearance, double spacing) {
  return subdivide(clearance, [&](Cell& cell, double reach, Vector3d& point) {
    const ClearanceAt at = clearance(point, 0.125 * reach);
    if (at.upper <= -reach) return Step::kDrop;
    if (reach > std::max(spacing, 0.5 * at.lower)) return Step::kHalve;
    if (at.lower >= reach) return Step::kEmit;
    // Onto the boundary: by the clearance towards the contact, or away from it.
    point = cell.box.center - at.away * at.lower;
    const ClearanceAt there = clearance(point);
    if (there.lower < 0.0) point += there.away * (-2.0 * there.lower);
    return clearance(point).lower >= 0.0 ? Step::kEmit : Step::kDrop;
  });
}

std::vector<Vector3d> find_leaks(const Clearance& clearance, const BallsToProve& balls,
                                 double finest, double spacing) {
  const std::vector<Vector3d> leaks =
      subdivide(clearance, [&](Cell& cell, double reach, Vector3d& point) {
        const NearestBall gap = balls.hierarchy.nearest(point);
        if (gap.index >= 0 &&
            certainly_contains(balls.balls[static_cast<std::size_t>(gap.index)], point, reach)) {
          return Step::kDrop;
        }
        bool center_inside = cell.inside;
        if (!cell.inside) {
          const ClearanceAt at = clearance(point, 0.125 * reach, 2.0 * reach);
          if (at.upper <= -reach) return Step::kDrop;
          cell.inside = at.lower >= reach;
          center_inside = at.lower >= 0.0;
        }
        const bool witnessed = center_inside && gap.lower > 0.0;
        return witnessed || reach <= finest ? Step::kEmit : Step::kHalve;
      });
  std::vector<Vector3d> thinned;
  std::set<std::array<double, 3>> taken;
  for (const Vector3d& p : leaks) {
    const Vector3d cube = (p / spacing).array().floor();
    if (taken.insert({cube.x(), cube.y(), cube.z()}).second) thinned.push_back(p);
  }
  return thinned;
}

}  // namespace spherule::internal
