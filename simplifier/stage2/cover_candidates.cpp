// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/cover_candidates.h"

#include "simplifier/solid/cube.h"
#include "simplifier/solid/medial_ascent.h"
#include "simplifier/stage2/surface_extent.h"
#include "simplifier/support/parallel.h"
#include "simplifier/support/random.h"

#include <algorithm>
#include <cstddef>
#include <map>

namespace spherule::internal {
namespace {

constexpr double kContained = 0.97;
// Of how far a sphere reaches along a plane: those of the best size for an edge, which have a
// clearance of E, stand this share of E apart.
constexpr double kThinning = 0.3;
const double kReachAtEdge = cap_width(1.0, 1.0);

// In each cube, of an edge that grows with the spheres, only the candidate with the largest
// clearance, the first of equals.
std::vector<Candidate> thinned(const std::vector<Candidate>& candidates, double max_error,
                               const LocalError& error) {
  std::map<GradedCube, std::size_t> best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Eigen::Vector3d& center = candidates[i].center;
    const double scale = error.scale(center);
    const double reach = cap_width(candidates[i].clearance / max_error, scale) / kReachAtEdge;
    const auto [at, first] =
        best.try_emplace(graded_cube_of(center, kThinning * max_error, reach), i);
    if (!first && candidates[i].clearance > candidates[at->second].clearance) at->second = i;
  }
  std::vector<std::size_t> kept;
  for (const auto& [cube, i] : best) kept.push_back(i);
  std::sort(kept.begin(), kept.end());
  std::vector<Candidate> result;
  for (const std::size_t i : kept) result.push_back(candidates[i]);
  return result;
}

// Where on the way from one step to the next, between which the error that is allowed changes, it
// begins to.
Candidate turning_point(const Clearance& clearance, const LocalError& error, const AscentStep& from,
                        const AscentStep& to, double allowed) {
  constexpr int kHalvings = 5;
  Candidate found{from.point, from.clearance};
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2.0;
    const Eigen::Vector3d point = from.point + middle * (to.point - from.point);
    const double d = clearance(point).lower;
    if (d >= 0.0 && error.allowance(point, d) == allowed) {
      low = middle;
      found = {point, d};
    } else {
      high = middle;
    }
  }
  return found;
}

}  // namespace

std::vector<Candidate> candidates_from(const Clearance& clearance,
                                       std::span<const Eigen::Vector3d> points, double max_error,
                                       std::uint64_t seed, const LocalError& local) {
  std::vector<std::vector<Candidate>> each(points.size());
  parallel_for(0, points.size(), [&](std::size_t i) {
    Random random(seed_of(seed, i));
    const double error = max_error * local.scale(points[i]);
    const double depth = random.between(0.2, 1.5) * error;
    const Eigen::Vector3d start = points[i] + depth * clearance(points[i]).away;
    const std::vector<AscentStep> path =
        ascend(clearance, start,
               {.first_step = random.between(0.1, 0.4) * error, .least_step = 0.05 * error});
    for (std::size_t k = 0; k < path.size(); ++k) {
      if (path[k].clearance < 0.0) continue;
      if (k + 1 == path.size()) {
        each[i].push_back({path[k].point, path[k].clearance});
        continue;
      }
      // Against a single contact the clearance grows as fast as the point moves, and where the same
      // error is allowed the next sphere contains this one.
      const AscentStep& next = path[k + 1];
      const double allowed = local.allowance(path[k].point, path[k].clearance);
      const double allowed_next = local.allowance(next.point, std::max(0.0, next.clearance));
      const double inflation = (next.clearance - path[k].clearance) + (allowed_next - allowed);
      if (inflation < kContained * (next.point - path[k].point).norm()) {
        each[i].push_back({path[k].point, path[k].clearance});
      }
      if (allowed_next != allowed) {
        each[i].push_back(turning_point(clearance, local, path[k], next, allowed));
      }
    }
  });
  std::vector<Candidate> all;
  for (const auto& some : each) all.insert(all.end(), some.begin(), some.end());
  return thinned(all, max_error, local);
}

}  // namespace spherule::internal
