// SPDX-License-Identifier: BSD-3-Clause
#include "base/threads.h"
#include "bench/baseline/sphere_reduction.h"
#include "geometry/enclosing_sphere.h"

#include <algorithm>
#include <iterator>
#include <queue>
#include <tuple>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// A pair and the sphere that would take its place.
struct Merging {
  double protrusion = 0.0;
  std::uint32_t first = 0;
  std::uint32_t second = 0;
  Sphere sphere;
  double clearance = 0.0;
};

struct ComesLater {
  bool operator()(const Merging& a, const Merging& b) const {
    return std::tie(a.protrusion, a.first, a.second) > std::tie(b.protrusion, b.first, b.second);
  }
};

class Merger {
 public:
  explicit Merger(const ReductionTask& task) : task_(task), graph_(task) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (const std::uint32_t i : graph_.live()) add_pairs(i, pairs, true);
    evaluate(pairs);
  }

  void run(const ReductionGoal& goal) {
    const std::size_t wanted = std::max<std::size_t>(1, goal.count);
    while (graph_.live_count() > wanted) {
      const bool has_next = drop_stale();
      if (!has_next) {
        graph_.link_nearest();
        std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
        for (const std::uint32_t i : graph_.live()) add_pairs(i, pairs, true);
        evaluate(pairs);
        continue;
      }
      const Merging next = queue_.top();
      if (goal.count == 0 && next.protrusion > goal.max_protrusion) return;
      queue_.pop();
      apply(next);
    }
  }

  std::vector<FittedSphere> result() const {
    std::vector<FittedSphere> spheres;
    for (const std::uint32_t i : graph_.live()) spheres.push_back(graph_[i]);
    return spheres;
  }
  std::vector<std::uint32_t> live() const { return graph_.live(); }
  // The sphere that holds the points of sphere i now.
  std::uint32_t current(std::uint32_t i) const {
    while (graph_[i].merged_into >= 0) i = static_cast<std::uint32_t>(graph_[i].merged_into);
    return i;
  }

 private:
  // The pairs of sphere i with its neighbours; with `ascending` only those after it.
  void add_pairs(std::uint32_t i, std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs,
                 bool ascending) const {
    for (const std::uint32_t j : graph_.neighbours(i)) {
      if (!ascending || j > i) pairs.emplace_back(std::min(i, j), std::max(i, j));
    }
  }

  Merging merging(std::uint32_t i, std::uint32_t j) const {
    const FittedSphere& a = graph_[i];
    const FittedSphere& b = graph_[j];
    std::vector<Vector3d> points;
    points.reserve(a.points.size() + b.points.size());
    for (const std::uint32_t p : a.points) points.push_back(task_.samples[p]);
    for (const std::uint32_t p : b.points) points.push_back(task_.samples[p]);
    const Sphere both[] = {a.sphere, b.sphere};
    Merging best;
    for (const Sphere& sphere : {enclosing_sphere(std::span<const Vector3d>(points)),
                                 enclosing_sphere(std::span<const Sphere>(both))}) {
      const double clearance = task_.probe.clearance(sphere.center);
      const double protrusion = sphere.radius - clearance;
      const bool is_first = best.first == best.second;
      if (is_first || protrusion < best.protrusion) best = {protrusion, i, j, sphere, clearance};
    }
    return best;
  }

  void evaluate(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
    std::vector<Merging> found(pairs.size());
    parallel_for(0, pairs.size(),
                 [&](std::size_t k) { found[k] = merging(pairs[k].first, pairs[k].second); });
    for (const Merging& m : found) queue_.push(m);
  }

  // False if nothing is left.
  bool drop_stale() {
    while (!queue_.empty()) {
      const Merging& top = queue_.top();
      if (graph_.is_live(top.first) && graph_.is_live(top.second)) return true;
      queue_.pop();
    }
    return false;
  }

  void apply(const Merging& m) {
    FittedSphere merged{m.sphere, m.clearance, {}, -1};
    std::merge(graph_[m.first].points.begin(), graph_[m.first].points.end(),
               graph_[m.second].points.begin(), graph_[m.second].points.end(),
               std::back_inserter(merged.points));
    const std::uint32_t heir = graph_.add(std::move(merged));
    for (const std::uint32_t i : {m.first, m.second}) {
      graph_.remove(i, heir);
      graph_[i].merged_into = static_cast<std::int32_t>(heir);
      graph_[i].points = {};
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    add_pairs(heir, pairs, false);
    evaluate(pairs);
  }

  const ReductionTask& task_;
  ReductionGraph graph_;
  std::priority_queue<Merging, std::vector<Merging>, ComesLater> queue_;
};

}  // namespace

std::vector<FittedSphere> merge(const ReductionTask& task, const ReductionGoal& goal) {
  Merger merger(task);
  merger.run(goal);
  return merger.result();
}

std::vector<std::vector<FittedSphere>> merge_levels(const ReductionTask& task,
                                                    std::span<const std::size_t> counts) {
  Merger merger(task);
  std::vector<std::vector<FittedSphere>> levels;
  std::vector<std::uint32_t> before;
  for (const std::size_t count : counts) {
    merger.run({.count = count});
    const std::vector<std::uint32_t> now = merger.live();
    for (std::size_t i = 0; i < before.size(); ++i) {
      const auto place = std::lower_bound(now.begin(), now.end(), merger.current(before[i]));
      levels.back()[i].merged_into = static_cast<std::int32_t>(place - now.begin());
    }
    levels.push_back(merger.result());
    before = now;
  }
  return levels;
}

}  // namespace spherule::internal
