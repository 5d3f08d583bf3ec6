// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage1/flood_grid.h"

#include "simplifier/stage1/too_many_cells.h"
#include "simplifier/support/parallel.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

namespace spherule::internal {
namespace {

// Width of the layer of nodes that is kept at the finest step, in steps (docs/covering.md, stage
// 1).
constexpr double kLayer = 1.2;
// Of the step: rounding that a sphere may stick out of another by and still be taken for a part.
constexpr double kContained = 1e-9;
// Cells that are examined between two reports of progress: siblings stay together.
constexpr std::size_t kPart = std::size_t{1} << 20;
// How many levels ahead the number of cells is foreseen, and by how much that may be wrong.
constexpr int kForeseen = 3;
constexpr double kClearlyMore = 1.5;

}  // namespace

FloodGrid::FloodGrid(const MeshDistance& distance, double padding, const LocalDiameter& diameter,
                     const Shape& shape, const Progress& progress)
    : distance_(distance),
      padding_(padding),
      way_(distance, padding),
      diameter_(diameter),
      shape_(shape),
      levels_(shape.levels + diameter.most_halvings()) {
  assert(levels_ <= kMostLevels);
  for (int level = 0; level <= kMostLevels; ++level) {
    edges_[static_cast<std::size_t>(level)] = std::ldexp(shape_.step, shape_.levels - level);
  }
  rounding_ = 16.0 * kUnitRoundoff * (shape_.origin.cwiseAbs().maxCoeff() + edge(0));
  cells_.push_back({});
  level_begin_ = {0};
  for (int level = 0; level <= levels_; ++level) {
    examine_level(level, progress);
    level_begin_.push_back(cells_.size());
    check_memory(level);
    for (std::size_t i = level_begin_[static_cast<std::size_t>(level)];
         i < level_begin_[static_cast<std::size_t>(level) + 1]; ++i) {
      if (cells_[i].state == State::kRefined) halve(i);
    }
  }
}

void FloodGrid::examine_level(int level, const Progress& progress) {
  const std::size_t first = level_begin_[static_cast<std::size_t>(level)];
  const std::size_t count = cells_.size() - first;
  const double before = level == 0 ? 0.0 : std::ldexp(1.0, 2 * (level - 1 - levels_));
  const double after = std::ldexp(1.0, 2 * (level - levels_));
  for (std::size_t done = 0; done < count; done += std::min(kPart, count - done)) {
    const std::size_t begin = first + done;
    examine(begin, begin + std::min(kPart, count - done));
    const double part =
        static_cast<double>(std::min(done + kPart, count)) / static_cast<double>(count);
    if (progress) progress(0.9 * (before + part * (after - before)), "flooding");
  }
}

// Cells around a surface become four times as many with every level once they are smaller than the
// clearance that is requested; those of zones do not.
void FloodGrid::check_memory(int level) const {
  const auto begin = cells_.begin() + static_cast<std::ptrdiff_t>(level_begin_.end()[-2]);
  const auto refined = static_cast<double>(std::count_if(
      begin, cells_.end(), [](const Entry& e) { return e.state == State::kRefined; }));
  double next = 8.0 * refined;
  double total = static_cast<double>(cells_.size()) + next;
  const auto most = static_cast<double>(shape_.grid_cells);
  const bool is_foreseeable = diameter_.most_halvings() == 0 && levels_ - level <= kForeseen;
  for (int finer = level + 1; finer < levels_ && is_foreseeable; ++finer) {
    next *= 4.0;
    total += next;
  }
  if (total <= (is_foreseeable && level + 1 < levels_ ? kClearlyMore : 1.0) * most) return;
  throw TooManyCells(total, edge(levels_), shape_.grid_cells);
}

void FloodGrid::halve(std::size_t cell) {
  const Entry parent = cells_[cell];
  cells_[cell].state = State::kRefined;
  cells_[cell].finest = false;
  cells_[cell].child_or_zone = static_cast<std::uint32_t>(cells_.size());
  for (std::uint64_t k = 0; k < 8; ++k) {
    cells_.push_back(
        {.code = parent.code << 3 | k, .level = static_cast<std::uint8_t>(parent.level + 1)});
  }
}

// Half the diagonal, with room for the rounding of centres and faces.
double FloodGrid::half_diagonal(int level) const {
  return 0.8660254037844387 * edge(level) * (1.0 + 1e-9) + rounding();
}

void FloodGrid::classify(Entry& cell, const Eigen::Vector3d& middle,
                         const SurfaceDistance& d) const {
  const int level = cell.level;
  const double reach = half_diagonal(level);
  cell.clearance = std::max(0.0, sub_down(d.lower, padding_));
  // What no zone can change is known without searching for zones.
  if (level < shape_.levels) {
    if (cell.clearance - reach >= diameter_.radius() + kLayer * shape_.step) {
      cell.state = State::kFree;
      return;
    }
    if (d.upper - padding_ + reach < diameter_.least_radius()) {
      cell.state = State::kBlocked;
      return;
    }
  }
  const LocalDiameter::Near rho = diameter_.near(middle, reach);
  cell.finest = level >= shape_.levels + rho.halvings;
  if (cell.finest) {
    const LocalDiameter::Needed needed = diameter_.at(middle);
    cell.child_or_zone = needed.zone;
    cell.state = cell.clearance >= needed.radius ? State::kFree : State::kBlocked;
  } else if (cell.clearance - reach >=
             rho.greatest + kLayer * std::ldexp(shape_.step, -rho.halvings)) {
    cell.state = State::kFree;
  } else if (d.upper - padding_ + reach < rho.least) {
    cell.state = State::kBlocked;
  } else {
    cell.state = State::kRefined;
  }
}

void FloodGrid::examine(std::size_t begin, std::size_t end) {
  // Children of one cell: what is near to one is not much further from the others.
  parallel_for(0, (end - begin + 7) / 8, [&](std::size_t family) {
    const std::size_t first = begin + 8 * family;
    double limit = std::numeric_limits<double>::infinity();
    double gap = 0.0;
    for (std::size_t i = first; i < std::min(first + 8, end); ++i) {
      const Eigen::Vector3d middle = center(cells_[i]);
      const SurfaceDistance d = distance_(middle, limit);
      limit = d.upper + 4.0 * half_diagonal(cells_[i].level);
      gap = std::max(gap, d.upper - d.lower);
      classify(cells_[i], middle, d);
    }
    double known = widest_bounds_;
    while (gap > known && !widest_bounds_.compare_exchange_weak(known, gap)) {
    }
  });
}

std::size_t FloodGrid::locate(int level, const Index& index) const {
  std::size_t cell = 0;
  for (int l = 0; cells_[cell].state == State::kRefined; ++l) {
    if (l == level) return cells_.size();
    const int shift = level - l - 1;
    const std::uint32_t child = ((index[0] >> shift) & 1U) | ((index[1] >> shift) & 1U) << 1 |
                                ((index[2] >> shift) & 1U) << 2;
    cell = cells_[cell].child_or_zone + child;
  }
  return cell;
}

template <typename Visit>
void FloodGrid::for_each_face_neighbour(int level, const Index& index, Visit visit) const {
  const std::uint32_t last = (std::uint32_t{1} << level) - 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool up : {false, true}) {
      if (index[axis] == (up ? last : 0U)) {
        visit(cells_.size(), index);
        continue;
      }
      Index neighbour = index;
      neighbour[axis] = up ? index[axis] + 1 : index[axis] - 1;
      const std::size_t found = locate(level, neighbour);
      if (found < cells_.size()) visit(found, neighbour);
    }
  }
}

