// SPDX-License-Identifier: BSD-3-Clause

// Makes the flood tight where that matters.
//
// What is proved (G2). Let T(x) = (1 + s) rho(x), R the places to which a sphere of radius T can be
// moved from outside the cube: its centre passes points of clearance >= T alone. A leaf is
// *possible* if its clearance may be T somewhere: the clearance at its centre, rounded up, and half
// its diagonal make the least T in it; a coarse leaf that is free is, one that is blocked, or that
// blocked ones separate from the outside, is not. The places of a leaf with a sphere of its own lie
// in that sphere (sphere_of_places.h), so that none is on a face of it which the sphere does not
// meet, or, of two such leaves, on their common face if their spheres do not intersect. The path of
// the centre to a place of R passes possible leaves alone. Points of clearance above (1
// - 1e-9) T form an open set, in which the path can be moved off edges and corners, so that it
// passes from leaf to leaf through faces. So each leaf that intersects R belongs to the possible
// leaves that are connected with the outside through faces of possible or reached leaves: *open*
// leaves. Once each open leaf is reached, or lies as a whole in the sphere of a reached leaf that
// touches it, each place of R lies in the sphere of a reached leaf. That sphere's centre is at most
// half a diagonal of its leaf and a diagonal of the open one away: 2.6 h, of the coarser of the two
// (of a coarse free cell: its sphere holds more than its leaf), unless it is a leaf's own and so
// has a radius above 2 rho.
//
// Where it is not so, those of the open leaves that are left and lie at the front of what is
// reached are halved, with the possible leaves around them in two rings, so that what is reached
// beside them can be followed. Between open leaves of edge h that share a face the clearance on the
// segment between their centres is at least T - 1.37 h: they are free and passed once 1.37 h is
// less than s rho. A leaf with a sphere of its own that is not reached is halved like them, until
// its cells are finest. Where a zone of a smaller rho ends beside reached leaves that have rho and
// not T, its leaves are open and never reached, however fine: with zones the grid becomes at most
// sixteen times as large, or a million cells. Should halving end before (by that, by memory, or the
// resolution of coordinates), a larger s is stated for which no open leaf is left, at most that of
// a grid as it is that has no own spheres. If none is proved up to there and there are own spheres,
// the grid is made anew without them.

#include "simplifier/stage1/flood_grid.h"
#include "simplifier/support/parallel.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

// Half of the closing slack of a grid that is not refined, in steps: a place has its cell's centre
// within sqrt(3) / 2, and the passage rule takes half a step more. Where a zone makes the grid
// finer, the step only shrinks, between cells of two sizes too, and a node then has the clearance
// rho + h / 2 that suffices to get to the face of any free cell.
constexpr double kUniform = 0.8661 + 0.5;
constexpr int kRings = 2;
// With zones the refined grid has at most so many cells, or so many times those it was made with.
constexpr std::size_t kMostBesideZones = std::size_t{1} << 20;
constexpr std::size_t kMostGrowth = 16;

}  // namespace

class FloodGrid::Refinement {
 public:
  explicit Refinement(FloodGrid& grid)
      : grid_(grid),
        has_zones_(grid.diameter_.least_radius() < grid.diameter_.radius()),
        most_cells_(grid.shape_.max_cells) {
    if (!has_zones_) return;
    most_cells_ =
        std::min(most_cells_, std::max(kMostBesideZones, kMostGrowth * grid.cells_.size()));
  }

  bool has_zones() const { return has_zones_; }

  // Takes all leaves into account for a share, from now on.
  void begin(double share) {
    share_ = share;
    is_possible_.clear();
    uncertain_.clear();
    uncertain_from(0);
  }

