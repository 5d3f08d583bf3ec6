// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/paper/internal_spheres.h"

#include "base/random.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "geometry/shells.h"
#include "simplifier/solid/best_first.h"
#include "simplifier/solid/medial_ascent.h"
#include "simplifier/solid/solid_query.h"
#include "simplifier/stage2/cover_moves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr double kLeastStep = 0.05;  // of E
// Shares of E: how near a sphere comes to its seed.
constexpr double kNearAtEnd = 0.9;
constexpr double kNearOnTheWay = 0.5;

}  // namespace

SphereInflater::SphereInflater(const Clearance& clearance, const CoverOptions& options)
    : clearance_(clearance),
      max_error_(options.max_error),
      seed_radius_((options.min_internal_diameter > 0.0 ? options.min_internal_diameter
                                                        : options.max_error / 2.0) /
                   2.0) {}

Sphere SphereInflater::operator()(const Vector3d& seed, std::size_t& rejected) const {
  if (clearance_(seed).lower < seed_radius_) ++rejected;
  const std::vector<AscentStep> path =
      ascend(clearance_, seed,
             {.first_step = std::max(seed_radius_, kLeastStep * max_error_),
              .least_step = std::min(seed_radius_, kLeastStep * max_error_)});
  const Sphere inflated = sphere_at(path.back().point);
  if (is_near(inflated, seed, kNearAtEnd)) return inflated;
  // The gap grows along the way, from at most zero; take the last position that keeps it small.
  for (auto it = path.rbegin() + 1; it != path.rend(); ++it) {
    const Sphere sphere = sphere_at(it->point);
    if (is_near(sphere, seed, kNearOnTheWay)) return sphere;
  }
  return {seed, std::max(0.0, clearance_(seed).lower)};
}

// Of negative radius where the centre is outside of S. Inflated, such a sphere would protrude by
// the way to S on top.
Sphere SphereInflater::sphere_at(const Vector3d& center) const {
  return {center, clearance_(center).lower};
}

bool SphereInflater::is_near(const Sphere& sphere, const Vector3d& point, double share) const {
  return sphere.radius >= 0.0 &&
         (point - sphere.center).norm() - sphere.radius <= share * max_error_;
}

void fill_gaps(const Clearance& clearance, const MeshDistance& distance,
               const CoverOptions& options, SphereSet& spheres, std::size_t& seeds_rejected,
               const SphereNote& note) {
  const double limit = kLoopLimit * options.max_error;
  UncoveredSearch search(clearance, distance, limit, kErrorTolerance * options.max_error);
  const SphereInflater grow(clearance, options);
  while (true) {
    const UncoveredSearch::Peak peak = search.next(spheres);
    if (peak.upper <= limit) return;
    const Sphere sphere = grow(peak.point, seeds_rejected);
    if (note) note(peak, sphere);
    spheres.add(sphere);
    check_count(spheres.spheres().size());
    if (options.progress) options.progress(-1.0, "placing internal spheres");
  }
}

CoverageProof remaining_error(const Clearance& clearance, const MeshDistance& distance,
                              const std::vector<Sphere>& spheres, double max_error) {
  const SphereHierarchy hierarchy(spheres);
  return prove_solid(clearance, distance, {spheres, hierarchy}, kErrorTolerance * max_error,
                     [](const Vector3d&) { return true; });
}

void inflate(SphereCover& cover, const std::vector<Sphere>& spheres, double error,
             const CoverOptions& options) {
  cover.spheres_before_inflation = spheres;
  cover.inflation = add_up(error, kProofMargin * options.max_error);
  cover.spheres.clear();
  for (const Sphere& s : spheres) {
    cover.spheres.push_back(
        {s.center, std::max(options.min_radius, add_up(s.radius, cover.inflation))});
  }
}

namespace {

// A point of S stands for a cell outside of it that is no further off than this share of the
// target: a sphere that is nearer to the point than the rest is near enough to the cell.
constexpr double kNear = 0.05;
// The greatest error is bracketed to this share of what it exceeds the target by.
constexpr double kPlateau = 0.1;

}  // namespace

