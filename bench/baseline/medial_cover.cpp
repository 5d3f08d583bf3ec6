// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "bench/baseline/medial_spheres.h"
#include "bench/baseline/sphere_methods.h"
#include "simplifier/proof/protrusion.h"
#include "simplifier/solid/cells.h"
#include "simplifier/stage2/cover_moves.h"
#include "simplifier/stage2/cover_problem.h"
#include "simplifier/stage2/paper/internal_spheres.h"
#include "simplifier/stage2/solid_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Shares of E: half diagonal of cells; how far apart points on edges are, and how deep inside of S
// at most.
constexpr double kCells = 0.4;
constexpr double kEdgeSpacing = 0.4;
constexpr double kMostDepth = 0.2;

constexpr double kMostEdgePoints = 1e6;

const TriangleMesh& checked(const TriangleMesh& mesh, const CoverOptions& options,
                            const std::string& method) {
  validate(mesh, "mesh");
  check_options(options);
  refuse_error_zones(options, method);
  return mesh;
}

const Clearance& checked(const Clearance& clearance, double max_error) {
  check_resolved(clearance, max_error, kErrorTolerance);
  return clearance;
}

// The simplified solid S.
struct SimplifiedSolid {
  // Throws Error for a mesh, options and an E that cover() would refuse, and for zones of an E of
  // their own in the name of the method.
  SimplifiedSolid(const TriangleMesh& mesh, const ExternalSpheres& external,
                  const CoverOptions& options, const std::string& method);
  SimplifiedSolid(const SimplifiedSolid&) = delete;
  SimplifiedSolid& operator=(const SimplifiedSolid&) = delete;

  // Points of S, up to rounding, that a cover is made for: one on the boundary in every cell that
  // this crosses, one in the middle of every other, and, since they stick out first, corners and
  // points of the edges of the mesh where they lie on the boundary. (Ridges where external spheres
  // meet elsewhere are left to the proof: what leaks there becomes a sample, too.) At least one.
  std::vector<Eigen::Vector3d> samples(const TriangleMesh& mesh) const;

  double max_error;  // E
  MeshDistance distance;
  Clearance clearance;
  LocalError everywhere;  // E
  SolidCells cells;
};

SimplifiedSolid::SimplifiedSolid(const TriangleMesh& mesh, const ExternalSpheres& external,
                                 const CoverOptions& options, const std::string& method)
    : max_error(options.max_error),
      distance(checked(mesh, options, method)),
      clearance(external),
      everywhere(max_error, {}),
      cells(checked(clearance, max_error), distance, everywhere, max_error, kCells) {}

std::vector<Vector3d> SimplifiedSolid::samples(const TriangleMesh& mesh) const {
  std::vector<Vector3d> points = cells.sample();
  const double spacing = kEdgeSpacing * max_error;
  const double count = std::clamp(total_area(mesh) / (spacing * spacing), 1.0, kMostEdgePoints);
  std::set<Cube> taken;
  for (const Vector3d& p : edge_samples(mesh, static_cast<std::size_t>(count))) {
    if (!taken.insert(cube_of(p, spacing)).second) continue;
    const ClearanceAt at = clearance(p, max_error);
    if (at.lower <= kMostDepth * max_error) points.push_back(p);
  }
  if (points.empty()) {
    points.push_back(mesh.vertices[static_cast<std::size_t>(mesh.triangles.front()[0])]);
  }
  return points;
}

}  // namespace
}  // namespace spherule::internal

