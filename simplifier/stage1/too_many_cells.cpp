// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage1/too_many_cells.h"

#include "simplifier/external_spheres.h"

#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

namespace spherule::internal {
namespace {

// What is advised has some room.
constexpr double kMargin = 1.2;
constexpr double kEdgeMargin = 1.1;

std::string too_many(double count, double edge, double most) {
  const double larger = kMargin * count / most;
  std::ostringstream reason;
  reason << std::setprecision(3) << "too fine for a model of this size: up to " << count
         << " cells with an edge of " << edge << " would be needed, and " << most
         << " is the most; with a min external diameter " << std::ceil(10.0 * larger) / 10.0
         << " times as large, or both it and the max error "
         << std::ceil(10.0 * std::sqrt(larger)) / 10.0
         << " times, or with the model in parts, memory suffices";
  if (most < static_cast<double>(ExternalOptions::kMostCells)) {
    reason << "; max_cells may be larger";
  }
  return reason.str();
}

}  // namespace

TooManyCells::TooManyCells(double most_foreseen, double least_foreseen, double edge,
                           std::size_t max_cells)
    : Error("grid step", too_many(most_foreseen, edge, static_cast<double>(max_cells))),
      coarsening_(kEdgeMargin * std::sqrt(least_foreseen / static_cast<double>(max_cells))) {}

}  // namespace spherule::internal
