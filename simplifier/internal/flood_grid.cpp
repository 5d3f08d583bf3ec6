// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/flood_grid.h"

#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace spherule::internal {
namespace {

// Width of the layer of nodes that is kept at the finest step, in steps (covering.md, section 2).
constexpr double kLayer = 1.2;
// Memory stays below 3 GiB.
constexpr std::size_t kMaxCells = std::size_t{1} << 27;

std::uint32_t gather(std::uint64_t x) {
  x &= 0x1249249249249249;
  x = (x ^ x >> 2) & 0x10c30c30c30c30c3;
  x = (x ^ x >> 4) & 0x100f00f00f00f00f;
  x = (x ^ x >> 8) & 0x1f0000ff0000ff;
  x = (x ^ x >> 16) & 0x1f00000000ffff;
  x = (x ^ x >> 32) & 0x1fffff;
  return static_cast<std::uint32_t>(x);
}

std::array<std::uint32_t, 3> decode(std::uint64_t code) {
  return {gather(code), gather(code >> 1), gather(code >> 2)};
}

// Disjoint sets with path halving; the smaller root wins, so the result does not depend on the
// order.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace

FloodGrid::FloodGrid(const MeshDistance& distance, double padding, double rho, const Shape& shape,
                     const Progress& progress)
    : padding_(padding), rho_(rho), shape_(shape) {
  cells_.push_back({});
  level_begin_ = {0};
  for (int level = 0; level <= shape_.levels; ++level) {
    examine(distance, level);
    level_begin_.push_back(cells_.size());
    if (progress) progress(0.9 * std::ldexp(1.0, 2 * (level - shape_.levels)), "flooding");
    if (level == shape_.levels) break;
    for (std::size_t i = level_begin_[static_cast<std::size_t>(level)];
         i < level_begin_[static_cast<std::size_t>(level) + 1]; ++i) {
      if (cells_[i].state != State::kRefined) continue;
      if (cells_.size() + 8 > kMaxCells) {
        throw Error("grid step", "too fine for a model of this size (more than 2^27 cells)");
      }
      cells_[i].first_child = static_cast<std::uint32_t>(cells_.size());
      const std::uint64_t code = cells_[i].code << 3;
      for (std::uint64_t k = 0; k < 8; ++k) cells_.push_back({.code = code | k});
    }
  }
}

Eigen::Vector3d FloodGrid::center(int level, const Index& index) const {
  const double edge = std::ldexp(shape_.step, shape_.levels - level);
  return shape_.origin + edge * Eigen::Vector3d(index[0] + 0.5, index[1] + 0.5, index[2] + 0.5);
}

void FloodGrid::examine(const MeshDistance& distance, int level) {
  const double edge = std::ldexp(shape_.step, shape_.levels - level);
  // Half the diagonal, with room for the rounding of centres and faces.
  const double half_diagonal =
      0.8660254037844387 * edge * (1.0 + 1e-9) +
      16.0 * kUnitRoundoff *
          (shape_.origin.cwiseAbs().maxCoeff() + std::ldexp(shape_.step, shape_.levels));
  const auto begin = level_begin_[static_cast<std::size_t>(level)];
  tbb::parallel_for(begin, cells_.size(), [&](std::size_t i) {
    Entry& cell = cells_[i];
    const SurfaceDistance d = distance(center(level, decode(cell.code)));
    cell.clearance = std::max(0.0, sub_down(d.lower, padding_));
    if (level == shape_.levels) {
      cell.state = cell.clearance >= rho_ ? State::kFree : State::kBlocked;
    } else if (cell.clearance - half_diagonal >= rho_ + kLayer * shape_.step) {
      cell.state = State::kFree;
    } else if (d.upper - padding_ + half_diagonal < rho_) {
      cell.state = State::kBlocked;
    } else {
      cell.state = State::kRefined;
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
    cell = cells_[cell].first_child + child;
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

void FloodGrid::flood() {
  const auto outside = static_cast<std::uint32_t>(cells_.size());
  DisjointSets sets(cells_.size() + 1);
  const auto first_node = level_begin_[static_cast<std::size_t>(shape_.levels)];
  // Distance of neighbouring nodes as rounded.
  const double step = shape_.step * (1.0 + 1e-9) + 16.0 * kUnitRoundoff *
                                                       (shape_.origin.cwiseAbs().maxCoeff() +
                                                        std::ldexp(shape_.step, shape_.levels));
  for (int level = 0; level <= shape_.levels; ++level) {
    for (auto i = level_begin_[static_cast<std::size_t>(level)];
         i < level_begin_[static_cast<std::size_t>(level) + 1]; ++i) {
      if (cells_[i].state != State::kFree) continue;
      const auto self = static_cast<std::uint32_t>(i);
      for_each_face_neighbour(level, decode(cells_[i].code), [&](std::size_t other, const Index&) {
        if (other == cells_.size()) {
          sets.unite(self, outside);
        } else if (cells_[other].state == State::kFree) {
          const bool both_nodes = i >= first_node && other >= first_node;
          const bool passes = !both_nodes || sub_down(cells_[i].clearance + cells_[other].clearance,
                                                      step) >= 2.0 * rho_ * kRelativeUp;
          if (passes) sets.unite(self, static_cast<std::uint32_t>(other));
        }
      });
    }
  }
  const std::uint32_t reached = sets.find(outside);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    cells_[i].reached =
        cells_[i].state == State::kFree && sets.find(static_cast<std::uint32_t>(i)) == reached;
  }
}

std::vector<FloodGrid::Cell> FloodGrid::reached_cells() const {
  std::vector<Cell> result;
  for (int level = 0; level <= shape_.levels; ++level) {
    for (auto i = level_begin_[static_cast<std::size_t>(level)];
         i < level_begin_[static_cast<std::size_t>(level) + 1]; ++i) {
      if (!cells_[i].reached) continue;
      result.push_back({center(level, decode(cells_[i].code)), cells_[i].clearance});
    }
  }
  return result;
}

std::vector<FloodGrid::Frontier> FloodGrid::frontier() const {
  std::vector<Frontier> result;
  std::vector<bool> seen(cells_.size(), false);
  const auto first_node = level_begin_[static_cast<std::size_t>(shape_.levels)];
  for (auto i = first_node; i < cells_.size(); ++i) {
    if (!cells_[i].reached) continue;
    const Index index = decode(cells_[i].code);
    for_each_face_neighbour(shape_.levels, index, [&](std::size_t other, const Index& neighbour) {
      if (other < first_node || other >= cells_.size()) return;
      if (cells_[other].reached || seen[other]) return;
      seen[other] = true;
      result.push_back(
          {center(shape_.levels, neighbour), {center(shape_.levels, index), cells_[i].clearance}});
    });
  }
  return result;
}

}  // namespace spherule::internal
