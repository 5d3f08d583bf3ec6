// SPDX-License-Identifier: BSD-3-Clause

// What the flood hands on.

#include "simplifier/stage1/flood_grid.h"
#include "simplifier/support/parallel.h"

#include <cstddef>
#include <vector>

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