  // The open leaves that are not held, in order. The leaves that are held count as outside: more
  // may be named so, never fewer. What is not open never will be, and is not possible from now on.
  const std::vector<std::size_t>& lost() {
    std::vector<char> is_first(uncertain_.size());
    parallel_for(0, uncertain_.size(),
                 [&](std::size_t k) { is_first[k] = touches_outside(uncertain_[k]) ? 1 : 0; });
    std::vector<char> is_open = is_first;
    front_.clear();
    std::vector<std::size_t> waiting;
    for (std::size_t k = 0; k < uncertain_.size(); ++k) {
      if (is_first[k] == 0) continue;
      waiting.push_back(k);
      front_.push_back(uncertain_[k]);
    }
    while (!waiting.empty()) {
      const std::size_t k = waiting.back();
      waiting.pop_back();
      for_each_touching(uncertain_[k], true, [&](std::size_t other) {
        if (!grid_.may_share_places(cells()[uncertain_[k]], cells()[other])) return;
        const auto found = std::lower_bound(uncertain_.begin(), uncertain_.end(), other);
        if (found == uncertain_.end() || *found != other) return;
        const auto at = static_cast<std::size_t>(found - uncertain_.begin());
        if (std::exchange(is_open[at], 1) == 0) waiting.push_back(at);
      });
    }
    std::vector<std::size_t> open;
    for (std::size_t k = 0; k < uncertain_.size(); ++k) {
      if (is_open[k] != 0) {
        open.push_back(uncertain_[k]);
      } else {
        is_possible_[uncertain_[k]] = 0;
      }
    }
    uncertain_ = std::move(open);
    return uncertain_;
  }

  // Halves those of the leaves that are lost that lie at the front of what is reached, and the
  // possible ones around them, and floods on. False if none can be halved.
  bool refine() {
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
    std::size_t more = 0;
    for (const std::size_t i : chosen) more += most_cells_within(cells()[i]);
    if (chosen.empty() || cells().size() + more > most_cells_) return false;
    std::sort(chosen.begin(), chosen.end());
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
    uncertain_from(begin);
    return true;
  }

 private:
  const std::vector<Entry>& cells() const { return grid_.cells_; }

  bool can_be_halved(const Entry& cell) const {
    return (cell.finest || cell.state == State::kOwnSphere) && cell.level < kMostLevels &&
           grid_.edge(cell.level + 1) > 1e3 * grid_.rounding();
  }

  // That halving makes: a leaf with a sphere of its own is halved until its cells are finest.
  std::size_t most_cells_within(const Entry& cell) const {
    std::size_t most = 0;
    std::size_t of_level = 1;
    for (int level = cell.level; level == cell.level || level < grid_.levels_; ++level) {
      of_level *= 8;
      most += of_level;
    }
    return most;
  }

  bool is_at_boundary(const Entry& cell) const {
    const std::uint32_t last = (std::uint32_t{1} << cell.level) - 1;
    const Index index = decode(cell.code);
    return std::any_of(index.begin(), index.end(),
                       [&](std::uint32_t i) { return i == 0 || i == last; });
  }

  // Whether an uncertain leaf ends the cube, or shares a face with a leaf that is reached, or
  // possible and held.
  bool touches_outside(std::size_t cell) const {
    if (is_at_boundary(cells()[cell])) return true;
    bool found = false;
    for_each_touching(cell, true, [&](std::size_t other) {
      found = found ||
              (cells()[other].reached && grid_.may_share_places(cells()[other], cells()[cell])) ||
              (is_possible_[other] != 0 &&
               !std::binary_search(uncertain_.begin(), uncertain_.end(), other));
    });
    return found;
  }

  // Drops the uncertain leaves that are none any more, and adds those from a cell on that are
  // possible and not held.
  void uncertain_from(std::size_t begin) {
    is_possible_.resize(cells().size());
    parallel_for(begin, cells().size(),
                 [&](std::size_t i) { is_possible_[i] = is_possible(cells()[i]) ? 1 : 0; });
    std::vector<std::size_t> queried = std::move(uncertain_);
    for (std::size_t i = begin; i < cells().size(); ++i) {
      if (is_possible_[i] != 0) queried.push_back(i);
    }
    std::vector<char> is_uncertain(queried.size());
    parallel_for(0, queried.size(), [&](std::size_t k) {
      const Entry& cell = cells()[queried[k]];
      is_uncertain[k] =
          cell.state != State::kRefined && !cell.reached && !is_held(queried[k]) ? 1 : 0;
    });
    uncertain_.clear();
    for (std::size_t k = 0; k < queried.size(); ++k) {
      if (is_uncertain[k] != 0) uncertain_.push_back(queried[k]);
    }
  }

  bool is_possible(const Entry& cell) const {
    if (cell.reached || cell.state == State::kRefined) return false;
    if (!cell.finest && cell.state != State::kOwnSphere) return cell.state == State::kFree;
    const double reach = grid_.half_diagonal(cell.level);
    const double most = add_up(cell.clearance + grid_.widest_bounds_, reach);
    const auto suffices = [&](double rho) { return most >= (1.0 + share_) * rho * (1.0 - 1e-9); };
    if (!suffices(grid_.diameter_.least_radius())) return false;
    return suffices(grid_.diameter_.near(grid_.center(cell), reach).least);
  }

