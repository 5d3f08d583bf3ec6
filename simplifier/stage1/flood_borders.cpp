// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"
#include "base/threads.h"
#include "simplifier/stage1/flood_grid.h"
#include "simplifier/stage1/flood_refinement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

// Ways of the larger sphere along borders of zones (flood_refinement.cpp says what they are for).

namespace spherule::internal {
namespace {

// Of s rho. Where a zone ends at rho from a surface, places of the sphere end within s rho of the
// border, on either side of which three leaves of this edge tell them apart.
constexpr double kFinestEdge = 0.36;
// A way is halved as a whole where it is fewer than one in so many of the cells.
constexpr std::size_t kFew = 64;

}  // namespace

FloodGrid::Refinement::Border FloodGrid::Refinement::border(const Entry& cell) const {
  if (!cell.finest && cell.state != State::kOwnSphere) return {};
  const double reach = grid_.half_diagonal(cell.level);
  const double largest = (1.0 + share_) * grid_.diameter_.radius();
  const double least = cell.clearance - reach;
  if (least >= largest) return {};
  const Eigen::Vector3d middle = grid_.center(cell);
  const double nearby = 2.0 * std::max(reach, share_ * grid_.diameter_.radius());
  const LocalDiameter::Near around = grid_.diameter_.near(middle, nearby);
  if (around.least == around.greatest) return {Room::kFarFromBorders, around.least};
  const LocalDiameter::Near within = grid_.diameter_.near(middle, reach);
  if (!may_have_room(cell, within.least)) return {Room::kNone, within.least};
  const bool has_room = least >= (1.0 + share_) * within.greatest;
  return {has_room ? Room::kEverywhere : Room::kPerhaps, within.least};
}

bool FloodGrid::Refinement::is_on_border(std::size_t i) const {
  const Entry& cell = cells()[i];
  if (cell.state == State::kRefined) return false;
  return cell.reached ? border_[i].room == Room::kPerhaps : is_possible_[i] != 0;
}

bool FloodGrid::Refinement::is_coarse(const Entry& cell) const {
  return can_be_halved(cell) &&
         grid_.edge(cell.level) >= kFinestEdge * share_ * grid_.diameter_.radius();
}

bool FloodGrid::Refinement::is_entered_from_within(std::size_t cell) const {
  bool found = false;
  for_each_touching(cell, true, [&](std::size_t other) {
    found = found || (is_source(other) && border_[other].rho <= border_[cell].rho);
  });
  return found;
}

std::vector<std::size_t> FloodGrid::Refinement::open_ways(std::vector<std::size_t> waiting,
                                                          const std::vector<char>& is_end) {
  std::vector<std::size_t> ends;
  for (const std::size_t i : waiting) is_open_[i] = 1;
  while (!waiting.empty()) {
    const std::size_t i = waiting.back();
    waiting.pop_back();
    if (!is_end.empty() && is_end[i] != 0) {
      ends.push_back(i);
      continue;
    }
    for_each_touching(i, true, [&](std::size_t other) {
      if (way_[other] == Way::kNone || is_open_[other] != 0) return;
      if (!grid_.may_share_places(cells()[i], cells()[other])) return;
      is_open_[other] = 1;
      waiting.push_back(other);
    });
  }
  return ends;
}

void FloodGrid::Refinement::follow_borders(const std::vector<std::size_t>& first) {
  std::vector<char> is_within(cells().size());
  parallel_for(0, first.size(), [&](std::size_t k) {
    if (way_[first[k]] == Way::kOnBorder) is_within[first[k]] = is_entered_from_within(first[k]);
  });
  // What lies behind leaves that a border is not in the way of is at the front.
  for (const std::size_t i : first) {
    if (is_within[i] == 0) continue;
    for_each_touching(i, true, [&](std::size_t other) {
      if (way_[other] == Way::kUncertain) front_.push_back(other);
    });
  }
  std::vector<std::size_t> behind;
  for (const bool within_too : {false, true}) {
    std::vector<char> is_end(cells().size());
    for (std::size_t i = 0; i < cells().size(); ++i) {
      is_end[i] =
          way_[i] == Way::kOnBorder && (within_too || is_within[i] == 0) && is_coarse(cells()[i])
              ? 1
              : 0;
    }
    is_open_.assign(cells().size(), 0);
    const std::vector<std::size_t> ends = open_ways(first, is_end);
    open_ways(ends, {});
    std::fill(is_end.begin(), is_end.end(), 0);
    for (const std::size_t i : ends) is_end[i] = 1;
    behind = find_entries(is_end);
    if (!entries_.empty()) return;
  }
  front_.insert(front_.end(), behind.begin(), behind.end());
}

std::vector<std::size_t> FloodGrid::Refinement::find_entries(const std::vector<char>& is_end) {
  entries_.clear();
  // Back along borders.
  std::vector<char> seen(cells().size());
  std::vector<std::size_t> behind;
  std::vector<std::size_t> waiting;
  std::vector<std::size_t> between;
  const auto go_back = [&](std::size_t from) {
    bool is_behind = false;
    for_each_touching(from, true, [&](std::size_t other) {
      if (way_[other] != Way::kOnBorder || is_open_[other] == 0) return;
      is_behind = true;
      if (std::exchange(seen[other], 1) != 0) return;
      (is_end[other] != 0 ? entries_ : waiting).push_back(other);
      if (is_end[other] == 0 && is_coarse(cells()[other])) between.push_back(other);
    });
    return is_behind;
  };
  for (const std::size_t i : uncertain_) {
    if (is_open_[i] != 0 && go_back(i)) behind.push_back(i);
  }
  while (!waiting.empty()) {
    const std::size_t i = waiting.back();
    waiting.pop_back();
    go_back(i);
  }
  // Few are near the end of a long way: it is not taken leaf by leaf.
  if (!entries_.empty() && entries_.size() + between.size() < cells().size() / kFew) {
    entries_.insert(entries_.end(), between.begin(), between.end());
  }
  return behind;
}

namespace {

using Eigen::Vector3d;

// The radius of a wanted sphere, over the one whose scallop is as high as those of the finest
// cells: the rest is for surfaces that curve away from the sphere.
constexpr double kRadius = 1.5;
// How often the cell is halved, across one axis each time, to prove that two balls hold it.
constexpr int kMostHalvings = 9;
// Of the hierarchy over the mesh, for one distance: more are near only inside of round shapes.
constexpr std::size_t kMostLeaves = 24;

double scallop(const PlaceCell& cell) {
  return cell.step * cell.step / (4.0 * cell.rho);
}

// Whether each point of a cell lies in the ball, or nearer than `near` to `q`.
bool is_held(const BoxCell& cell, const Sphere& ball, const Vector3d& q, double near,
             int halvings = kMostHalvings) {
  if (cell.furthest(q) < near || cell.furthest(ball.center) <= ball.radius) return true;
  const bool is_center_out = distance_upper(cell.center, q) >= near &&
                             distance_upper(cell.center, ball.center) > ball.radius;
  if (halvings == 0 || is_center_out) return false;
  const auto [low, high] = cell.halves();
  return is_held(low, ball, q, near, halvings - 1) && is_held(high, ball, q, near, halvings - 1);
}

}  // namespace

std::optional<SphereOfPlaces> wanted_sphere(const MeshDistance& distance, double padding,
                                            const PlaceCell& cell) {
  const SurfaceDistance nearest =
      distance(cell.box.center, cell.surface_at_most * SphereDisplacement::kLimitUp, kMostLeaves);
  const Vector3d away = cell.box.center - nearest.closest;
  const double height = away.norm();
  if (nearest.triangle < 0 || !(height > 0.0)) return std::nullopt;
  const double ratio = 2.0 * cell.box.half[0] / cell.step;
  SphereOfPlaces wanted{.sphere = {Vector3d::Zero(), kRadius * cell.rho * ratio * ratio},
                        .foot = nearest.closest,
                        .normal = away / height};
  wanted.sphere.center = wanted.foot + (wanted.sphere.radius + padding) * wanted.normal;
  if (!is_usable(wanted.sphere) ||
      !is_held(cell.box, wanted.sphere, wanted.foot, cell.rho + padding)) {
    return std::nullopt;
  }
  return wanted;
}

std::optional<Sphere> sphere_of_places(const MeshDistance& distance, double padding,
                                       const PlaceCell& cell, const SphereOfPlaces& wanted) {
  Sphere ball = wanted.sphere;
  const double limit = (ball.radius + padding) * SphereDisplacement::kLimitUp;
  ball.radius = sub_down(distance(ball.center, limit, kMostLeaves).lower, padding);
  if (ball.radius < wanted.sphere.radius - scallop(cell)) return std::nullopt;

  // The foot is computed: a point of the surface, up to rounding.
  const SurfaceDistance at_foot = distance(wanted.foot, 1e-6 * cell.step, kMostLeaves);
  const double near = sub_down(add_down(cell.rho, padding), at_foot.upper);
  if (!(near > 0.0) || !is_held(cell.box, ball, wanted.foot, near)) {
    return std::nullopt;
  }

  const double aside = std::sqrt(2.0) * cell.box.half[0];
  const double down = std::sqrt(std::max(0.0, ball.radius * ball.radius - aside * aside));
  const Vector3d first = wanted.normal.unitOrthogonal();
  const Vector3d second = wanted.normal.cross(first);
  for (const Vector3d& direction : {first, Vector3d(-first), second, Vector3d(-second)}) {
    const Vector3d rim = ball.center - down * wanted.normal + aside * direction;
    const double surface = distance(rim, scallop(cell) + padding, kMostLeaves).upper;
    if (!(surface <= scallop(cell) + padding)) return std::nullopt;
  }
  return ball;
}

}  // namespace spherule::internal