UncoveredSearch::UncoveredSearch(const Clearance& clearance, const MeshDistance& distance,
                                 double target, double tolerance)
    : clearance_(clearance), distance_(distance), target_(target), tolerance_(tolerance) {
  push({BoxCell::around(clearance.box()), std::numeric_limits<double>::infinity(), made_++, false});
}

void UncoveredSearch::push(const Cell& cell) {
  heap_.push_back(cell);
  std::push_heap(heap_.begin(), heap_.end(), BestFirst());
}

UncoveredSearch::Cell UncoveredSearch::pop() {
  std::pop_heap(heap_.begin(), heap_.end(), BestFirst());
  const Cell cell = heap_.back();
  heap_.pop_back();
  return cell;
}

UncoveredSearch::Peak UncoveredSearch::next(const SphereSet& spheres) {
  while (!heap_.empty()) {
    Cell cell = pop();
    const double reach = cell.box.reach();
    const NearestSphere gap = spheres.nearest(cell.box.center);
    cell.upper = std::min(cell.upper, add_up(gap.upper, reach));
    if (cell.upper <= target_) continue;
    if (!heap_.empty() && cell.upper < heap_.front().upper) {
      push(cell);
      continue;
    }
    bool center_inside = cell.inside;
    if (!cell.inside) {
      const CellState state = classify(clearance_, cell.box);
      if (state.outside) continue;
      cell.inside = state.inside;
      center_inside = state.center_inside;
    }
    // As long as the error is far above the target it need not be known closely; plateaus, on which
    // many points are nearly as far as the furthest, would be searched to the bottom.
    const double close = std::max(tolerance_, kPlateau * (cell.upper - target_));
    std::optional<Peak> peak;
    if (center_inside) {
      // With no sphere there is no nearest one either: any point of S will do.
      if (gap.index < 0 || reach <= close) {
        peak = {cell.box.center, cell.upper, std::max(0.0, gap.lower)};
      }
    } else if (reach <= close) {
      peak = peak_beside(cell, spheres);
    }
    if (peak) {
      push(cell);
      return *peak;
    }
    for (const BoxCell& half : cell.box.halves()) push({half, cell.upper, made_++, cell.inside});
  }
  Peak none;
  none.upper = target_;
  return none;
}

std::optional<UncoveredSearch::Peak> UncoveredSearch::peak_beside(const Cell& cell,
                                                                  const SphereSet& spheres) const {
  using Kind = SolidPoint::Kind;
  const auto found = solid_point_for(
      clearance_, distance_, cell.box, {tolerance_, kNear * target_, true},
      [&](const Eigen::Vector3d& on_mesh) { return spheres.nearest(on_mesh).lower > target_; });
  if (!found) return std::nullopt;
  const double lower =
      found->kind == Kind::kInSolid ? std::max(0.0, spheres.nearest(found->point).lower) : 0.0;
  return Peak{found->point, cell.upper, lower};
}

