// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage1/flood_refinement.h"

#include "base/rounding.h"
#include "base/threads.h"
#include "simplifier/stage1/flood_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

// Makes the flood tight where that matters.
//
// What is proved (G2). Let T(x) = (1 + s) rho(x), R the places to which a sphere of radius T can be
// moved from outside the cube: its centre passes points of clearance >= T alone. A leaf is
// *possible* if its clearance may be T somewhere: the clearance at its centre, rounded up, and half
// its diagonal make the least T in it; a coarse leaf that is free is, one that is blocked, or that
// blocked ones separate from the outside, is not. The places of a leaf with a sphere of its own lie
// in that sphere (flood_refinement.h), so that none is on a face of it which the sphere does not
// meet, or, of two such leaves, on their common face if their spheres do not intersect. The path of
// the centre to a place of R passes possible leaves alone. Where it passes an edge or a corner,
// each leaf there holds the point and so is possible or reached: it can be taken to pass from leaf
// to leaf through faces. So each leaf that intersects R belongs to the possible leaves that are
// connected with the outside through faces of possible or reached leaves: *open* leaves. Once each
// open leaf is reached, or lies as a whole in the sphere of a reached leaf that touches it (is
// *held*), each place of R lies in the sphere of a reached leaf. That sphere's centre is at most
// half a diagonal of its leaf and a diagonal of the open one away: 2.6 h, of the coarser of the two
// (of a coarse free cell: its sphere holds more than its leaf), unless it is a leaf's own and so
// has a radius above 2 rho.
//
// Where it is not so, those of the open leaves that are left and lie at the front of what is
// reached are halved, with the possible leaves around them in two rings, so that what is reached
// beside them can be followed. Between open leaves of edge h that share a face the clearance on the
// segment between their centres is at least T - 1.37 h: they are free and passed once 1.37 h is
// less than s rho. A leaf with a sphere of its own that is not reached is halved like them, until
// its cells are finest.
//
// Ways may begin at any leaf that is reached or held, except where a zone of a smaller rho ends
// beside leaves that have rho and not T: its leaves would be open and never reached, however fine.
// If halving shows no end, the grid is made again and borders are followed (flood_borders.cpp):
// ways then begin at reached leaves that are far from borders or all of whose points have a
// clearance of T, and lead on through what is uncertain, what is held, and reached leaves at
// borders that may have such a point. A path to R passes none but these after the last leaf at
// which ways begin, so that what no way leads to holds no place of R. Leaves at which ways along a
// border begin are halved before what these lead to, so that they end where the border has no
// place.
//
// Should halving end before (with zones by bounds on the growth of the grid and on rounds, by
// memory, or by the resolution of coordinates), a larger s is stated for which no open leaf is
// left, at most that of a grid as it is that has no own spheres. If none is proved up to there and
// there are own spheres, the grid is made anew without them.

