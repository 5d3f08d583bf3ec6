// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/paper/uncovered_search.h"

#include "simplifier/solid/solid_query.h"
#include "simplifier/support/best_first.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace spherule::internal {
namespace {

// A point of S stands for a cell outside of it that is no further off than this share of the
// target: a sphere that is nearer to the point than the rest is near enough to the cell.
constexpr double kNear = 0.05;
// The greatest error is bracketed to this share of what it exceeds the target by.
constexpr double kPlateau = 0.1;

}  // namespace

UncoveredSearch::UncoveredSearch(const Clearance& clearance, const MeshDistance& distance,
                                 double target, double tolerance)
    : clearance_(clearance), distance_(distance), target_(target), tolerance_(tolerance) {
  push({BoxCell::around(clearance.box()), std::numeric_limits<double>::infinity(), made_++, false});
}

void UncoveredSearch::push(const Cell& cell) {
  heap_.push_back(cell);
  std::push_heap(heap_.begin(), heap_.end(), BestFirst());
}

UncoveredSearch::Cell UncoveredSearch::pop() {
  std::pop_heap(heap_.begin(), heap_.end(), BestFirst());
  const Cell cell = heap_.back();
  heap_.pop_back();
  return cell;
}

UncoveredSearch::Peak UncoveredSearch::next(const SphereSet& spheres) {
  while (!heap_.empty()) {
    Cell cell = pop();
    const double reach = cell.box.reach();
    const NearestSphere gap = spheres.nearest(cell.box.center);
    cell.upper = std::min(cell.upper, add_up(gap.upper, reach));
    if (cell.upper <= target_) continue;
    if (!heap_.empty() && cell.upper < heap_.front().upper) {
      push(cell);
      continue;
    }
    bool center_inside = cell.inside;
    if (!cell.inside) {
      const CellState state = classify(clearance_, cell.box);
      if (state.outside) continue;
      cell.inside = state.inside;
      center_inside = state.center_inside;
    }
    // As long as the error is far above the target it need not be known closely; plateaus, on which
    // many points are nearly as far as the furthest, would be searched to the bottom.
    const double close = std::max(tolerance_, kPlateau * (cell.upper - target_));
    std::optional<Peak> peak;
    if (center_inside) {
      // With no sphere there is no nearest one either: any point of S will do.
      if (gap.index < 0 || reach <= close) {
        peak = {cell.box.center, cell.upper, std::max(0.0, gap.lower)};
      }
    } else if (reach <= close) {
      peak = peak_beside(cell, spheres);
    }
    if (peak) {
      push(cell);
      return *peak;
    }
    for (const BoxCell& half : cell.box.halves()) push({half, cell.upper, made_++, cell.inside});
  }
  Peak none;
  none.upper = target_;
  return none;
}

std::optional<UncoveredSearch::Peak> UncoveredSearch::peak_beside(const Cell& cell,
                                                                  const SphereSet& spheres) const {
  using Kind = SolidPoint::Kind;
  const auto found = solid_point_for(
      clearance_, distance_, cell.box, {tolerance_, kNear * target_, true},
      [&](const Eigen::Vector3d& on_mesh) { return spheres.nearest(on_mesh).lower > target_; });
  if (!found) return std::nullopt;
  const double lower =
      found->kind == Kind::kInSolid ? std::max(0.0, spheres.nearest(found->point).lower) : 0.0;
  return Peak{found->point, cell.upper, lower};
}

}  // namespace spherule::internal
