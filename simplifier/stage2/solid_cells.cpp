// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/solid_cells.h"

#include "base/rounding.h"
#include "base/threads.h"
#include "simplifier/solid/cells.h"
#include "simplifier/solid/solid_query.h"

#include <algorithm>
#include <array>
#include <set>

namespace spherule::internal {
namespace {

// A cell that has shown so many leaks can wait for the next round: the spheres that mend them cover
// most of its parts, which need not be examined then.
constexpr std::size_t kEnoughLeaks = 3;

constexpr double kGrading = 0.5;  // of the clearance, by which deeper cells are larger
// Shares of the cells' spacing.
constexpr double kThinning = 1.2;  // edge of the cubes with one boundary point each
// Halving the longest edge of a box that is no more than twice as long as another divides its half
// diagonal by this at most, so that those of the largest cells that are small enough are at least
// so much less. (Flatter ones may be missed: it decides where rows stand, not what is proved.)
constexpr double kShrinking = 1.42;

// Cells are only ever halved, along the seams of every set of spheres that was examined. From so
// many times the first number on, and so many in all, it is cheaper to begin again.
constexpr std::size_t kForgetting = 8;
constexpr std::size_t kLeastForgotten = 600000;

}  // namespace

using Eigen::Vector3d;

SolidCells::SolidCells(const Clearance& clearance, const MeshDistance& distance,
                       const LocalError& error, double max_error, double share, double widest_cap)
    : SolidCells(clearance, distance, error, max_error, share,
                 std::array{BoxCell::around(clearance.box())}, widest_cap) {}

SolidCells::SolidCells(const Clearance& clearance, const MeshDistance& distance,
                       const LocalError& error, double max_error, double share,
                       std::span<const BoxCell> part, double widest_cap)
    : clearance_(clearance), distance_(distance), error_(error), spacing_(share * max_error) {
  // Spheres of S that touch the boundary in the cell are large enough for its size, and remain so
  // this far along it.
  const auto is_flat = [&](const BoxCell& cell, const ClearanceAt& at, double local_error) {
    const double width = cell.reach() / share;
    if (width < local_error || width > widest_cap * local_error) return false;
    const double inside = inside_radius(width, local_error) + cell.reach();
    return touched_by(clearance, cell.center, at, inside, local_error);
  };
  enum class Step : char { kDrop, kKeep, kHalve };
  std::vector<Cell> level;
  for (const BoxCell& box : part) level.push_back({.box = box});
  std::vector<Step> steps;
  while (!level.empty()) {
    steps.assign(level.size(), Step::kDrop);
    parallel_for(0, level.size(), [&](std::size_t i) {
      Cell& cell = level[i];
      const double reach = cell.box.reach();
      const ClearanceAt at = clearance_(cell.box.center, 4.0 * reach);
      const CellState state = state_of(at, reach);
      if (state.outside) return;
      cell.note(state);
      const double local_error = max_error * error_.scale(cell.box.center, reach);
      const double deep = kGrading * std::max(0.0, at.lower);
      const bool fine = reach <= share * local_error + deep || is_flat(cell.box, at, local_error);
      steps[i] = fine ? Step::kKeep : Step::kHalve;
    });
    std::vector<Cell> next;
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (steps[i] == Step::kKeep) cells_.push_back(level[i]);
      if (steps[i] != Step::kHalve) continue;
      for (const BoxCell& half : level[i].box.halves()) next.push_back({.box = half});
    }
    level = std::move(next);
  }
  first_ = cells_;
}

std::vector<BoxCell> SolidCells::boxes() const {
  std::vector<BoxCell> boxes;
  for (const Cell& cell : cells_) boxes.push_back(cell.box);
  return boxes;
}

