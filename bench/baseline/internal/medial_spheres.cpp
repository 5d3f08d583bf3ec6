// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/internal/medial_spheres.h"

#include "base/threads.h"
#include "bench/baseline/internal/voronoi.h"
#include "simplifier/solid/sphere_hierarchy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// New sites of one round, as a share of those there are, and at least.
constexpr double kShare = 0.5;
constexpr std::size_t kLeastBatch = 64;
// Of the radius: a sphere that protrudes by less is as good as the coordinates allow.
constexpr double kSettled = 1e-6;
// Each round makes a share more sites or ends, so few suffice; this only bounds the time.
constexpr int kRounds = 60;

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

// Where a new site is wanted, and how much.
struct Wish {
  double worth = 0.0;
  Vector3d site = Vector3d::Zero();
  std::size_t watched = kNone;  // the watched point that it is, if any
};

}  // namespace

double gap(const Vector3d& point, std::span<const MedialSphere> spheres) {
  double least = std::numeric_limits<double>::infinity();
  for (const MedialSphere& s : spheres) {
    least = std::min(least, (point - s.sphere.center).norm() - s.sphere.radius);
  }
  return least;
}

MedialAxis::MedialAxis(const SolidProbe& probe, std::vector<Vector3d> sites,
                       std::span<const Vector3d> watched)
    : probe_(probe), sites_(std::move(sites)), watched_(watched), is_site_(watched.size(), false) {
  find_spheres();
}

void MedialAxis::watch(std::span<const Vector3d> watched) {
  watched_ = watched;
  is_site_.resize(watched.size(), false);
}

void MedialAxis::find_spheres() {
  const std::vector<VoronoiVertex> vertices = voronoi_vertices(sites_);
  std::vector<MedialSphere> all(vertices.size());
  parallel_for(0, vertices.size(), [&](std::size_t i) {
    const VoronoiVertex& v = vertices[i];
    all[i] = {{v.point, v.radius}, probe_.clearance(v.point)};
  });
  spheres_.clear();
  for (const MedialSphere& s : all) {
    if (s.clearance > 0.0) spheres_.push_back(s);
  }
}

bool MedialAxis::add_sites(const MedialGoal& goal) {
  const bool wants_more = spheres_.size() < goal.min_spheres;
  const double allowed = wants_more ? 0.0 : goal.max_protrusion;
  std::vector<Wish> wishes;
  for (const MedialSphere& s : spheres_) {
    if (s.protrusion() <= std::max(allowed, kSettled * s.sphere.radius)) continue;
    wishes.push_back({s.protrusion(), probe_.nearest_boundary(s.sphere.center), kNone});
  }
  std::vector<Sphere> spheres;
  for (const MedialSphere& s : spheres_) spheres.push_back(s.sphere);
  const SphereHierarchy hierarchy(spheres);
  std::vector<double> gaps(watched_.size());
  parallel_for(0, watched_.size(),
               [&](std::size_t i) { gaps[i] = hierarchy.nearest(watched_[i]).upper; });
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    if (!is_site_[i] && gaps[i] > goal.max_protrusion) wishes.push_back({gaps[i], watched_[i], i});
  }
  std::stable_sort(wishes.begin(), wishes.end(),
                   [](const Wish& a, const Wish& b) { return a.worth > b.worth; });

  const std::size_t room = goal.max_sites > sites_.size() ? goal.max_sites - sites_.size() : 0;
  const auto share = static_cast<std::size_t>(kShare * static_cast<double>(sites_.size()));
  const std::size_t batch = std::min(room, std::max(kLeastBatch, share));
  const std::size_t before = sites_.size();
  // A new site takes effect within the gap that it was made for: others there wait for a round.
  std::vector<Sphere> taken;
  for (const Wish& wish : wishes) {
    if (sites_.size() - before >= batch) break;
    const bool waits = std::any_of(taken.begin(), taken.end(), [&](const Sphere& t) {
      return (wish.site - t.center).norm() <= t.radius;
    });
    if (waits) continue;
    taken.push_back({wish.site, std::isfinite(wish.worth) ? wish.worth : 0.0});
    sites_.push_back(wish.site);
    if (wish.watched != kNone) is_site_[wish.watched] = true;
  }
  return sites_.size() > before;
}

void MedialAxis::refine(const MedialGoal& goal) {
  for (int round = 0; round < kRounds && add_sites(goal); ++round) find_spheres();
}

}  // namespace spherule::internal
