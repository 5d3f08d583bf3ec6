// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"
#include "base/threads.h"
#include "bench/baseline/internal/reduction_graph.h"
#include "bench/baseline/internal/sphere_reduction.h"

#include <algorithm>
#include <map>
#include <queue>
#include <set>
#include <tuple>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

struct Bursting {
  double protrusion = 0.0;  // largest of the heirs
  std::uint32_t sphere = 0;
  std::uint32_t version = 0;
};

struct ComesLater {
  bool operator()(const Bursting& a, const Bursting& b) const {
    return std::tie(a.protrusion, a.sphere) > std::tie(b.protrusion, b.sphere);
  }
};

// What a neighbour takes over.
struct Inheritance {
  double radius = 0.0;  // that it needs
  std::vector<std::uint32_t> points;
};

class Burster {
 public:
  explicit Burster(const ReductionTask& task)
      : task_(task), graph_(task), versions_(graph_.size(), 0) {
    const std::vector<std::uint32_t> all = graph_.live();
    evaluate({all.begin(), all.end()});
  }

  void run(const ReductionGoal& goal) {
    const std::size_t wanted = std::max<std::size_t>(1, goal.count);
    while (graph_.live_count() > wanted) {
      if (!drop_stale()) {
        graph_.link_nearest();
        const std::vector<std::uint32_t> all = graph_.live();
        evaluate({all.begin(), all.end()});
        continue;
      }
      const Bursting next = queue_.top();
      if (goal.count == 0 && next.protrusion > goal.max_protrusion) return;
      queue_.pop();
      apply(next.sphere);
    }
  }

  std::vector<FittedSphere> result() const {
    std::vector<FittedSphere> spheres;
    for (const std::uint32_t i : graph_.live()) spheres.push_back(graph_[i]);
    return spheres;
  }

 private:
  std::map<std::uint32_t, Inheritance> heirs_of(std::uint32_t i) const {
    std::map<std::uint32_t, Inheritance> heirs;
    for (const std::uint32_t point : graph_[i].points) {
      const Vector3d& p = task_.samples[point];
      double least = std::numeric_limits<double>::infinity();
      double radius = 0.0;
      std::uint32_t heir = i;
      for (const std::uint32_t j : graph_.neighbours(i)) {
        const double needed = distance_upper(p, graph_[j].sphere.center);
        if (needed - graph_[j].sphere.radius < least) {
          least = needed - graph_[j].sphere.radius;
          radius = needed;
          heir = j;
        }
      }
      Inheritance& part =
          heirs.try_emplace(heir, Inheritance{graph_[heir].sphere.radius, {}}).first->second;
      part.radius = std::max(part.radius, radius);
      part.points.push_back(point);
    }
    return heirs;
  }

  void evaluate(const std::set<std::uint32_t>& changed) {
    const std::vector<std::uint32_t> spheres(changed.begin(), changed.end());
    std::vector<double> protrusions(spheres.size());
    parallel_for(0, spheres.size(), [&](std::size_t k) {
      double largest = -std::numeric_limits<double>::infinity();
      for (const auto& [j, part] : heirs_of(spheres[k])) {
        largest = std::max(largest, part.radius - graph_[j].clearance);
      }
      protrusions[k] = largest;
    });
    for (std::size_t k = 0; k < spheres.size(); ++k) {
      const std::uint32_t i = spheres[k];
      ++versions_[i];
      if (!graph_.neighbours(i).empty()) queue_.push({protrusions[k], i, versions_[i]});
    }
  }

  // False if nothing is left.
  bool drop_stale() {
    while (!queue_.empty()) {
      const Bursting& top = queue_.top();
      if (graph_.is_live(top.sphere) && versions_[top.sphere] == top.version) return true;
      queue_.pop();
    }
    return false;
  }

  void apply(std::uint32_t i) {
    const std::map<std::uint32_t, Inheritance> heirs = heirs_of(i);
    const std::set<std::uint32_t> around = graph_.neighbours(i);
    std::uint32_t main_heir = heirs.begin()->first;
    for (const auto& [j, part] : heirs) {
      if (part.points.size() > heirs.at(main_heir).points.size()) main_heir = j;
      FittedSphere& heir = graph_[j];
      heir.sphere.radius = part.radius;
      heir.points.insert(heir.points.end(), part.points.begin(), part.points.end());
      std::sort(heir.points.begin(), heir.points.end());
    }
    graph_.remove(i, main_heir);
    graph_[i].points = {};
    // The costs of the neighbours of i have changed, and of those that would leave points to an
    // heir.
    std::set<std::uint32_t> changed = around;
    for (const auto& [j, part] : heirs) {
      changed.insert(graph_.neighbours(j).begin(), graph_.neighbours(j).end());
    }
    evaluate(changed);
  }

  const ReductionTask& task_;
  ReductionGraph graph_;
  std::vector<std::uint32_t> versions_;
  std::priority_queue<Bursting, std::vector<Bursting>, ComesLater> queue_;
};

}  // namespace

std::vector<FittedSphere> burst(const ReductionTask& task, const ReductionGoal& goal) {
  Burster burster(task);
  burster.run(goal);
  return burster.result();
}

}  // namespace spherule::internal
