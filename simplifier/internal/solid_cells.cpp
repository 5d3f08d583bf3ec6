// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/solid_cells.h"

#include "simplifier/internal/solid_query.h"
#include "spheretree/rounding.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <set>

namespace spherule::internal {
namespace {

// A cell that has shown so many leaks can wait for the next round: the balls that mend them cover
// most of its parts, which need not be examined then.
constexpr std::size_t kEnoughLeaks = 3;

}  // namespace

using Eigen::Vector3d;

SolidCells::SolidCells(const Clearance& clearance, const MeshDistance& distance, double spacing)
    : clearance_(clearance), distance_(distance) {
  enum class Step : char { kDrop, kKeep, kHalve };
  std::vector<Cell> level{{BoxCell::around(clearance.box()), false, false}};
  std::vector<Step> steps;
  while (!level.empty()) {
    steps.assign(level.size(), Step::kDrop);
    tbb::parallel_for(std::size_t{0}, level.size(), [&](std::size_t i) {
      Cell& cell = level[i];
      const double reach = cell.box.reach();
      const ClearanceAt at = clearance_(cell.box.center, 0.125 * reach);
      const CellState state = state_of(at, reach);
      if (state.outside) return;
      cell.inside = state.inside;
      cell.center_inside = state.center_inside;
      steps[i] = reach > std::max(spacing, 0.5 * at.lower) ? Step::kHalve : Step::kKeep;
    });
    std::vector<Cell> next;
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (steps[i] == Step::kKeep) cells_.push_back(level[i]);
      if (steps[i] != Step::kHalve) continue;
      for (const BoxCell& half : level[i].box.halves()) next.push_back({half, false, false});
    }
    level = std::move(next);
  }
}

std::vector<Vector3d> SolidCells::sample() const {
  std::vector<Vector3d> points(cells_.size());
  std::vector<char> usable(cells_.size());
  tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t i) {
    points[i] = cells_[i].box.center;
    usable[i] = 1;
    if (cells_[i].inside) return;
    // Onto the boundary: by the clearance towards the contact, or away from it.
    const ClearanceAt at = clearance_(points[i]);
    points[i] -= at.away * at.lower;
    const ClearanceAt there = clearance_(points[i]);
    if (there.lower >= 0.0) return;
    points[i] += there.away * (-2.0 * there.lower);
    if (clearance_(points[i]).lower >= 0.0) return;
    const auto on_mesh = mesh_point_in(distance_, cells_[i].box);
    usable[i] = on_mesh ? 1 : 0;
    if (on_mesh) points[i] = *on_mesh;
  });
  std::vector<Vector3d> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (usable[i] != 0) kept.push_back(points[i]);
  }
  return kept;
}

bool SolidCells::meets_solid(Cell& cell) const {
  const CellState state =
      cell.inside ? CellState{false, true, true} : classify(clearance_, cell.box);
  cell.inside = state.inside;
  cell.center_inside = state.center_inside;
  return !state.outside;
}

SolidCells::Refined SolidCells::refine(const Cell& start, const BallsToProve& balls,
                                       double finest) const {
  Refined result;
  std::vector<Cell> waiting{start};
  while (!waiting.empty()) {
    const Cell cell = waiting.back();
    waiting.pop_back();
    if (result.leaks.size() >= kEnoughLeaks) {
      result.cells.push_back(cell);
      continue;
    }
    const double reach = cell.box.reach();
    const NearestBall gap = balls.hierarchy.nearest(cell.box.center);
    if (gap.index >= 0 && certainly_contains(balls.balls[static_cast<std::size_t>(gap.index)],
                                             cell.box.center, reach)) {
      result.cells.push_back(cell);
      continue;
    }
    if (cell.center_inside ? gap.lower > 0.0 || reach <= finest
                           : reach <= kFinestOutside * finest) {
      result.cells.push_back(cell);
      result.leaks.push_back(cell.box.center);
      continue;
    }
    if (!cell.center_inside && reach <= finest) {
      if (const auto on_mesh = mesh_point_in(distance_, cell.box)) {
        result.cells.push_back(cell);
        result.leaks.push_back(*on_mesh);
        continue;
      }
    }
    for (const BoxCell& half : cell.box.halves()) {
      Cell part{half, cell.inside, false};
      if (meets_solid(part)) waiting.push_back(part);
    }
  }
  return result;
}

std::vector<Vector3d> SolidCells::find_leaks(const BallsToProve& balls, double finest,
                                             double spacing) {
  std::vector<Refined> refined(cells_.size());
  tbb::parallel_for(std::size_t{0}, cells_.size(),
                    [&](std::size_t i) { refined[i] = refine(cells_[i], balls, finest); });
  cells_.clear();
  std::vector<Vector3d> thinned;
  std::set<std::array<double, 3>> taken;
  for (const Refined& r : refined) {
    cells_.insert(cells_.end(), r.cells.begin(), r.cells.end());
    for (const Vector3d& p : r.leaks) {
      const Vector3d cube = (p / spacing).array().floor();
      if (taken.insert({cube.x(), cube.y(), cube.z()}).second) thinned.push_back(p);
    }
  }
  return thinned;
}

}  // namespace spherule::internal
