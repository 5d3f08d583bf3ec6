// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"
#include "base/threads.h"
#include "bench/baseline/medial_spheres.h"
#include "geometry/sphere.h"
#include "geometry/weld.h"
#include "simplifier/stage2/search/cover_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <queue>
#include <set>
#include <tuple>
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

// What the reductions start from: each point goes to the medial sphere that holds it deepest, or
// that has to grow least for it, if that is no more than max_inflation. Spheres without points are
// left out.
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

// The spheres of a reduction that are still there, and which are neighbours. Merging and bursting
// work on it.
class ReductionGraph {
 public:
  // The spheres of assign_points, neighbours where both are among the three nearest of some point.
  explicit ReductionGraph(const ReductionTask& task);

  std::size_t size() const { return nodes_.size(); }  // of removed spheres too
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

// What would make one sphere fewer.
struct Step {
  double protrusion = 0.0;   // the largest of the spheres that it makes
  std::uint32_t first = 0;   // the sphere that goes
  std::uint32_t second = 0;  // merging: the other one; bursting: the version of the first
  Sphere sphere = {};        // merging: in the place of both
  double clearance = 0.0;
};

struct ComesLater {
  bool operator()(const Step& a, const Step& b) const {
    return std::tie(a.protrusion, a.first, a.second) > std::tie(b.protrusion, b.first, b.second);
  }
};

// Takes the step that protrudes least, again and again.
class Reducer {
 public:
  explicit Reducer(const ReductionTask& task) : task_(task), graph_(task) {}
  virtual ~Reducer() = default;

