// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/internal_spheres.h"

#include "simplifier/internal/cover_history.h"
#include "simplifier/internal/medial_ascent.h"
#include "simplifier/internal/proof.h"
#include "simplifier/internal/solid_query.h"
#include "simplifier/internal/uncovered_search.h"
#include "spheretree/error.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace spherule {
namespace {

using Eigen::Vector3d;
using internal::UncoveredSearch;

// Shares of E. The loop stops at kLoopLimit; the rest is kept for the margin below, which lets
// every piece of a subdivision down to that size lie inside a single inflated ball, as the proof
// needs it.
constexpr double kLoopLimit = 0.97;
constexpr double kProofMargin = 0.02;
constexpr double kPeakTolerance = 0.01;
constexpr double kLeastStep = 0.05;
// No part is worth two million balls: the error is then too small for the model.
constexpr std::size_t kMaxSpheres = 2'000'000;

// The ball that grows from a seed at `peak`.
class Grower {
 public:
  Grower(const Clearance& clearance, double max_error, double seed_diameter)
      : clearance_(clearance), max_error_(max_error), seed_radius_(seed_diameter / 2.0) {}

  Sphere operator()(const Vector3d& seed, std::size_t& rejected) const {
    if (clearance_(seed).lower < seed_radius_) ++rejected;
    const std::vector<internal::AscentStep> path =
        internal::ascend(clearance_, seed,
                         {.first_step = std::max(seed_radius_, kLeastStep * max_error_),
                          .least_step = std::min(seed_radius_, kLeastStep * max_error_),
                          .tolerance = kPeakTolerance * max_error_});
    const Sphere grown = ball_at(path.back().point);
    if (is_near(grown, seed, 0.9)) return grown;
    // The gap grows along the way, from at most zero; take the last position that keeps it small.
    for (auto it = path.rbegin() + 1; it != path.rend(); ++it) {
      const Sphere ball = ball_at(it->point);
      if (is_near(ball, seed, 0.5)) return ball;
    }
    return {seed, std::max(0.0, clearance_(seed).lower)};
  }

 private:
  // Of negative radius where the centre is outside of S. Inflated, such a ball would protrude by
  // the way to S on top.
  Sphere ball_at(const Vector3d& c) const { return {c, clearance_(c).lower}; }
  bool is_near(const Sphere& ball, const Vector3d& p, double share) const {
    return ball.radius >= 0.0 && (p - ball.center).norm() - ball.radius <= share * max_error_;
  }

  const Clearance& clearance_;
  double max_error_;
  double seed_radius_;
};

}  // namespace

SphereCover place_internal_spheres(const TriangleMesh& mesh, const Clearance& clearance,
                                   const CoverOptions& options) {
  const double limit = options.max_error * kLoopLimit;
  const double seed_diameter =
      options.min_internal_diameter > 0.0 ? options.min_internal_diameter : options.max_error / 2.0;
  if (kPeakTolerance * options.max_error < internal::least_reach(clearance.box())) {
    throw Error("max error", "below what coordinates of this size resolve");
  }
  const MeshDistance distance(mesh);
  UncoveredSearch search(clearance, distance, limit, kPeakTolerance * options.max_error);
  const Grower grow(clearance, options.max_error, seed_diameter);
  std::optional<internal::CoverHistory> history;
  if (options.history) {
    history.emplace(mesh, clearance.box(), options.max_error, options.seed);
  }
  internal::BallSet balls;
  SphereCover result;
  const auto note = [&](double lower, double upper) {
    if (!history || balls.balls().empty()) return;
    CoverHistoryEntry entry = history->entry(upper + kProofMargin * options.max_error);
    entry.max_error_lower = lower;
    entry.max_error_upper = upper;
    result.history.push_back(entry);
  };
  while (true) {
    const UncoveredSearch::Peak peak = search.next(balls);
    if (peak.upper <= limit) break;
    note(peak.lower, peak.upper);
    const Sphere ball = grow(peak.point, result.seeds_rejected);
    balls.add(ball);
    if (history) history->add(ball);
    if (balls.balls().size() > kMaxSpheres) {
      throw Error("max error", "too small for this model: more than two million spheres");
    }
    if (options.progress) options.progress(-1.0, "placing internal spheres");
  }
  // The search ends as soon as no error exceeds the limit; how large it is, the proof finds out.
  const internal::BallHierarchy hierarchy(balls.balls());
  const internal::CoverageProof remaining = internal::prove_solid(
      clearance, distance, {balls.balls(), hierarchy}, kPeakTolerance * options.max_error,
      [](const Vector3d&) { return true; });
  const double error = std::min(limit, remaining.upper);
  note(remaining.lower, error);
  result.spheres_before_inflation = balls.balls();
  result.inflation = add_up(error, kProofMargin * options.max_error);
  for (const Sphere& s : balls.balls()) {
    result.spheres.push_back(
        {s.center, std::max(options.min_radius, add_up(s.radius, result.inflation))});
  }
  return result;
}

}  // namespace spherule
