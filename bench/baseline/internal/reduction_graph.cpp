// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/internal/reduction_graph.h"

#include "base/rounding.h"
#include "base/threads.h"

#include <algorithm>
#include <array>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kNearest = 3;       // spheres of a point that are neighbours
constexpr std::size_t kNearestLinks = 4;  // of a sphere, where no point joins it to others

struct Near {
  double gap = std::numeric_limits<double>::infinity();
  std::int32_t sphere = -1;
};
using Nearest = std::array<Near, kNearest>;

// The spheres with the least |p - c| - r, the nearest first.
template <class SphereAt>
Nearest nearest_of(const Vector3d& p, std::size_t count, const SphereAt& sphere_at) {
  Nearest best;
  for (std::size_t i = 0; i < count; ++i) {
    const Sphere& sphere = sphere_at(i);
    Near near{(p - sphere.center).norm() - sphere.radius, static_cast<std::int32_t>(i)};
    for (Near& held : best) {
      if (near.gap < held.gap) std::swap(near, held);
    }
  }
  return best;
}

template <class SphereAt>
std::vector<Nearest> nearest_spheres(const ReductionTask& task, std::size_t count,
                                     const SphereAt& sphere_at) {
  std::vector<Nearest> nearest(task.points.size());
  parallel_for(0, nearest.size(), [&](std::size_t k) {
    nearest[k] = nearest_of(task.samples[task.points[k]], count, sphere_at);
  });
  return nearest;
}

}  // namespace

double largest_protrusion(std::span<const FittedSphere> spheres) {
  double largest = 0.0;
  for (const FittedSphere& s : spheres) largest = std::max(largest, s.protrusion());
  return largest;
}

std::vector<FittedSphere> assign_points(const ReductionTask& task) {
  const auto sphere_at = [&](std::size_t i) -> const Sphere& { return task.spheres[i].sphere; };
  const auto nearest = nearest_spheres(task, task.spheres.size(), sphere_at);
  std::vector<FittedSphere> all;
  for (const MedialSphere& s : task.spheres) all.push_back({s.sphere, s.clearance, {}, -1});
  for (std::size_t k = 0; k < task.points.size(); ++k) {
    const std::uint32_t point = task.points[k];
    const Vector3d& p = task.samples[point];
    const Near& near = nearest[k][0];
    if (near.sphere >= 0 && near.gap <= task.max_inflation) {
      FittedSphere& owner = all[static_cast<std::size_t>(near.sphere)];
      owner.points.push_back(point);
      owner.sphere.radius = std::max(owner.sphere.radius, distance_upper(p, owner.sphere.center));
    } else {
      all.push_back({{p, 0.0}, 0.0, {point}, -1});
    }
  }
  std::erase_if(all, [](const FittedSphere& s) { return s.points.empty(); });
  return all;
}

ReductionGraph::ReductionGraph(const ReductionTask& task)
    : nodes_(assign_points(task)),
      links_(nodes_.size()),
      live_(nodes_.size(), true),
      live_count_(nodes_.size()) {
  const auto sphere_at = [&](std::size_t i) -> const Sphere& { return nodes_[i].sphere; };
  for (const Nearest& n : nearest_spheres(task, nodes_.size(), sphere_at)) {
    for (std::size_t a = 0; a < kNearest; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (n[a].sphere < 0 || n[b].sphere < 0) continue;
        link(static_cast<std::uint32_t>(n[a].sphere), static_cast<std::uint32_t>(n[b].sphere));
      }
    }
  }
}

std::vector<std::uint32_t> ReductionGraph::live() const {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
    if (live_[i]) indices.push_back(i);
  }
  return indices;
}

void ReductionGraph::link(std::uint32_t a, std::uint32_t b) {
  if (a == b) return;
  links_[a].insert(b);
  links_[b].insert(a);
}

std::uint32_t ReductionGraph::add(FittedSphere sphere) {
  nodes_.push_back(std::move(sphere));
  links_.emplace_back();
  live_.push_back(true);
  ++live_count_;
  return static_cast<std::uint32_t>(nodes_.size() - 1);
}

void ReductionGraph::remove(std::uint32_t i, std::uint32_t heir) {
  for (const std::uint32_t other : links_[i]) {
    links_[other].erase(i);
    link(other, heir);
  }
  links_[i].clear();
  live_[i] = false;
  --live_count_;
}

void ReductionGraph::link_nearest() {
  const std::vector<std::uint32_t> spheres = live();
  for (const std::uint32_t i : spheres) {
    std::vector<std::pair<double, std::uint32_t>> others;
    for (const std::uint32_t j : spheres) {
      if (j == i) continue;
      others.emplace_back((nodes_[i].sphere.center - nodes_[j].sphere.center).norm(), j);
    }
    const std::size_t count = std::min(kNearestLinks, others.size());
    std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(count),
                      others.end());
    for (std::size_t k = 0; k < count; ++k) link(i, others[k].second);
  }
}

}  // namespace spherule::internal