  void run(const ReductionGoal& goal) {
    const std::size_t wanted = std::max<std::size_t>(1, goal.count);
    while (graph_.live_count() > wanted) {
      while (!queue_.empty() && is_stale(queue_.top())) queue_.pop();
      if (queue_.empty()) {
        graph_.link_nearest();
        evaluate_all();
        continue;
      }
      const Step next = queue_.top();
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

 protected:
  virtual bool is_stale(const Step& step) const = 0;
  virtual void evaluate_all() = 0;
  virtual void apply(const Step& step) = 0;

  const ReductionTask& task_;
  ReductionGraph graph_;
  std::priority_queue<Step, std::vector<Step>, ComesLater> queue_;
};

class Merger : public Reducer {
 public:
  explicit Merger(const ReductionTask& task) : Reducer(task) { Merger::evaluate_all(); }

  std::vector<std::uint32_t> live() const { return graph_.live(); }
  // The sphere that holds the points of sphere i now.
  std::uint32_t current(std::uint32_t i) const {
    while (graph_[i].merged_into >= 0) i = static_cast<std::uint32_t>(graph_[i].merged_into);
    return i;
  }

 private:
  bool is_stale(const Step& step) const override {
    return !graph_.is_live(step.first) || !graph_.is_live(step.second);
  }

  void evaluate_all() override {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (const std::uint32_t i : graph_.live()) add_pairs(i, pairs, true);
    evaluate(pairs);
  }

  // The pairs of sphere i with its neighbours; with `ascending` only those after it.
  void add_pairs(std::uint32_t i, std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs,
                 bool ascending) const {
    for (const std::uint32_t j : graph_.neighbours(i)) {
      if (!ascending || j > i) pairs.emplace_back(std::min(i, j), std::max(i, j));
    }
  }

  Step merging(std::uint32_t i, std::uint32_t j) const {
    const FittedSphere& a = graph_[i];
    const FittedSphere& b = graph_[j];
    std::vector<Vector3d> points;
    points.reserve(a.points.size() + b.points.size());
    for (const std::uint32_t p : a.points) points.push_back(task_.samples[p]);
    for (const std::uint32_t p : b.points) points.push_back(task_.samples[p]);
    const Sphere both[] = {a.sphere, b.sphere};
    Step best;
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
    std::vector<Step> found(pairs.size());
    parallel_for(0, pairs.size(),
                 [&](std::size_t k) { found[k] = merging(pairs[k].first, pairs[k].second); });
    for (const Step& m : found) queue_.push(m);
  }

  void apply(const Step& m) override {
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
};

// What a neighbour takes over.
struct Inheritance {
  double radius = 0.0;  // that it needs
  std::vector<std::uint32_t> points;
};

class Burster : public Reducer {
 public:
  explicit Burster(const ReductionTask& task) : Reducer(task), versions_(graph_.size(), 0) {
    Burster::evaluate_all();
  }

 private:
  bool is_stale(const Step& step) const override {
    return !graph_.is_live(step.first) || versions_[step.first] != step.second;
  }

  void evaluate_all() override {
    const std::vector<std::uint32_t> all = graph_.live();
    evaluate({all.begin(), all.end()});
  }

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

  void apply(const Step& step) override {
    const std::uint32_t i = step.first;
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

  std::vector<std::uint32_t> versions_;
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

std::vector<FittedSphere> burst(const ReductionTask& task, const ReductionGoal& goal) {
  Burster burster(task);
  burster.run(goal);
  return burster.result();
}

namespace {

constexpr int kBisections = 12;  // of the stand-off distance
// The stand-off distance is searched for with every so many-th point only, so that about these are
// left, and then grows by this factor until it serves all of them.
constexpr std::size_t kSearchPoints = 1500;
constexpr double kStep = 1.02;

class Expander {
 public:
  explicit Expander(const ReductionTask& task) : task_(task), points_(points_of(task)) {
    for (const Vector3d& p : points_) box_.extend(p);
    grid_.emplace(points_, std::max(box_.sizes().maxCoeff() / 32.0, 1e-300));
  }

  std::vector<FittedSphere> at(double stand_off) const {
    std::vector<FittedSphere> spheres;
    for (const MedialSphere& s : task_.spheres) {
      spheres.push_back({{s.sphere.center, s.clearance + stand_off}, s.clearance, {}, -1});
    }
    SetCoverInstance cover{points_.size(), std::vector<std::vector<std::uint32_t>>(spheres.size())};
    parallel_for(0, spheres.size(), [&](std::size_t i) {
      const Sphere& sphere = spheres[i].sphere;
      grid_->find(sphere.center, sphere.radius, cover.columns[i]);
      std::erase_if(cover.columns[i],
                    [&](std::uint32_t k) { return !certainly_contains(sphere, points_[k]); });
    });
    // What is open without them gets spheres about points, which have no room to protrude less.
    std::vector<std::size_t> all(spheres.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    for (const std::uint32_t k : open_rows(cover, all)) {
      spheres.push_back({{points_[k], stand_off}, 0.0, {}, -1});
      std::vector<std::uint32_t> held;
      grid_->find(points_[k], stand_off, held);
      std::erase_if(held, [&](std::uint32_t p) {
        return !certainly_contains(spheres.back().sphere, points_[p]);
      });
      if (held.empty()) held.push_back(k);
      cover.columns.push_back(std::move(held));
    }
    std::vector<std::size_t> chosen = greedy_set_cover(cover);
    std::sort(chosen.begin(), chosen.end());
    return with_points(spheres, cover, chosen);
  }

  // The least stand-off distance found that needs at most `count` spheres; at the diagonal of the
  // box, a sphere about any point of it holds all.
  double stand_off_for(std::size_t count) const {
    double low = 0.0;
    double high = box_.sizes().norm() / 256.0;
    while (at(high).size() > count && high <= box_.sizes().norm()) {
      low = high;
      high *= 2.0;
    }
    for (int k = 0; k < kBisections; ++k) {
      const double middle = (low + high) / 2.0;
      (at(middle).size() <= count ? high : low) = middle;
    }
    return high;
  }

 private:
  static std::vector<Vector3d> points_of(const ReductionTask& task) {
    std::vector<Vector3d> points;
    for (const std::uint32_t i : task.points) points.push_back(task.samples[i]);
    return points;
  }

  // Each point goes to the chosen sphere that holds it deepest.
  std::vector<FittedSphere> with_points(const std::vector<FittedSphere>& spheres,
                                        const SetCoverInstance& cover,
                                        const std::vector<std::size_t>& chosen) const {
    std::vector<FittedSphere> result;
    std::vector<std::size_t> owner(points_.size());
    std::vector<double> least(points_.size(), std::numeric_limits<double>::infinity());
    for (const std::size_t i : chosen) {
      for (const std::uint32_t k : cover.columns[i]) {
        const double gap =
            (points_[k] - spheres[i].sphere.center).norm() - spheres[i].sphere.radius;
        if (gap < least[k]) {
          least[k] = gap;
          owner[k] = result.size();
        }
      }
      result.push_back(spheres[i]);
    }
    for (std::size_t k = 0; k < points_.size(); ++k) {
      result[owner[k]].points.push_back(task_.points[k]);
    }
    std::erase_if(result, [](const FittedSphere& s) { return s.points.empty(); });
    return result;
  }

  const ReductionTask& task_;
  std::vector<Vector3d> points_;
  Eigen::AlignedBox3d box_;
  std::optional<PointGrid> grid_;
};

}  // namespace

std::vector<FittedSphere> expand(const ReductionTask& task, const ReductionGoal& goal) {
  if (task.points.empty()) return {};
  const Expander expander(task);
  if (goal.count == 0) return expander.at(goal.max_protrusion);
  std::vector<std::uint32_t> some;
  for (std::size_t k = 0; k < task.points.size(); k += 1 + task.points.size() / kSearchPoints) {
    some.push_back(task.points[k]);
  }
  ReductionTask search = task;
  search.points = some;
  double stand_off = Expander(search).stand_off_for(goal.count);
  std::vector<FittedSphere> spheres = expander.at(stand_off);
  while (spheres.size() > goal.count) {
    stand_off = std::max(kStep * stand_off, std::numeric_limits<double>::min());
    spheres = expander.at(stand_off);
  }
  return spheres;
}

double largest_protrusion(std::span<const FittedSphere> spheres) {
  double largest = 0.0;
  for (const FittedSphere& s : spheres) largest = std::max(largest, s.protrusion());
  return largest;
}

namespace {

// A radius that is the sum of a clearance and the wanted protrusion may be rounded up.
constexpr double kRounding = 1e-9;

}  // namespace

bool is_better(const std::vector<FittedSphere>& a, const std::vector<FittedSphere>& b,
               const ReductionGoal& goal) {
  const std::pair<double, double> of_a(largest_protrusion(a), static_cast<double>(a.size()));
  const std::pair<double, double> of_b(largest_protrusion(b), static_cast<double>(b.size()));
  if (goal.count > 0) return of_a < of_b;
  const double most = (1.0 + kRounding) * goal.max_protrusion;
  const bool a_holds = of_a.first <= most;
  const bool b_holds = of_b.first <= most;
  if (a_holds != b_holds) return a_holds;
  return a_holds ? of_a.second < of_b.second : of_a < of_b;
}

Reduced reduce(const ReductionTask& task, const ReductionGoal& goal, SphereReduction reduction) {
  switch (reduction) {
    case SphereReduction::kMerge:
      return {reduction, merge(task, goal)};
    case SphereReduction::kBurst:
      return {reduction, burst(task, goal)};
    case SphereReduction::kExpand:
      return {reduction, expand(task, goal)};
    case SphereReduction::kBest:
      break;
  }
  Reduced best = reduce(task, goal, SphereReduction::kMerge);
  for (const SphereReduction other : {SphereReduction::kBurst, SphereReduction::kExpand}) {
    Reduced made = reduce(task, goal, other);
    if (is_better(made.spheres, best.spheres, goal)) best = std::move(made);
  }
  return best;
}

}  // namespace spherule::internal