namespace spherule::internal {
namespace {

// Half of the closing slack of a grid that is not refined, in steps: a place has its cell's centre
// within sqrt(3) / 2, and the passage rule takes half a step more. Where a zone makes the grid
// finer, the step only shrinks, between cells of two sizes too, and a node then has the clearance
// rho + h / 2 that suffices to get to the face of any free cell.
constexpr double kUniform = 0.8661 + 0.5;
constexpr int kRings = 2;
// With zones the refined grid has at most so many more cells, or so many times those it was made
// with: halving may prove nothing.
constexpr std::size_t kMoreBesideZones = std::size_t{1} << 20;
constexpr std::size_t kGrowthBesideZones = 16;
constexpr std::size_t kGrowthAlongBorders = 4;
// Few take more than two dozen.
constexpr int kMostRoundsAlongBorders = 40;
// Halving shows no end once the grid has grown so much and there are leaves at the front of so much
// of s rho: half of the edge below which a sphere gets on from leaf to leaf.
constexpr std::size_t kGrowthWithoutEnd = 2;
constexpr double kEdgeWithoutEnd = 0.5 / 1.37;

}  // namespace

FloodGrid::Refinement::Refinement(FloodGrid& grid, ZoneBorders borders)
    : grid_(grid),
      follows_borders_(grid.has_zones() && borders == ZoneBorders::kFollowed),
      made_(grid.cells_.size()),
      most_cells_(grid.shape_.max_cells) {
  if (!grid.has_zones()) return;
  const std::size_t growth = follows_borders_ ? kGrowthAlongBorders : kGrowthBesideZones;
  most_cells_ = std::min(most_cells_, std::max(made_ + kMoreBesideZones, growth * made_));
}

void FloodGrid::Refinement::begin(double share) {
  share_ = share;
  is_possible_.clear();
  border_.clear();
  uncertain_.clear();
  uncertain_from(0, {});
}

const std::vector<std::size_t>& FloodGrid::Refinement::lost() {
  way_.assign(cells().size(), Way::kNone);
  is_open_.assign(cells().size(), 0);
  for (const std::size_t i : uncertain_) way_[i] = Way::kUncertain;
  std::vector<std::size_t> nodes = uncertain_;
  for (std::size_t i = 0; follows_borders_ && i < cells().size(); ++i) {
    if (way_[i] != Way::kNone || !is_on_border(i)) continue;
    way_[i] = Way::kOnBorder;
    nodes.push_back(i);
  }
  std::vector<char> is_first(nodes.size());
  parallel_for(0, nodes.size(),
               [&](std::size_t k) { is_first[k] = touches_source(nodes[k]) ? 1 : 0; });
  front_.clear();
  std::vector<std::size_t> first;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (is_first[k] == 0) continue;
    first.push_back(nodes[k]);
    if (way_[nodes[k]] == Way::kUncertain) front_.push_back(nodes[k]);
  }
  if (follows_borders_) {
    follow_borders(first);
  } else {
    open_ways(std::move(first), {});
  }
  std::vector<std::size_t> open;
  for (const std::size_t i : nodes) {
    if (is_open_[i] == 0) {
      is_possible_[i] = 0;
      if (follows_borders_) border_[i].room = Room::kNone;
    } else if (way_[i] == Way::kUncertain) {
      open.push_back(i);
    }
  }
  uncertain_ = std::move(open);
  return uncertain_;
}

bool FloodGrid::Refinement::refine() {
  if (shows_no_end()) return false;
  ++rounds_;
  std::vector<char> is_chosen(cells().size());
  std::vector<std::size_t> chosen;
  const auto choose = [&](std::size_t i) {
    const Entry& cell = cells()[i];
    if (is_chosen[i] != 0 || is_possible_[i] == 0 || !can_be_halved(cell)) return;
    is_chosen[i] = 1;
    chosen.push_back(i);
  };
  for_each_at_the_front(choose);
  for (int n = 0; n < kRings; ++n) {
    const std::vector<std::size_t> inner = chosen;
    for (const std::size_t i : inner) for_each_touching(i, false, choose);
  }
  for (const std::size_t i : entries_) {
    if (std::exchange(is_chosen[i], 1) == 0) chosen.push_back(i);
  }
  std::size_t more = 0;
  for (const std::size_t i : chosen) more += most_cells_within(cells()[i]);
  if (chosen.empty() || cells().size() + more > most_cells_) return false;
  std::sort(chosen.begin(), chosen.end());
  // What lies in the sphere of a reached leaf may lie in none of its halves.
  std::vector<std::size_t> held;
  for (const std::size_t i : chosen) {
    if (!cells()[i].reached) continue;
    for_each_touching(i, false, [&](std::size_t other) {
      if (is_possible_[other] != 0) held.push_back(other);
    });
  }
  const std::size_t begin = cells().size();
  for (const std::size_t i : chosen) grid_.halve(i);
  grid_.examine_and_halve(begin);
  grid_.sets_.grow(cells().size() + 1);
  std::erase_if(grid_.uncertain_, [&](const Pair& pair) {
    return cells()[pair.first].state == State::kRefined ||
           cells()[pair.second].state == State::kRefined;
  });
  for (std::size_t i = begin; i < cells().size(); ++i) grid_.connect(i);
  connect_finer(begin);
  grid_.reach_on();
  for (const std::size_t i : chosen) is_possible_[i] = 0;
  uncertain_from(begin, held);
  return true;
}

bool FloodGrid::Refinement::shows_no_end() const {
  if (follows_borders_) return rounds_ >= kMostRoundsAlongBorders;
  if (!grid_.has_zones() || cells().size() < kGrowthWithoutEnd * made_) return false;
  const double edge = kEdgeWithoutEnd * share_ * grid_.diameter_.least_radius();
  return std::any_of(front_.begin(), front_.end(), [&](std::size_t i) {
    return cells()[i].finest && grid_.edge(cells()[i].level) < edge;
  });
}

