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
  SimplifyOptions coarser_options = options;
  coarser_options.max_error = analysis.coarser_error;
  // Only kCover knows more than one max error; the others were refused zones that ask for one.
  if (options.method != CoverMethod::kCover || options.second_phase) coarser_options.zones.clear();
  coarser_options.effort = std::min(options.effort, kShortSearch);
  coarser_options.seconds = 0.0;
  coarser_options.lower_bound = coarser_options.history = false;
  coarser_options.progress = progress;
  const SphereCover coarser = cover_solid(mesh, result.external, coarser_options);
  analysis.coarser_count = coarser.spheres.size();
  CertifyOptions certify_options;
  certify_options.external = &result.external;
  certify_options.resolution =
      proof_resolution(tightest_error(coarser_options.zones, analysis.coarser_error),
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