double FloodGrid::needed_between(const Entry& a, const Entry& b) const {
  if (a.child_or_zone == LocalDiameter::kNoZone || b.child_or_zone == LocalDiameter::kNoZone) {
    return diameter_.radius();
  }
  if (a.child_or_zone == b.child_or_zone) return diameter_.radius_of(a.child_or_zone);
  return diameter_.on_way(center(a), center(b));
}

bool FloodGrid::passes(const Entry& a, const Entry& b, const Eigen::Vector3d& face) const {
  if (!a.finest && !b.finest) return true;
  const auto suffices = [](double sum, double way, double rho) {
    return sub_down(sum, way) >= 2.0 * rho * kRelativeUp;
  };
  const Eigen::Vector3d from = center(a);
  const Eigen::Vector3d to = center(b);
  if (a.finest && b.finest) {
    const double way =
        a.level == b.level ? edge(a.level) * (1.0 + 1e-9) + rounding() : distance_upper(from, to);
    const double sum = a.clearance + b.clearance;
    return suffices(sum, way, diameter_.radius()) ||
           (suffices(sum, way, diameter_.least_radius()) &&
            suffices(sum, way, needed_between(a, b)));
  }
  const Entry& node = a.finest ? a : b;
  const Entry& coarse = a.finest ? b : a;
  const Eigen::Vector3d& start = a.finest ? from : to;
  const Eigen::Vector3d& end = a.finest ? to : from;
  const double way = add_up(distance_upper(start, face), rounding());
  const double at_face = sub_down(coarse.clearance, add_up(distance_upper(face, end), rounding()));
  const auto has_room = [&](double rho) {
    return suffices(node.clearance + at_face, way, rho) ||
           sub_down(node.clearance, way) >= rho * kRelativeUp;
  };
  return has_room(diameter_.radius()) ||
         (has_room(diameter_.least_radius()) && has_room(diameter_.on_way(start, face)));
}

bool FloodGrid::passes_by_bisection(const Entry& a, const Entry& b) const {
  const Sphere from{center(a), a.clearance};
  const Sphere to{center(b), b.clearance};
  return way_.passes(from, to, diameter_.on_way(from.center, to.center));
}