namespace spherule {
namespace {

using Eigen::Vector3d;
using internal::FittedSphere;

// Shares of E that the spheres may protrude by before they grow over what they leave uncovered.
// What leaks in one trial is a sample in the next, so that less has to be left for growing.
constexpr std::array kShares{0.7, 0.8, 0.88};
// Rounds of a trial in which all spheres are made anew with what leaked; after those, others are
// added.
constexpr int kRounds = 6;
constexpr int kMendingRounds = 12;

// Medial spheres protrude less than the spheres made of them by this factor.
constexpr double kErrorFactor = 2.0;
constexpr std::size_t kFirstSites = 4000;
constexpr std::size_t kMaxSites = 20000;
// Of E: what is kept of it for the margins of the proof; how near to the boundary of S a sample is
// a site; and how far apart leaks become samples.
constexpr double kReserve = 2.0 * internal::kProofMargin;
constexpr double kAtBoundary = 0.05;
constexpr double kLeakSpacing = 0.2;

std::vector<Sphere> spheres_of(const std::vector<FittedSphere>& fitted) {
  std::vector<Sphere> spheres;
  for (const FittedSphere& f : fitted) spheres.push_back(f.sphere);
  return spheres;
}

std::vector<Sphere> inflated(std::vector<Sphere> spheres, double inflation) {
  for (Sphere& sphere : spheres) sphere.radius = add_up(sphere.radius, inflation);
  return spheres;
}

class MedialCover {
 public:
  MedialCover(const TriangleMesh& mesh, const ExternalSpheres& external,
              const CoverOptions& options)
      : options_(options),
        solid_(mesh, external, options, "medial"),
        probe_(solid_.clearance, solid_.distance),
        samples_(solid_.samples(mesh)),
        axis_(probe_, sites_among(samples_), samples_) {}

  SphereCover run() {
    std::optional<Trial> best;
    for (const double share : kShares) {
      if (options_.progress) options_.progress(-1.0, "reducing medial spheres");
      Trial trial = attempt(share * options_.max_error);
      if (!best || is_better(trial, *best)) best = std::move(trial);
    }
    return std::move(best->cover);
  }

 private:
  struct Trial {
    SphereCover cover;
    double protrusion = 0.0;  // proved, without regard to the least radius
  };

  bool is_proved(const Trial& trial) const { return trial.protrusion <= options_.max_error; }
  bool is_better(const Trial& a, const Trial& b) const {
    if (is_proved(a) != is_proved(b)) return is_proved(a);
    return is_proved(a) ? a.cover.spheres.size() < b.cover.spheres.size()
                        : a.protrusion < b.protrusion;
  }

  std::vector<Vector3d> sites_among(const std::vector<Vector3d>& samples) const {
    std::vector<Vector3d> sites;
    for (std::size_t i = 0; i < samples.size(); i += 1 + samples.size() / kFirstSites) {
      const Vector3d& p = samples[i];
      if (probe_.clearance(p) <= kAtBoundary * options_.max_error) sites.push_back(p);
    }
    return sites;
  }

  // Spheres that protrude by no more than `wanted`, unless the medial spheres do, and hold what
  // leaked so far; then grown over what they leave open.
  Trial attempt(double wanted) {
    axis_.refine({wanted / kErrorFactor, 0, kMaxSites});
    std::vector<FittedSphere> fitted;
    std::size_t anew = 0;  // from this sample on, spheres are yet to be made
    for (int round = 0; round < kRounds + kMendingRounds; ++round) {
      if (round < kRounds) {
        anew = 0;
        fitted.clear();
      }
      const std::vector<FittedSphere> more = reduced(anew, wanted);
      fitted.insert(fitted.end(), more.begin(), more.end());
      anew = samples_.size();
      const double room =
          (1.0 - kReserve) * options_.max_error - internal::largest_protrusion(fitted);
      if (room < 0.0 || !learn_leaks(inflated(spheres_of(fitted), room))) break;
    }
    return finished(spheres_of(fitted));
  }

  // Spheres for the samples from this one on.
  std::vector<FittedSphere> reduced(std::size_t first, double wanted) {
    std::vector<std::uint32_t> points(samples_.size() - first);
    std::iota(points.begin(), points.end(), static_cast<std::uint32_t>(first));
    const internal::ReductionTask task{probe_, samples_, points, axis_.spheres(),
                                       wanted / kErrorFactor};
    const internal::ReductionGoal goal{.count = 0, .max_protrusion = wanted};
    internal::Reduced made = internal::reduce(task, goal, reduction_);
    reduction_ = made.reduction;
    return std::move(made.spheres);
  }

