// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/cover_candidates.h"

#include "simplifier/internal/cube.h"
#include "simplifier/internal/medial_ascent.h"
#include "simplifier/internal/random.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <map>

namespace spherule::internal {
namespace {

constexpr double kClearanceTolerance = 0.02;  // of E
constexpr double kContained = 0.97;
constexpr double kThinning = 0.1;  // of E

// In each cube of the given edge only the candidate with the largest clearance, the first of
// equals.
std::vector<Candidate> thinned(const std::vector<Candidate>& candidates, double edge) {
  std::map<Cube, std::size_t> best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto [at, first] = best.try_emplace(cube_of(candidates[i].center, edge), i);
    if (!first && candidates[i].clearance > candidates[at->second].clearance) at->second = i;
  }
  std::vector<std::size_t> kept;
  for (const auto& [cube, i] : best) kept.push_back(i);
  std::sort(kept.begin(), kept.end());
  std::vector<Candidate> result;
  for (const std::size_t i : kept) result.push_back(candidates[i]);
  return result;
}

}  // namespace

std::vector<Candidate> candidates_from(const Clearance& clearance,
                                       std::span<const Eigen::Vector3d> points, double max_error,
                                       std::uint64_t seed) {
  std::vector<std::vector<Candidate>> each(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    Random random(seed + 0x9e3779b97f4a7c15U * (i + 1));
    const double depth = random.between(0.2, 1.5) * max_error;
    const Eigen::Vector3d start =
        points[i] + depth * clearance(points[i], kClearanceTolerance * max_error).away;
    const std::vector<AscentStep> path = ascend(clearance, start,
                                                {.first_step = random.between(0.1, 0.4) * max_error,
                                                 .least_step = 0.05 * max_error,
                                                 .tolerance = kClearanceTolerance * max_error});
    for (std::size_t k = 0; k < path.size(); ++k) {
      if (path[k].clearance < 0.0) continue;
      // Against a single contact the clearance grows as fast as the point moves, and the next ball
      // contains this one.
      const bool contained =
          k + 1 < path.size() && path[k + 1].clearance - path[k].clearance >=
                                     kContained * (path[k + 1].point - path[k].point).norm();
      if (!contained) each[i].push_back({path[k].point, path[k].clearance});
    }
  });
  std::vector<Candidate> all;
  for (const auto& some : each) all.insert(all.end(), some.begin(), some.end());
  return thinned(all, kThinning * max_error);
}

}  // namespace spherule::internal
