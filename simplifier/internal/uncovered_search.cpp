// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/uncovered_search.h"

#include "spheretree/rounding.h"

#include <algorithm>
#include <limits>

namespace spherule::internal {
namespace {

// Clearances are asked for to this share of the cell's half diagonal.
constexpr double kClearanceTolerance = 0.125;
// A cell this much smaller than the tolerance is taken for a point of S even where its centre is
// not: then S is that near, or a sliver outside of it is covered for nothing.
constexpr double kFinest = 1.0 / 64.0;
// The greatest error is bracketed to this share of what it exceeds the target by.
constexpr double kPlateau = 0.1;

}  // namespace

UncoveredSearch::UncoveredSearch(const Clearance& clearance, const MeshDistance& distance,
                                 double target, double tolerance)
    : clearance_(clearance), distance_(distance), target_(target), tolerance_(tolerance) {
  push({BoxCell::around(clearance.box()), std::numeric_limits<double>::infinity(), made_++, false});
}

bool UncoveredSearch::below(const Cell& a, const Cell& b) {
  return a.upper < b.upper || (a.upper == b.upper && a.order > b.order);
}

void UncoveredSearch::push(const Cell& cell) {
  heap_.push_back(cell);
  std::push_heap(heap_.begin(), heap_.end(), below);
}

UncoveredSearch::Cell UncoveredSearch::pop() {
  std::pop_heap(heap_.begin(), heap_.end(), below);
  const Cell cell = heap_.back();
  heap_.pop_back();
  return cell;
}

UncoveredSearch::Peak UncoveredSearch::next(const BallSet& balls) {
  while (!heap_.empty()) {
    Cell cell = pop();
    const double reach = cell.box.reach();
    const NearestBall gap = balls.nearest(cell.box.center);
    ++examined_;
    cell.upper = std::min(cell.upper, add_up(gap.upper, reach));
    if (cell.upper <= target_) continue;
    if (!heap_.empty() && cell.upper < heap_.front().upper) {
      push(cell);
      continue;
    }
    bool center_inside = cell.inside;
    if (!cell.inside) {
      const ClearanceAt at = clearance_(cell.box.center, kClearanceTolerance * reach, 2.0 * reach);
      if (at.upper <= -reach) continue;
      cell.inside = at.lower >= reach;
      center_inside = at.lower >= 0.0;
    }
    // With no ball there is no nearest one either: any point of S will do.
    const bool settled = center_inside && gap.index < 0;
    // As long as the error is far above the target it need not be known closely; plateaus, on which
    // many points are nearly as far as the furthest, would be searched to the bottom.
    const double close = std::max(tolerance_, kPlateau * (cell.upper - target_));
    if (settled || (center_inside && reach <= close) || reach <= kFinest * tolerance_) {
      push(cell);
      return {cell.box.center, cell.upper, std::max(0.0, center_inside ? gap.lower : 0.0),
              center_inside};
    }
    if (!center_inside && reach <= close) {
      // S may be as thin as the mesh itself, which is in it.
      const SurfaceDistance near = distance_(cell.box.center, reach);
      if (near.triangle >= 0 && balls.nearest(near.closest).lower > target_) {
        push(cell);
        return {near.closest, cell.upper, 0.0, false};
      }
    }
    for (const BoxCell& half : cell.box.halves()) push({half, cell.upper, made_++, cell.inside});
  }
  Peak none;
  none.point = Eigen::Vector3d::Zero();
  none.upper = target_;
  return none;
}

}  // namespace spherule::internal
