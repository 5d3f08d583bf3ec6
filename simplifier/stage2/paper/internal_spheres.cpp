// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/paper/internal_spheres.h"

#include "simplifier/stage2/cover_checks.h"
#include "simplifier/stage2/paper/cover_history.h"
#include "simplifier/stage2/paper/inscribed_spheres.h"

#include <algorithm>
#include <optional>

namespace spherule::internal {

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