bool FloodGrid::Refinement::can_be_halved(const Entry& cell) const {
  return (cell.finest || cell.state == State::kOwnSphere) && cell.level < kMostLevels &&
         grid_.edge(cell.level + 1) > 1e3 * grid_.rounding();
}

std::size_t FloodGrid::Refinement::most_cells_within(const Entry& cell) const {
  std::size_t most = 0;
  std::size_t of_level = 1;
  for (int level = cell.level; level == cell.level || level < grid_.levels_; ++level) {
    of_level *= 8;
    most += of_level;
  }
  return most;
}

bool FloodGrid::Refinement::is_at_boundary(const Entry& cell) const {
  const std::uint32_t last = (std::uint32_t{1} << cell.level) - 1;
  const Index index = decode(cell.code);
  return std::any_of(index.begin(), index.end(),
                     [&](std::uint32_t i) { return i == 0 || i == last; });
}

bool FloodGrid::Refinement::is_possible(const Entry& cell) const {
  if (cell.reached || cell.state == State::kRefined) return false;
  if (!cell.finest && cell.state != State::kOwnSphere) return cell.state == State::kFree;
  if (!may_have_room(cell, grid_.diameter_.least_radius())) return false;
  const double reach = grid_.half_diagonal(cell.level);
  return may_have_room(cell, grid_.diameter_.near(grid_.center(cell), reach).least);
}

bool FloodGrid::Refinement::may_have_room(const Entry& cell, double rho) const {
  const double most =
      add_up(cell.clearance + grid_.widest_bounds_, grid_.half_diagonal(cell.level));
  return most >= (1.0 + share_) * rho * (1.0 - 1e-9);
}

template <typename Counts>
bool FloodGrid::Refinement::is_held_by(std::size_t cell, Counts counts) const {
  const Eigen::Vector3d middle = grid_.center(cells()[cell]);
  const double reach = grid_.half_diagonal(cells()[cell].level);
  bool found = false;
  for_each_touching(cell, false, [&](std::size_t other) {
    if (found || !counts(cells()[other])) return;
    const Sphere sphere = grid_.sphere_of(cells()[other]);
    found = add_up(distance_upper(middle, sphere.center), reach) <= sphere.radius;
  });
  return found;
}

void FloodGrid::Refinement::uncertain_from(std::size_t begin,
                                           const std::vector<std::size_t>& others) {
  is_possible_.resize(cells().size());
  if (follows_borders_) border_.resize(cells().size());
  parallel_for(begin, cells().size(), [&](std::size_t i) {
    is_possible_[i] = is_possible(cells()[i]) ? 1 : 0;
    if (follows_borders_) border_[i] = border(cells()[i]);
  });
  std::vector<std::size_t> queried = std::move(uncertain_);
  queried.insert(queried.end(), others.begin(), others.end());
  for (std::size_t i = begin; i < cells().size(); ++i) {
    if (is_possible_[i] != 0) queried.push_back(i);
  }
  std::sort(queried.begin(), queried.end());
  queried.erase(std::unique(queried.begin(), queried.end()), queried.end());
  std::vector<char> is_uncertain(queried.size());
  parallel_for(0, queried.size(), [&](std::size_t k) {
    const Entry& cell = cells()[queried[k]];
    is_uncertain[k] =
        cell.state != State::kRefined && !cell.reached &&
                !is_held_by(queried[k], [](const Entry& other) { return other.reached; })
            ? 1
            : 0;
  });
  uncertain_.clear();
  for (std::size_t k = 0; k < queried.size(); ++k) {
    if (is_uncertain[k] != 0) uncertain_.push_back(queried[k]);
  }
}

bool FloodGrid::Refinement::is_source(std::size_t cell) const {
  if (follows_borders_) {
    const Room room = border_[cell].room;
    return cells()[cell].reached && (room == Room::kFarFromBorders || room == Room::kEverywhere);
  }
  return cells()[cell].reached || (is_possible_[cell] != 0 && way_[cell] != Way::kUncertain);
}

bool FloodGrid::Refinement::touches_source(std::size_t cell) const {
  if (is_at_boundary(cells()[cell])) return true;
  bool found = false;
  for_each_touching(cell, true, [&](std::size_t other) {
    found = found || (is_source(other) && (!cells()[other].reached ||
                                           grid_.may_share_places(cells()[other], cells()[cell])));
  });
  return found;
}

