// SPDX-License-Identifier: BSD-3-Clause

// Ways of the larger sphere along borders of zones (flood_refinement.cpp says what they are for).

#include "simplifier/stage1/flood_refinement.h"
#include "simplifier/support/parallel.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

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

}  // namespace spherule::internal
