// SPDX-License-Identifier: BSD-3-Clause
#include "base/rounding.h"
#include "base/threads.h"
#include "bench/baseline/internal/sphere_reduction.h"
#include "geometry/weld.h"
#include "simplifier/stage2/search/cover_search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

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

}  // namespace spherule::internal
