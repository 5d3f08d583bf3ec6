// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simplifier/solid/cells.h"
#include "simplifier/solid/sphere_hierarchy.h"

#include <Eigen/Geometry>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace spherule::internal {

// The nearest sphere from short lists: cells of a box, halved where queries come, list every sphere
// that is nearest to some point of the cell, as LeastGap computes it, and few others. The list of a
// cell is gathered from a hierarchy of the spheres or, where its parent has one, from that. Faster
// than a search where many queries come to a cell, and until then the hierarchy is searched.
//
// Safe to share between threads. The answers do not depend on which cells were made before.
class NearestCells {
 public:
  // With as much memory as queries from everywhere in the box use, about: 256 bytes a sphere, at
  // least 64 MiB and at most 4 GiB.
  NearestCells(std::vector<Sphere> spheres, const Eigen::AlignedBox3d& box);
  // Cells take up to `memory` bytes in all, beside that of the whole box; where that is used up,
  // lists stay as long as they are, and the hierarchy is searched where one is missing: slower by
  // far where very many spheres are nearly tied.
  NearestCells(std::vector<Sphere> spheres, const Eigen::AlignedBox3d& box, std::size_t memory);
  ~NearestCells();

  // What SphereHierarchy::nearest() answers without a tolerance. Outside of the box it is searched.
  NearestSphere nearest(const Eigen::Vector3d& point, double limit) const;

  // What SphereHierarchy::is_any_nearer() answers. For points that are not asked about again: makes
  // no cells.
  bool is_any_nearer(const Eigen::Vector3d& point, double value) const {
    return hierarchy_.is_any_nearer(point, value);
  }

  const std::vector<Sphere>& spheres() const { return spheres_; }
  // Bytes that cells take, beside that of the whole box.
  std::size_t memory_used() const { return used_.load(std::memory_order_relaxed); }

 private:
  struct Cell;

  // Null if there is no room for it.
  const Cell* make_half(const Cell& cell, std::size_t side) const;
  void fill(Cell& cell, const Cell* parent) const;
  // A sphere that is nearest to the middle of a cell, or nearly; -1 if there is none.
  std::int32_t nearest_at(const BoxCell& box, const Cell* parent) const;

  std::vector<Sphere> spheres_;
  SphereHierarchy hierarchy_;
  Eigen::AlignedBox3d box_;
  int first_listed_ = 0;  // halvings before the first lists
  std::size_t memory_;
  std::unique_ptr<Cell> root_;
  mutable std::atomic<std::size_t> used_{0};  // bytes
};

}  // namespace spherule::internal
