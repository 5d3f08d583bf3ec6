// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/cover_moves.h"

#include "simplifier/solid/medial_ascent.h"
#include "simplifier/stage2/cover_shift.h"
#include "simplifier/stage2/surface_extent.h"
#include "simplifier/support/parallel.h"
#include "simplifier/support/random.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace spherule::internal {
namespace {

using Columns = CoverProblem::Columns;

constexpr std::size_t kNearest = 8;
constexpr double kLargestMove = 0.4;  // of how far a sphere reaches along a plane, in x, y and z

// For every sphere of the solution the rows that it alone covers.
std::vector<std::vector<std::uint32_t>> exclusive_rows(const CoverProblem& problem,
                                                       const Columns& solution) {
  const std::vector<std::uint32_t> times = times_covered(problem.instance(), solution);
  std::vector<std::vector<std::uint32_t>> exclusive(solution.size());
  for (std::size_t i = 0; i < solution.size(); ++i) {
    for (const std::uint32_t row : problem.instance().columns[solution[i]]) {
      if (times[row] == 1) exclusive[i].push_back(row);
    }
  }
  return exclusive;
}

bool differs(const Candidate& a, const Candidate& b) {
  return a.center != b.center || a.clearance != b.clearance;
}

}  // namespace

void spread(const Clearance& clearance, CoverProblem& problem, Columns& solution) {
  const auto exclusive = exclusive_rows(problem, solution);
  std::vector<Candidate> shifted(solution.size());
  parallel_for(0, solution.size(), [&](std::size_t i) {
    shifted[i] = shift(clearance, problem, problem.candidate(solution[i]), exclusive[i]);
  });
  Columns replacement(solution);
  std::vector<Candidate> moved;
  for (std::size_t i = 0; i < solution.size(); ++i) {
    if (!differs(shifted[i], problem.candidate(solution[i]))) continue;
    replacement[i] = problem.instance().columns.size() + moved.size();
    moved.push_back(shifted[i]);
  }
  problem.add_candidates(moved);
  const auto& columns = problem.instance().columns;
  std::vector<std::uint32_t> times = times_covered(problem.instance(), solution);
  for (std::size_t i = 0; i < solution.size(); ++i) {
    const std::vector<std::uint32_t>& before = columns[solution[i]];
    const std::vector<std::uint32_t>& after = columns[replacement[i]];
    for (const std::uint32_t row : after) ++times[row];
    for (const std::uint32_t row : before) --times[row];
    if (std::ranges::all_of(before, [&](std::uint32_t row) { return times[row] > 0; })) {
      solution[i] = replacement[i];
    } else {
      for (const std::uint32_t row : before) ++times[row];
      for (const std::uint32_t row : after) --times[row];
    }
  }
}

std::vector<Candidate> reach_for(const Clearance& clearance, const CoverProblem& problem,
                                 const Columns& solution, std::span<const std::uint32_t> open) {
  const auto exclusive = exclusive_rows(problem, solution);
  std::vector<std::vector<Candidate>> found(open.size());
  parallel_for(0, open.size(), [&](std::size_t k) {
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t i = 0; i < solution.size(); ++i) {
      near.emplace_back(-problem.margin(problem.candidate(solution[i]), problem.rows()[open[k]]),
                        i);
    }
    const std::size_t count = std::min(kNearest, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
    near.resize(count);
    for (const auto& [gap, i] : near) {
      std::vector<std::uint32_t> rows = exclusive[i];
      rows.push_back(open[k]);
      const Candidate& start = problem.candidate(solution[i]);
      const Candidate shifted = shift(clearance, problem, start, rows);
      if (differs(shifted, start)) found[k].push_back(shifted);
    }
  });
  std::vector<Candidate> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

std::vector<Candidate> perturbed(const Clearance& clearance, const CoverProblem& problem,
                                 const Columns& columns, std::uint64_t seed) {
  std::vector<Candidate> found(columns.size());
  parallel_for(0, columns.size(), [&](std::size_t i) {
    Random random(seed_of(seed, i));
    const Candidate& from = problem.candidate(columns[i]);
    const double inside = std::max(0.0, from.clearance);
    const double error = problem.error().allowance(from.center, inside);
    // Small ones more often: most spheres are nearly where they should be.
    const double share = random.unit();
    const double size = kLargestMove * share * share * cap_width(inside, error);
    const Eigen::Vector3d by =
        random.in({Eigen::Vector3d::Constant(-size), Eigen::Vector3d::Constant(size)});
    const AscentStep end = ascend(clearance, from.center + by,
                                  {.first_step = 0.1 * error, .least_step = 0.005 * error})
                               .back();
    found[i] = {end.point, end.clearance};
  });
  std::erase_if(found, [](const Candidate& c) { return c.clearance < 0.0; });
  return found;
}

}  // namespace spherule::internal