void FloodGrid::connect(std::size_t cell) {
  const Entry& self = cells_[cell];
  if (self.state != State::kFree) return;
  const Index at = decode(self.code);
  for_each_face_neighbour(self.level, at, [&](std::size_t other, const Index& index) {
    if (other == cells_.size()) {
      sets_.unite(0, element(cell));
    } else if (cells_[other].state == State::kFree) {
      const Eigen::Vector3d face = (center(self) + center(self.level, index)) / 2.0;
      if (passes(self, cells_[other], face)) {
        sets_.unite(element(cell), element(other));
      } else {
        uncertain_.emplace_back(static_cast<std::uint32_t>(cell),
                                static_cast<std::uint32_t>(other));
      }
    }
  });
}

void FloodGrid::reach_on() {
  std::vector<Pair> tried;
  std::vector<char> passes;
  do {
    tried.clear();
    std::erase_if(uncertain_, [&](const Pair& pair) {
      const bool first = is_reached(pair.first);
      const bool second = is_reached(pair.second);
      if (first != second) tried.push_back(pair);
      return first || second;
    });
    passes.assign(tried.size(), 0);
    parallel_for(0, tried.size(), [&](std::size_t i) {
      passes[i] = passes_by_bisection(cells_[tried[i].first], cells_[tried[i].second]) ? 1 : 0;
    });
    for (std::size_t i = 0; i < tried.size(); ++i) {
      if (passes[i] != 0) sets_.unite(element(tried[i].first), element(tried[i].second));
    }
  } while (!tried.empty());
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    cells_[i].reached = cells_[i].state == State::kFree && is_reached(i);
  }
}

void FloodGrid::flood() {
  sets_.grow(cells_.size() + 1);
  for (std::size_t i = 0; i < cells_.size(); ++i) connect(i);
  reach_on();
}

std::vector<FloodGrid::Cell> FloodGrid::reached_cells() const {
  std::vector<Cell> result;
  for (const Entry& cell : cells_) {
    if (cell.reached) result.push_back({center(cell), cell.clearance});
  }
  return result;
}

bool FloodGrid::lies_in_neighbour(const Entry& node) const {
  const Eigen::Vector3d middle = center(node);
  bool found = false;
  for_each_face_neighbour(node.level, decode(node.code), [&](std::size_t i, const Index&) {
    if (found || i >= cells_.size() || !cells_[i].reached) return;
    const double more = cells_[i].clearance - node.clearance;
    found = more > 0.0 && (center(cells_[i]) - middle).norm() <= more + kContained * shape_.step;
  });
  return found;
}

std::vector<FloodGrid::Cell> FloodGrid::reached_cells_that_count() const {
  std::vector<char> counts(cells_.size());
  parallel_for(0, cells_.size(), [&](std::size_t i) {
    counts[i] = cells_[i].reached && !(cells_[i].finest && lies_in_neighbour(cells_[i])) ? 1 : 0;
  });
  std::vector<Cell> result;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (counts[i] != 0) result.push_back({center(cells_[i]), cells_[i].clearance});
  }
  return result;
}

std::vector<FloodGrid::Frontier> FloodGrid::frontier() const {
  std::vector<Frontier> result;
  std::vector<std::size_t> cells;  // of these
  std::vector<bool> seen(cells_.size(), false);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (!cells_[i].finest) continue;
    const auto visit = [&](std::size_t other, const Index&) {
      if (other >= cells_.size() || !cells_[other].finest) return;
      if (cells_[other].reached == cells_[i].reached) return;
      // Of two cells of one size each visits the other.
      if (cells_[other].reached && cells_[other].level == cells_[i].level) return;
      const std::size_t open = cells_[i].reached ? other : i;
      const Entry& reached = cells_[i].reached ? cells_[i] : cells_[other];
      if (seen[open]) return;
      seen[open] = true;
      cells.push_back(open);
      result.push_back(
          {center(cells_[open]), {center(reached), reached.clearance}, edge(cells_[open].level)});
    };
    for_each_face_neighbour(cells_[i].level, decode(cells_[i].code), visit);
  }
  // Those that share no more than an edge or a corner with a reached one: two rings.
  std::size_t begin = 0;
  for (int ring = 0; ring < 2; ++ring) {
    const std::size_t end = cells.size();
    for (std::size_t k = begin; k < end; ++k) {
      const Entry& inner = cells_[cells[k]];
      const Cell from = result[k].neighbour;
      for_each_face_neighbour(inner.level, decode(inner.code), [&](std::size_t i, const Index&) {
        if (i >= cells_.size() || seen[i] || !cells_[i].finest || cells_[i].reached) return;
        const Entry& cell = cells_[i];
        seen[i] = true;
        if (cell.clearance + half_diagonal(cell.level) < diameter_.least_radius()) return;
        cells.push_back(i);
        result.push_back({center(cell), from, edge(cell.level)});
      });
    }
    begin = end;
  }
  return result;
}

}  // namespace spherule::internal
