// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/cover_moves.h"

#include "base/error.h"
#include "base/random.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "simplifier/solid/medial_ascent.h"
#include "simplifier/solid/solid_query.h"
#include "simplifier/stage2/cover_problem.h"
#include "simplifier/types/zones.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
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

namespace {

constexpr std::size_t kMaxSpheres = 2'000'000;

}  // namespace

void check_max_error(double max_error) {
  if (!(max_error > 0.0 && max_error <= kMaxCoordinate)) {
    throw Error("max error", "must be positive and at most 1e15");
  }
}

void check_options(const CoverOptions& options) {
  const auto usable = [](double x) { return x >= 0.0 && x <= kMaxCoordinate; };
  check_max_error(options.max_error);
  if (!usable(options.min_radius)) throw Error("min radius", "must be a number from 0 to 1e15");
  if (!usable(options.min_internal_diameter)) {
    throw Error("min internal diameter", "must be a number from 0 to 1e15");
  }
  check_zones(options.zones, options.max_error, std::numeric_limits<double>::infinity());
  if (options.effort < 0) throw Error("effort", "must not be negative");
  if (!usable(options.seconds)) throw Error("seconds", "must be a number from 0 to 1e15");
}

void refuse_error_zones(const CoverOptions& options, const std::string& method) {
  if (tightest_error(options.zones, options.max_error) < options.max_error) {
    throw Error("zones", "the method \"" + method + "\" knows one max error only");
  }
}

void check_resolved(const Clearance& clearance, double max_error, double share) {
  if (share * max_error < least_reach(clearance.box())) {
    throw Error("max error", "too small for coordinates of this size");
  }
}

void check_count(std::size_t spheres) {
  if (spheres > kMaxSpheres) {
    throw Error("max error", "too small for this model: more than two million spheres");
  }
}

using Eigen::Vector3d;

SphereInflation::SphereInflation(std::span<const Sphere> spheres, std::vector<double> limits)
    : spheres_(spheres.begin(), spheres.end()), limits_(std::move(limits)) {
  for (const Sphere& sphere : spheres_) least_.push_back(sphere.radius);
  radii_ = least_;
}

bool SphereInflation::require(const Vector3d& point, double reserve) {
  std::vector<double> distance(spheres_.size());
  double most = -std::numeric_limits<double>::infinity();  // of the point's depth
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    distance[i] = (spheres_[i].center - point).norm();
    most = std::max(most, limits_[i] - distance[i]);
  }
  reserve = std::min(reserve, most);
  Demand demand;
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    const double needed = distance[i] + reserve;
    // The sphere that sets `most` is meant to offer itself whatever the rounding.
    if (needed <= limits_[i] || limits_[i] - distance[i] == most) {
      demand.push_back({static_cast<std::uint32_t>(i), std::min(needed, limits_[i])});
    }
  }
  if (demand.empty() || is_met(demand)) return false;
  std::sort(demand.begin(), demand.end(), [&](const Offer& a, const Offer& b) {
    return std::pair(inflation(a), a.sphere) < std::pair(inflation(b), b.sphere);
  });
  demands_.push_back(std::move(demand));
  return true;
}

bool SphereInflation::grow_fully_about(const Vector3d& point, double reach) {
  bool any = false;
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    if ((spheres_[i].center - point).norm() > limits_[i] + reach) continue;
    any = any || least_[i] < limits_[i];
    least_[i] = limits_[i];
  }
  return any;
}

bool SphereInflation::is_met(const Demand& demand) const {
  return std::ranges::any_of(demand, [&](const Offer& o) { return radii_[o.sphere] >= o.radius; });
}

void SphereInflation::solve() {
  radii_ = least_;
  std::vector<std::size_t> order(demands_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return inflation(demands_[a].front()) > inflation(demands_[b].front());
  });
  for (const std::size_t d : order) {
    if (is_met(demands_[d])) continue;
    const auto cheapest = std::ranges::min_element(
        demands_[d], {}, [&](const Offer& o) { return o.radius - radii_[o.sphere]; });
    radii_[cheapest->sphere] = cheapest->radius;
  }
  shrink();
}

void SphereInflation::shrink() {
  std::vector<std::vector<std::pair<std::uint32_t, double>>> offers_of(spheres_.size());
  std::vector<std::uint32_t> times(demands_.size(), 0);
  for (std::size_t d = 0; d < demands_.size(); ++d) {
    for (const Offer& o : demands_[d]) {
      offers_of[o.sphere].emplace_back(static_cast<std::uint32_t>(d), o.radius);
      if (radii_[o.sphere] >= o.radius) ++times[d];
    }
  }
  std::vector<std::size_t> order(spheres_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return radii_[a] - least_[a] > radii_[b] - least_[b];
  });
  for (const std::size_t i : order) {
    double needed = least_[i];
    for (const auto& [d, radius] : offers_of[i]) {
      if (radii_[i] >= radius && times[d] == 1) needed = std::max(needed, radius);
    }
    for (const auto& [d, radius] : offers_of[i]) {
      if (radii_[i] >= radius && needed < radius) --times[d];
    }
    radii_[i] = needed;
  }
}

std::vector<Sphere> SphereInflation::spheres() const {
  std::vector<Sphere> inflated(spheres_);
  for (std::size_t i = 0; i < inflated.size(); ++i) inflated[i].radius = radii_[i];
  return inflated;
}

}  // namespace spherule::internal
