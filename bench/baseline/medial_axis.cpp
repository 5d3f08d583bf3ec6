// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "bench/baseline/medial_spheres.h"
#include "bench/baseline/sphere_methods.h"
#include "geometry/sphere.h"
#include "simplifier/solid/sphere_hierarchy.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector3d;
using internal::FittedSphere;
using internal::MedialAxis;
using internal::MedialSphere;
using internal::MeshProbe;
using internal::ReductionGoal;
using internal::ReductionTask;

// Medial spheres wanted for every sphere of the result.
constexpr std::size_t kSpheresPerSphere = 4;
// And of the next level of a tree, where each sphere has only those nearby to be made of.
constexpr std::size_t kSpheresPerChild = 16;
// A sphere of the tree is made anew from the medial spheres that come as near to its points as this
// share of its own protrusion.
constexpr double kNear = 0.5;

void check(const MedialSampling& sampling, int threads) {
  internal::check_samples("cover points", sampling.cover_points);
  if (sampling.cover_points_per_triangle > 1000) {
    throw Error("cover points per triangle", "must be at most 1000");
  }
  internal::check_samples("sites", sampling.initial_sites);
  internal::check_samples("most sites", sampling.max_sites, 0);
  if (!(sampling.error_factor > 0.0 && sampling.error_factor <= 1e6)) {
    throw Error("error factor", "must be positive and at most 1e6");
  }
  internal::check_threads(threads);
}

// The solid, what has to be covered, and the medial axis.
struct Sampled {
  Sampled(const TriangleMesh& mesh, const MedialSampling& sampling)
      : probe(mesh),
        samples(internal::cover_samples(mesh, sampling.cover_points,
                                        sampling.cover_points_per_triangle, sampling.seed)),
        axis(probe, internal::even_samples(mesh, sampling.initial_sites, 0, sampling.seed + 1),
             samples),
        all_points(samples.size()),
        area(internal::total_area(mesh)) {
    std::iota(all_points.begin(), all_points.end(), 0U);
  }

  ReductionTask whole(double max_inflation) const {
    return {probe, samples, all_points, axis.spheres(), max_inflation};
  }
  // About how far `count` spheres protrude: no more than the radius of their shares of the surface.
  double share_radius(std::size_t count) const {
    return std::sqrt(area / (std::numbers::pi * static_cast<double>(count)));
  }

  MeshProbe probe;
  std::vector<Vector3d> samples;
  MedialAxis axis;
  std::vector<std::uint32_t> all_points;
  double area;
};

// The medial spheres near the points of a sphere.
std::vector<MedialSphere> spheres_near(const Sampled& sampled, const FittedSphere& sphere) {
  const double reach = kNear * std::max(0.0, sphere.protrusion());
  Eigen::AlignedBox3d box;
  for (const std::uint32_t p : sphere.points) box.extend(sampled.samples[p]);
  std::vector<MedialSphere> near;
  for (const MedialSphere& s : sampled.axis.spheres()) {
    const double far = s.sphere.radius + reach;
    if (box.squaredExteriorDistance(s.sphere.center) > far * far) continue;
    const bool comes_near =
        std::any_of(sphere.points.begin(), sphere.points.end(), [&](std::uint32_t p) {
          return (sampled.samples[p] - s.sphere.center).squaredNorm() <= far * far;
        });
    if (comes_near) near.push_back(s);
  }
  return near;
}

void append_level(SphereLevels& levels, const std::vector<FittedSphere>& spheres) {
  std::vector<Sphere>& level = levels.levels.emplace_back();
  for (const FittedSphere& sphere : spheres) level.push_back(sphere.sphere);
}

}  // namespace

MedialAxisSpheres medial_axis(const TriangleMesh& mesh, const MedialAxisOptions& options) {
  check(options.sampling, options.threads);
  if (!(options.max_protrusion >= 0.0 && options.max_protrusion <= kMaxCoordinate)) {
    throw Error("max protrusion", "must be finite and not negative");
  }
  const bool by_count = options.max_protrusion == 0.0;
  if (by_count && options.spheres < 1) throw Error("spheres", "must be at least 1");
  validate(mesh, "mesh");
  const internal::ThreadLimit limit(options.threads);
  Sampled sampled(mesh, options.sampling);

  ReductionGoal goal;
  std::vector<FittedSphere> best;
  double aim = options.max_protrusion;
  if (by_count) {
    goal.count = options.spheres;
    // First to learn how far so many spheres protrude, then with medial spheres that suit it.
    aim = sampled.share_radius(goal.count);
    sampled.axis.refine({aim, kSpheresPerSphere * goal.count, options.sampling.max_sites});
    best = internal::reduce(sampled.whole(aim), goal, options.reduction).spheres;
    aim = std::min(aim, internal::largest_protrusion(best));
  } else {
    goal.max_protrusion = options.max_protrusion;
  }
  aim /= options.sampling.error_factor;
  sampled.axis.refine({aim, 0, options.sampling.max_sites});
  std::vector<FittedSphere> refined =
      internal::reduce(sampled.whole(aim), goal, options.reduction).spheres;
  if (best.empty() || internal::is_better(refined, best, goal)) best = std::move(refined);

  MedialAxisSpheres result;
  for (const FittedSphere& sphere : best) result.spheres.push_back(sphere.sphere);
  result.protrusion = internal::largest_protrusion(best);
  result.medial_spheres = sampled.axis.spheres().size();
  result.sites = sampled.axis.sites().size();
  result.cover_points = sampled.samples.size();
  return result;
}

SphereLevels medial_axis_tree(const TriangleMesh& mesh, const MedialTreeOptions& options) {
  check(options.sampling, options.threads);
  if (options.branching < 2 || options.branching > 64) {
    throw Error("branching", "must be 2 to 64");
  }
  if (options.depth < 1 || options.depth > 8) throw Error("depth", "must be 1 to 8");
  validate(mesh, "mesh");
  const internal::ThreadLimit limit(options.threads);
  Sampled sampled(mesh, options.sampling);

  const auto branching = static_cast<std::size_t>(options.branching);
  FittedSphere root;
  root.sphere = enclosing_sphere(std::span<const Vector3d>(sampled.samples));
  root.clearance = sampled.probe.clearance(root.sphere.center);
  root.points = sampled.all_points;
  std::vector<FittedSphere> level = {root};
  SphereLevels levels;
  append_level(levels, level);
  for (int depth = 0; depth < options.depth; ++depth) {
    const std::size_t wanted = branching * level.size();
    const double aim = std::min(internal::largest_protrusion(level), sampled.share_radius(wanted)) /
                       options.sampling.error_factor;
    sampled.axis.refine({aim, kSpheresPerChild * wanted, options.sampling.max_sites});
    std::vector<std::vector<FittedSphere>> children(level.size());
    internal::parallel_for(0, level.size(), [&](std::size_t i) {
      const std::vector<MedialSphere> near = spheres_near(sampled, level[i]);
      children[i] = internal::reduce({sampled.probe, sampled.samples, level[i].points, near, aim},
                                     {.count = branching}, options.reduction)
                        .spheres;
    });
    std::vector<FittedSphere> next;
    std::vector<std::int32_t>& parents = levels.parents.emplace_back();
    for (std::size_t i = 0; i < children.size(); ++i) {
      parents.insert(parents.end(), children[i].size(), static_cast<std::int32_t>(i));
      std::move(children[i].begin(), children[i].end(), std::back_inserter(next));
    }
    level = std::move(next);
    append_level(levels, level);
  }
  return levels;
}

}  // namespace spherule

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
