// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/internal_spheres.h"

#include "simplifier/stage2/cover_checks.h"
#include "simplifier/stage2/cover_history.h"
#include "simplifier/stage2/inscribed_balls.h"

#include <algorithm>
#include <optional>

namespace spherule {

SphereCover place_internal_spheres(const TriangleMesh& mesh, const MeshDistance& distance,
                                   const Clearance& clearance, const CoverOptions& options) {
  internal::check_resolved(clearance, options.max_error, internal::kErrorTolerance);
  std::optional<internal::CoverHistory> history;
  if (options.history) {
    history.emplace(mesh, distance, clearance.box(), options.max_error, options.seed);
  }
  internal::BallSet balls;
  SphereCover result;
  const auto note = [&](double lower, double upper) {
    if (!history || balls.balls().empty()) return;
    CoverHistoryEntry entry = history->entry(upper + internal::kProofMargin * options.max_error);
    entry.max_error_lower = lower;
    entry.max_error_upper = upper;
    result.history.push_back(entry);
  };
  internal::fill_gaps(clearance, distance, options, balls, result.seeds_rejected,
                      [&](const internal::UncoveredSearch::Peak& peak, const Sphere& ball) {
                        note(peak.lower, peak.upper);
                        if (history) history->add(ball);
                      });
  // The search ends as soon as no error exceeds the limit; how large it is, the proof finds out.
  const internal::CoverageProof remaining =
      internal::remaining_error(clearance, distance, balls.balls(), options.max_error);
  const double error = std::min(internal::kLoopLimit * options.max_error, remaining.upper);
  note(remaining.lower, error);
  internal::inflate(result, balls.balls(), error, options);
  return result;
}

}  // namespace spherule
