// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/json.h"
#include "simplifier/cover_breakdown.h"
#include "simplifier/simplify.h"

#include <string>

namespace spherule {

// What a report says beyond the fit itself: where the count goes, and what twice the E would cost.
struct CoverAnalysis {
  CoverBreakdown breakdown;
  double coarser_error = 0.0;       // 2 E
  std::size_t coarser_count = 0;    // of a cover of the same simplified solid
  bool coarser_is_covered = false;  // proved by a certificate
};

// Fits once more at 2 E, with a short search.
CoverAnalysis analyse(const TriangleMesh& mesh, const Simplification& result,
                      const Progress& progress);

Json to_json(const CoverAnalysis& analysis);
std::string describe(const CoverAnalysis& analysis, const Simplification& result);

}  // namespace spherule