std::vector<Vector3d> SolidCells::sample() const {
  std::vector<Vector3d> points(cells_.size());
  std::vector<char> usable(cells_.size());
  parallel_for(0, cells_.size(), [&](std::size_t i) {
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
  std::set<GradedCube> taken;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (usable[i] == 0) continue;
    const auto cube = [&] {
      const double scale = kShrinking * cells_[i].box.reach() / spacing_;
      return graded_cube_of(points[i], kThinning * spacing_, scale);
    };
    if (cells_[i].inside || taken.insert(cube()).second) {
      kept.push_back(points[i]);
    }
  }
  return kept;
}

void SolidCells::Cell::note(const CellState& state) {
  inside = state.inside;
  center_inside = state.center_inside;
  contact = state.inside ? nullptr : state.contact;
  classified = true;
}

bool SolidCells::intersects_solid(Cell& cell) const {
  const CellState state = classify(clearance_, cell.box);
  cell.note(state);
  return !state.outside;
}

std::optional<SolidCells::Leak> SolidCells::leak_in(const Cell& cell, const NearestSphere& gap,
                                                    double finest_elsewhere) const {
  const double reach = cell.box.reach();
  const double finest = finest_elsewhere * error_.scale(cell.box.center, reach);
  if (cell.center_inside) {
    if (gap.lower > 0.0 || reach <= finest) return Leak{cell.box.center, true};
    return std::nullopt;
  }
  if (reach > finest) return std::nullopt;
  const auto stands_for = solid_point_for(clearance_, distance_, cell.box, {finest, finest, true});
  if (!stands_for) return std::nullopt;
  return Leak{stands_for->point, stands_for->kind != SolidPoint::Kind::kPinch};
}

SolidCells::Refined SolidCells::refine(const Cell& start, const SpheresToProve& spheres,
                                       double finest) const {
  Refined result;
  std::vector<Cell> waiting{start};
  const auto in_its_sphere = [&](const Cell& cell) {
    if (cell.sphere < 0) return false;
    const Sphere& sphere = spheres.spheres[static_cast<std::size_t>(cell.sphere)];
    const double furthest = cell.contact == nullptr
                                ? cell.box.furthest(sphere.center)
                                : furthest_outside(cell.box, sphere.center, *cell.contact);
    return furthest <= sphere.radius;
  };
  while (!waiting.empty()) {
    Cell cell = waiting.back();
    waiting.pop_back();
    if (result.leaks.size() >= kEnoughLeaks || in_its_sphere(cell)) {
      result.cells.push_back(cell);
      continue;
    }
    const NearestSphere gap = spheres.hierarchy.nearest(cell.box.center);
    cell.sphere = gap.index;
    if (in_its_sphere(cell)) {
      result.cells.push_back(cell);
      continue;
    }
    if (!cell.classified) {
      if (!intersects_solid(cell)) continue;
      if (cell.contact != nullptr && in_its_sphere(cell)) {
        result.cells.push_back(cell);
        continue;
      }
    }
    if (const auto leak = leak_in(cell, gap, finest)) {
      result.cells.push_back(cell);
      result.leaks.push_back(*leak);
      continue;
    }
    for (const BoxCell& half : cell.box.halves()) {
      waiting.push_back({half, cell.inside, cell.inside, cell.inside, cell.sphere});
    }
  }
  return result;
}

void SolidCells::follow(std::span<const Sphere> spheres) {
  std::vector<Sphere> centers(spheres.begin(), spheres.end());
  for (Sphere& center : centers) center.radius = 0.0;
  const SphereHierarchy hierarchy(centers);
  std::vector<std::int32_t> number(spheres_before_.size());
  parallel_for(0, number.size(), [&](std::size_t i) {
    number[i] = hierarchy.nearest(spheres_before_[i].center).index;
  });
  for (Cell& cell : cells_) {
    if (cell.sphere >= 0) cell.sphere = number[static_cast<std::size_t>(cell.sphere)];
  }
  spheres_before_.assign(spheres.begin(), spheres.end());
}

SolidCells::Leaks SolidCells::find_leaks(const SpheresToProve& spheres, double finest,
                                         double spacing) {
  follow(spheres.spheres);
  std::vector<Refined> refined(cells_.size());
  parallel_for(0, cells_.size(),
               [&](std::size_t i) { refined[i] = refine(cells_[i], spheres, finest); });
  cells_.clear();
  Leaks thinned;
  std::set<GradedCube> taken;
  for (const Refined& r : refined) {
    cells_.insert(cells_.end(), r.cells.begin(), r.cells.end());
    for (const Leak& leak : r.leaks) {
      const double scale = error_.scale(leak.point);
      if (!taken.insert(graded_cube_of(leak.point, spacing, scale)).second) continue;
      (leak.in_solid ? thinned.in_solid : thinned.pinched).push_back(leak.point);
    }
  }
  if (cells_.size() > std::max(kLeastForgotten, kForgetting * first_.size())) cells_ = first_;
  return thinned;
}

}  // namespace spherule::internal