namespace {

using Eigen::Vector3d;

constexpr std::size_t kSurfaceSamples = 20000;
constexpr std::size_t kVolumeSamples = 40000;
constexpr double kFar = std::numeric_limits<double>::infinity();

std::vector<Vector3d> points_on(const TriangleMesh& mesh, std::size_t count, Random& random) {
  std::vector<double> cumulative;
  cumulative.reserve(mesh.triangles.size());
  double total = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto [a, b, c] = corners_of(mesh, t);
    total += (b - a).cross(c - a).norm();
    cumulative.push_back(total);
  }
  std::vector<Vector3d> points(count);
  for (Vector3d& p : points) {
    const auto it = std::upper_bound(cumulative.begin(), cumulative.end(), random.unit() * total);
    const auto i = std::min<std::size_t>(static_cast<std::size_t>(it - cumulative.begin()),
                                         mesh.triangles.size() - 1);
    const auto [a, b, c] = corners_of(mesh, mesh.triangles[i]);
    const double s = std::sqrt(random.unit());
    const double v = random.unit();
    p = (1.0 - s) * a + s * (1.0 - v) * b + s * v * c;
  }
  return points;
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

CoverHistory::CoverHistory(const TriangleMesh& mesh, const MeshDistance& distance,
                           const Eigen::AlignedBox3d& box, double margin, std::uint64_t seed) {
  Random random(seed);
  for (const Vector3d& p : points_on(mesh, kSurfaceSamples, random)) surface_.push_back({p, kFar});
  const Vector3d grow = Vector3d::Constant(margin);
  const Eigen::AlignedBox3d field(box.min() - grow, box.max() + grow);
  std::vector<Vector3d> points(kVolumeSamples);
  for (Vector3d& p : points) p = random.in(field);
  const ClosedShells shells(mesh, distance);
  std::vector<char> inside(points.size());
  parallel_for(0, points.size(), [&](std::size_t i) {
    const bool is_inside = shells.is_mesh_closed()
                               ? shells.contain(points[i])
                               : std::abs(distance.winding_number(points[i])) > 0.5;
    inside[i] = is_inside ? 1 : 0;
  });
  for (std::size_t i = 0; i < points.size(); ++i) {
    (inside[i] != 0 ? solid_ : outside_).push_back({points[i], kFar});
  }
}

void CoverHistory::update(std::vector<Sample>& samples, const Sphere& sphere) {
  for (Sample& s : samples)
    s.gap = std::min(s.gap, (s.point - sphere.center).norm() - sphere.radius);
}

void CoverHistory::add(const Sphere& sphere) {
  for (std::vector<Sample>* samples : {&surface_, &solid_, &outside_}) update(*samples, sphere);
  ++count_;
}

CoverHistoryEntry CoverHistory::entry(double inflation) const {
  const auto covered = [](const std::vector<Sample>& samples, double by) {
    return static_cast<std::size_t>(std::count_if(samples.begin(), samples.end(),
                                                  [by](const Sample& s) { return s.gap <= by; }));
  };
  double furthest = 0.0;
  for (const Sample& s : surface_) furthest = std::max(furthest, s.gap);
  CoverHistoryEntry e;
  e.sphere_count = count_;
  e.surface_error_before = furthest;
  e.surface_error_after = std::max(0.0, furthest - inflation);
  e.coverage_before = share(covered(solid_, 0.0), solid_.size());
  e.coverage_after = share(covered(solid_, inflation), solid_.size());
  e.excess_before = share(covered(outside_, 0.0), solid_.size());
  e.excess_after = share(covered(outside_, inflation), solid_.size());
  return e;
}

SphereCover place_internal_spheres(const TriangleMesh& mesh, const MeshDistance& distance,
                                   const Clearance& clearance, const CoverOptions& options) {
  check_resolved(clearance, options.max_error, kErrorTolerance);
  std::optional<CoverHistory> history;
  if (options.history) {
    history.emplace(mesh, distance, clearance.box(), options.max_error, options.seed);
  }
  SphereSet spheres;
  SphereCover result;
  const auto note = [&](double lower, double upper) {
    if (!history || spheres.spheres().empty()) return;
    CoverHistoryEntry entry = history->entry(upper + kProofMargin * options.max_error);
    entry.max_error_lower = lower;
    entry.max_error_upper = upper;
    result.history.push_back(entry);
  };
  fill_gaps(clearance, distance, options, spheres, result.seeds_rejected,
            [&](const UncoveredSearch::Peak& peak, const Sphere& sphere) {
              note(peak.lower, peak.upper);
              if (history) history->add(sphere);
            });
  // The search ends as soon as no error exceeds the limit; how large it is, the proof finds out.
  const CoverageProof remaining =
      remaining_error(clearance, distance, spheres.spheres(), options.max_error);
  const double error = std::min(kLoopLimit * options.max_error, remaining.upper);
  note(remaining.lower, error);
  inflate(result, spheres.spheres(), error, options);
  return result;
}

}  // namespace spherule::internal
