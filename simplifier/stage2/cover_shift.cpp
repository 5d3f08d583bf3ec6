// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/cover_shift.h"

#include <algorithm>
#include <limits>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Shares of E.
constexpr double kFirstStep = 0.2;
constexpr double kLeastStep = 0.01;
constexpr int kMaxSteps = 40;

struct Worst {
  double margin = std::numeric_limits<double>::infinity();
  std::uint32_t row = 0;
};

Worst worst_row(const CoverProblem& problem, const Candidate& candidate,
                std::span<const std::uint32_t> rows) {
  Worst worst;
  const double radius = problem.radius(candidate);
  for (const std::uint32_t row : rows) {
    const double margin = problem.margin(candidate, radius, problem.rows()[row]);
    if (margin < worst.margin) worst = {margin, row};
  }
  return worst;
}

}  // namespace

Candidate shift(const Clearance& clearance, const CoverProblem& problem, const Candidate& start,
                std::span<const std::uint32_t> rows) {
  if (rows.empty()) return start;
  const double max_error = problem.error().allowance(start.center, std::max(0.0, start.clearance));
  ClearanceAt at = clearance(start.center);
  Candidate here{start.center, std::max(start.clearance, at.lower)};
  Worst worst = worst_row(problem, here, rows);
  double step = kFirstStep * max_error;
  for (int i = 0; i < kMaxSteps && step >= kLeastStep * max_error; ++i) {
    const Vector3d furthest = problem.rows()[worst.row].furthest_from(here.center);
    const Vector3d to_row = (furthest - here.center).normalized();
    Vector3d direction = to_row + at.away;
    // The sphere already grows straight away from the row as fast as it moves.
    if (direction.norm() < 1e-3) break;
    direction.normalize();
    const Vector3d next = here.center + step * direction;
    const ClearanceAt there = clearance(next, at.upper + step * (1.0 + 1e-9));
    const Candidate moved{next, there.lower};
    const Worst then = worst_row(problem, moved, rows);
    if (there.lower >= 0.0 && then.margin > worst.margin) {
      here = moved;
      at = there;
      worst = then;
      step *= 1.5;
    } else {
      step *= 0.5;
    }
  }
  return here;
}

}  // namespace spherule::internal
