// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/baseline/internal/sphere_reduction.h"

#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

namespace spherule::internal {

// The spheres of a reduction that are still there, and which are neighbours. Merging and bursting
// work on it.
class ReductionGraph {
 public:
  // The spheres of assign_points, neighbours where both are among the three nearest of some point.
  explicit ReductionGraph(const ReductionTask& task);

  std::size_t size() const {
    return nodes_.size();
  }  // of all indices, those of removed spheres too
  std::size_t live_count() const { return live_count_; }
  bool is_live(std::size_t i) const { return live_[i]; }
  const FittedSphere& operator[](std::size_t i) const { return nodes_[i]; }
  FittedSphere& operator[](std::size_t i) { return nodes_[i]; }
  const std::set<std::uint32_t>& neighbours(std::size_t i) const { return links_[i]; }
  std::vector<std::uint32_t> live() const;  // ascending

  std::uint32_t add(FittedSphere sphere);
  // Takes a sphere out; its neighbours become neighbours of `heir`.
  void remove(std::uint32_t i, std::uint32_t heir);
  // Makes every sphere a neighbour of those nearest to it, where nothing else joins what is left.
  void link_nearest();

 private:
  void link(std::uint32_t a, std::uint32_t b);

  std::vector<FittedSphere> nodes_;
  std::vector<std::set<std::uint32_t>> links_;
  std::vector<bool> live_;
  std::size_t live_count_ = 0;
};

}  // namespace spherule::internal