  // Whether the cell lies as a whole in the sphere of a reached leaf that touches it.
  bool is_held(std::size_t cell) const {
    return is_held_by(cell, [](const Entry& other) { return other.reached; });
  }
  template <typename Counts>
  bool is_held_by(std::size_t cell, Counts counts) const {
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

  // Calls visit(leaf) for the leaves that are lost from the reached ones on, up to where there is
  // room: what is behind a free leaf matters once that is reached, and needs no finer cells until
  // then.
  template <typename Visit>
  void for_each_at_the_front(Visit visit) const {
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

  // Connects new cells with finer ones at their faces that were there before.
  void connect_finer(std::size_t begin) const {
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

  // Calls visit(leaf) for the leaves that share a point with a cell, or a face (not an edge or a
  // corner alone). Not for itself.
  template <typename Visit>
  void for_each_touching(std::size_t cell, bool by_faces, Visit visit) const {
    const Entry& self = cells()[cell];
    const Index index = decode(self.code);
    // In units of the finest cells that there can be.
    std::array<std::uint32_t, 3> low{};
    const std::uint32_t size = std::uint32_t{1} << (kMostLevels - self.level);
    for (std::size_t axis = 0; axis < 3; ++axis) low[axis] = index[axis] * size;
    const auto descend = [&](const auto& descend_on, std::size_t node, const Index& node_low,
                             std::uint32_t node_size) -> void {
      int apart_by_none = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::uint32_t begin = std::max(low[axis], node_low[axis]);
        const std::uint32_t end = std::min(low[axis] + size, node_low[axis] + node_size);
        apart_by_none += begin == end ? 1 : 0;
      }
      if (by_faces && apart_by_none > 1) return;
      if (cells()[node].state != State::kRefined) {
        if (node != cell) visit(node);
        return;
      }
      const std::uint32_t half = node_size / 2;
      // The halves along each axis that the cell touches.
      std::array<std::array<bool, 2>, 3> touches{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        touches[axis] = {low[axis] <= node_low[axis] + half,
                         low[axis] + size >= node_low[axis] + half};
      }
      for (std::uint32_t k = 0; k < 8; ++k) {
        if (!touches[0][k & 1U] || !touches[1][k >> 1 & 1U] || !touches[2][k >> 2 & 1U]) continue;
        const Index child_low = {node_low[0] + (k & 1U) * half, node_low[1] + (k >> 1 & 1U) * half,
                                 node_low[2] + (k >> 2 & 1U) * half};
        descend_on(descend_on, cells()[node].index + k, child_low, half);
      }
    };
    descend(descend, 0, {0, 0, 0}, std::uint32_t{1} << kMostLevels);
  }

  FloodGrid& grid_;
  bool has_zones_;
  std::size_t most_cells_;
  double share_ = 0.0;
  std::vector<char> is_possible_;       // of each cell
  std::vector<std::size_t> uncertain_;  // possible and not held, in order
  std::vector<std::size_t> front_;      // those of them that meet the outside
};

std::optional<double> FloodGrid::tighten(double share, const Progress& progress) {
  const double uniform = kUniform * shape_.step / diameter_.radius();
  const bool is_as_it_is = share >= uniform;
  if (is_as_it_is && own_spheres_.empty()) return uniform;
  share = std::min(share, uniform);
  Refinement refinement(*this);
  refinement.begin(share);
  bool is_proved = refinement.lost().empty();
  while (!is_proved && !is_as_it_is) {
    if (progress) progress(0.95, "searching for narrow passages");
    if (!refinement.refine()) break;
    is_proved = refinement.lost().empty();
  }
  // For how much more room it does hold: with zones it is tried in larger and larger steps, as
  // there may be none.
  double factor = 1.1;
  while (!is_proved && share < uniform) {
    share = std::min(factor * share, uniform);
    if (refinement.has_zones()) factor *= factor;
    refinement.begin(share);
    is_proved = refinement.lost().empty();
  }
  // A grid without own spheres holds for that share, proved here or not.
  if (is_proved || own_spheres_.empty()) return share;
  return std::nullopt;
}

}  // namespace spherule::internal
