// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/bound/cover_bound.h"

#include "simplifier/stage2/bound/fractional_packing.h"
#include "simplifier/stage2/bound/heaviest_spheres.h"
#include "simplifier/support/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;
using Weights = std::vector<double>;

// A round packs the points, bounds what any sphere holds, and hands on what cells of centres hold
// that are too heavy, as sets that are packed next.
struct Round {
  double finest;  // half diagonal of the smallest cells, share of E
  double news;    // what a cell holds is handed on if it is heavier by this factor, for a point
};
constexpr std::array kRounds{Round{0.08, 1.3}, Round{0.04, 1.1}, Round{0.03, 1.03},
                             Round{0.03, 1.02}, Round{0.02, 1.02}};
constexpr int kSteps = 300;  // of the packing
// Spheres heavier than 1 by less are not worth finding: the weights are lessened by as much.
constexpr double kReserve = 0.01;
constexpr double kRounding = 1e-9;

std::vector<Vector3d> certain_points(const CoverBoundInput& input) {
  const double slack = HeaviestSpheres::slack(input.clearance, input.max_error);
  std::vector<Vector3d> points;
  for (const Vector3d& p : input.points) {
    if (input.clearance(p).lower >= 0.0 || input.distance(p, slack).triangle >= 0) {
      points.push_back(p);
    }
  }
  return points;
}

// Of the weights, each over what the heaviest sphere about the point weighs.
double proved_sum(const Weights& weights, const Weights& heaviest_about) {
  double sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] / heaviest_about[i];
  return sum;
}

}  // namespace

std::size_t cover_bound(const CoverBoundInput& input) {
  if (input.max_error > input.clearance.least_external()) return 1;
  const std::vector<Vector3d> points = certain_points(input);
  if (points.empty()) return 1;
  const HeaviestSpheres spheres(input.clearance, input.max_error, points);
  FractionalPacking packing(points.size());
  std::vector<FractionalPacking::Set> sets(input.centers.size());
  parallel_for(0, sets.size(), [&](std::size_t i) { sets[i] = spheres.held_by(input.centers[i]); });
  packing.add(std::move(sets));
  double best = 1.0;
  for (std::size_t round = 0; round < kRounds.size(); ++round) {
    const auto tell = [&](double share) {
      if (!input.progress) return;
      input.progress((static_cast<double>(round) + share) / kRounds.size(),
                     "proving a lower bound");
    };
    packing.solve(kSteps, input.stop);
    Weights weights = packing.weights();
    for (double& w : weights) w *= 1.0 - kReserve;
    HeaviestSpheres::Found found = spheres.find({.weights = weights,
                                                 .finest = kRounds[round].finest * input.max_error,
                                                 .news = kRounds[round].news,
                                                 .stop = input.stop,
                                                 .tell = tell});
    if (input.stop.stop_requested()) break;
    best = std::max(best, proved_sum(weights, found.about));
    packing.add(std::move(found.held));
  }
  return static_cast<std::size_t>(std::ceil(best * (1.0 - kRounding) - kRounding));
}

}  // namespace spherule::internal