  // False if the spheres are proved to cover S.
  bool learn_leaks(const std::vector<Sphere>& spheres) {
    const internal::SphereHierarchy hierarchy(spheres);
    const internal::SolidCells::Leaks leaks = solid_.cells.find_leaks(
        {spheres, hierarchy}, internal::kErrorTolerance * options_.max_error,
        kLeakSpacing * options_.max_error);
    if (leaks.empty()) return false;
    samples_.insert(samples_.end(), leaks.in_solid.begin(), leaks.in_solid.end());
    samples_.insert(samples_.end(), leaks.pinched.begin(), leaks.pinched.end());
    axis_.watch(samples_);
    return true;
  }

  Trial finished(const std::vector<Sphere>& spheres) const {
    const internal::CoverageProof remaining =
        internal::remaining_error(solid_.clearance, solid_.distance, spheres, options_.max_error);
    Trial trial;
    internal::inflate(trial.cover, spheres, remaining.upper, options_);
    trial.protrusion = internal::greatest(internal::protrusions_over_solid(
        solid_.clearance, solid_.distance, inflated(spheres, trial.cover.inflation)));
    return trial;
  }

  const CoverOptions& options_;
  internal::SimplifiedSolid solid_;
  internal::SimplifiedProbe probe_;
  std::vector<Vector3d> samples_;
  internal::MedialAxis axis_;
  SphereReduction reduction_ = SphereReduction::kBest;  // from the first on, the one that it was
};

}  // namespace

SphereCover medial_cover(const TriangleMesh& mesh, const ExternalSpheres& external,
                         const CoverOptions& options) {
  const internal::ThreadLimit threads(options.threads);
  return MedialCover(mesh, external, options).run();
}

namespace {

void check(const HubbardOptions& options) {
  if (options.counts.empty() || options.counts.front() < 1 ||
      std::adjacent_find(options.counts.begin(), options.counts.end(), std::greater_equal<>()) !=
          options.counts.end()) {
    throw Error("counts", "must ascend from at least 1");
  }
  internal::check_samples("sites", options.sites);
  internal::check_samples("cover points", options.cover_points);
  internal::check_threads(options.threads);
}

}  // namespace

SphereLevels hubbard_spheres(const TriangleMesh& mesh, const HubbardOptions& options) {
  check(options);
  validate(mesh, "mesh");
  const internal::ThreadLimit limit(options.threads);
  const internal::MeshProbe probe(mesh);
  const std::vector<Eigen::Vector3d> samples =
      internal::cover_samples(mesh, options.cover_points, 1, options.seed);
  const internal::MedialAxis axis(probe,
                                  internal::even_samples(mesh, options.sites, 0, options.seed + 1));
  std::vector<std::uint32_t> points(samples.size());
  std::iota(points.begin(), points.end(), 0U);

  // No medial sphere grows by more than the radius that its share of the surface has.
  const double max_inflation = std::sqrt(
      internal::total_area(mesh) / (std::numbers::pi * static_cast<double>(options.counts.back())));
  const std::vector<std::size_t> descending(options.counts.rbegin(), options.counts.rend());
  auto merged =
      internal::merge_levels({probe, samples, points, axis.spheres(), max_inflation}, descending);
  std::reverse(merged.begin(), merged.end());
  SphereLevels result;
  for (const std::vector<internal::FittedSphere>& level : merged) {
    std::vector<Sphere>& spheres = result.levels.emplace_back();
    for (const internal::FittedSphere& s : level) spheres.push_back(s.sphere);
    if (result.levels.size() == 1) continue;
    std::vector<std::int32_t>& parents = result.parents.emplace_back();
    for (const internal::FittedSphere& s : level) parents.push_back(s.merged_into);
  }
  return result;
}

}  // namespace spherule