template <typename Visit>
void FloodGrid::Refinement::for_each_at_the_front(Visit visit) const {
  const auto is_lost = [&](std::size_t i) {
    return std::binary_search(uncertain_.begin(), uncertain_.end(), i);
  };
  const auto has_room = [](const Entry& other) { return other.has_sphere(); };
  std::vector<char> seen(cells().size());
  std::vector<std::size_t> waiting = front_;
  for (const std::size_t i : waiting) seen[i] = 1;
  while (!waiting.empty()) {
    const std::size_t i = waiting.back();
    waiting.pop_back();
    visit(i);
    if (has_room(cells()[i]) || is_held_by(i, has_room)) continue;
    for_each_touching(i, true, [&](std::size_t other) {
      if (seen[other] != 0 || !is_lost(other)) return;
      seen[other] = 1;
      waiting.push_back(other);
    });
  }
}

void FloodGrid::Refinement::connect_finer(std::size_t begin) const {
  for (std::size_t i = begin; i < cells().size(); ++i) {
    if (!cells()[i].has_sphere()) continue;
    for_each_touching(i, true, [&](std::size_t other) {
      if (other >= begin || !cells()[other].has_sphere() ||
          cells()[other].level <= cells()[i].level) {
        return;
      }
      grid_.uncertain_.emplace_back(static_cast<std::uint32_t>(i),
                                    static_cast<std::uint32_t>(other));
    });
  }
}

std::optional<double> FloodGrid::tighten(double share, ZoneBorders borders,
                                         const Progress& progress) {
  const double uniform = kUniform * shape_.step / diameter_.radius();
  const bool is_as_it_is = share >= uniform;
  if (is_as_it_is && own_spheres_.empty()) return uniform;
  share = std::min(share, uniform);
  Refinement refinement(*this, borders);
  refinement.begin(share);
  bool is_proved = refinement.lost().empty();
  while (!is_proved && !is_as_it_is) {
    if (progress) progress(0.95, "searching for narrow passages");
    if (!refinement.refine()) break;
    is_proved = refinement.lost().empty();
  }
  if (!is_proved && has_zones() && borders == ZoneBorders::kOpen) return std::nullopt;
  // For how much more room it does hold: with zones it is tried in larger and larger steps, as
  // there may be none.
  double factor = 1.1;
  while (!is_proved && share < uniform) {
    share = std::min(factor * share, uniform);
    if (has_zones()) factor *= factor;
    refinement.begin(share);
    is_proved = refinement.lost().empty();
  }
  // A grid without own spheres holds for that share, proved here or not.
  if (is_proved || own_spheres_.empty()) return share;
  return std::nullopt;
}

}  // namespace spherule::internal

// What the flood hands on.

namespace spherule::internal {
namespace {

// Of the step: rounding that a sphere may stick out of another by and still be taken for a part.
constexpr double kContained = 1e-9;

}  // namespace

std::vector<Sphere> FloodGrid::reached_spheres() const {
  std::vector<Sphere> result;
  for (const Entry& cell : cells_) {
    if (cell.reached) result.push_back(sphere_of(cell));
  }
  return result;
}

bool FloodGrid::lies_in_neighbour(const Entry& node) const {
  const Eigen::Vector3d middle = center(node);
  bool found = false;
  for_each_face_neighbour(node.level, decode(node.code), [&](std::size_t i, const Index&) {
    if (found || i >= cells_.size() || !cells_[i].reached) return;
    const Sphere sphere = sphere_of(cells_[i]);
    const double more = sphere.radius - node.clearance;
    found = more > 0.0 && (sphere.center - middle).norm() <= more + kContained * shape_.step;
  });
  return found;
}

std::vector<Sphere> FloodGrid::reached_spheres_that_count() const {
  std::vector<char> counts(cells_.size());
  parallel_for(0, cells_.size(), [&](std::size_t i) {
    counts[i] = cells_[i].reached && !(cells_[i].finest && lies_in_neighbour(cells_[i])) ? 1 : 0;
  });
  std::vector<Sphere> result;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (counts[i] != 0) result.push_back(sphere_of(cells_[i]));
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
      result.push_back({center(cells_[open]), sphere_of(reached), edge(cells_[open].level)});
    };
    for_each_face_neighbour(cells_[i].level, decode(cells_[i].code), visit);
  }
  // Those that share no more than an edge or a corner with a reached one: two rings.
  std::size_t begin = 0;
  for (int ring = 0; ring < 2; ++ring) {
    const std::size_t end = cells.size();
    for (std::size_t k = begin; k < end; ++k) {
      const Entry& inner = cells_[cells[k]];
      const Sphere from = result[k].neighbour;
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
