// SPDX-License-Identifier: BSD-3-Clause
#include "cli/cover_analysis.h"

#include <algorithm>
#include <sstream>

namespace spherule {
namespace {

constexpr int kShortSearch = 4;  // rounds

}  // namespace

CoverAnalysis analyse(const TriangleMesh& mesh, const Simplification& result,
                      const Progress& progress) {
  const SimplifyOptions& options = result.options;
  CoverAnalysis analysis;
  analysis.breakdown = cover_breakdown(mesh, result.external, result.cover.spheres,
                                       options.max_error, options.threads);
  analysis.coarser_error = 2.0 * options.max_error;
  // The paper's loop knows one max error only.
  const std::vector<Zone> zones =
      options.method == CoverMethod::kCover ? options.zones : std::vector<Zone>{};
  const SphereCover coarser = cover(mesh, result.external,
                                    {.method = options.method,
                                     .max_error = analysis.coarser_error,
                                     .zones = zones,
                                     .min_radius = options.min_radius,
                                     .min_internal_diameter = options.min_internal_diameter,
                                     .seed = options.seed,
                                     .effort = std::min(options.effort, kShortSearch),
                                     .threads = options.threads,
                                     .progress = progress});
  analysis.coarser_count = coarser.spheres.size();
  CertifyOptions certify_options;
  certify_options.external = &result.external;
  certify_options.resolution = proof_resolution(tightest_error(zones, analysis.coarser_error),
                                                result.external.box.diagonal().norm());
  certify_options.protrusion_tolerance = 0.0;
  certify_options.volume = false;
  certify_options.threads = options.threads;
  analysis.coarser_is_covered = certify(mesh, coarser.spheres, certify_options).covered;
  return analysis;
}

Json to_json(const CoverAnalysis& analysis) {
  const CoverBreakdown& breakdown = analysis.breakdown;
  return {{"spheres_by_role",
           {{"edges", breakdown.edges},
            {"thin", breakdown.thin},
            {"faces", breakdown.faces},
            {"inside", breakdown.inside}}},
          {"at_twice_the_error",
           {{"max_error", analysis.coarser_error},
            {"sphere_count", analysis.coarser_count},
            {"covered", analysis.coarser_is_covered}}}};
}

std::string describe(const CoverAnalysis& analysis, const Simplification& result) {
  const CoverBreakdown& breakdown = analysis.breakdown;
  std::ostringstream out;
  out << "where the spheres go: " << breakdown.edges << " along sharp edges, " << breakdown.thin
      << " in thin parts, " << breakdown.faces << " on faces, " << breakdown.inside << " inside\n";
  if (result.cover.lower_bound > 0) {
    out << "lower bound: no cover at this error has fewer than " << result.cover.lower_bound
        << " spheres\n";
  }
  out << "at a max error of " << analysis.coarser_error << ": " << analysis.coarser_count
      << " spheres after a short search"
      << (analysis.coarser_is_covered ? " (proved to cover)" : " (not proved to cover)") << "\n";
  return out.str();
}

}  // namespace spherule
