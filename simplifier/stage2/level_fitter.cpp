// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/level_fitter.h"

#include "simplifier/solid/box_cell.h"
#include "simplifier/stage2/cover_candidates.h"
#include "simplifier/stage2/cover_goal.h"
#include "simplifier/stage2/cover_moves.h"
#include "simplifier/stage2/search/cover_search.h"
#include "simplifier/support/random.h"
#include "spheretree/enclosing_sphere.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <limits>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kStarts = 10000;        // of candidates, in all
constexpr std::size_t kStartsPerSphere = 24;  // at most
constexpr std::uint64_t kWork = 50;           // of a search: visits per entry of the problem

// What is kept off E for rounding: of clearances (32 u of the largest coordinate, SphereHierarchy),
// of enclosures, and SphereLevel::kReserve of a radius, which is below twice the box's extent.
double reserve_of(const Clearance& clearance, double max_error) {
  const double size = largest_coordinate(clearance.box()) + clearance.box().diagonal().norm();
  return 256.0 * kUnitRoundoff * size + 2.0 * SphereLevel::kReserve * (size + max_error);
}

}  // namespace

LevelFitter::LevelFitter(const Clearance& clearance, std::span<const Sphere> finer,
                         const CoverOptions& options)
    : clearance_(clearance),
      finer_(finer),
      options_(options),
      error_(options.max_error - reserve_of(clearance, options.max_error)),
      local_(error_, {}),
      problem_(error_, options.min_radius) {
  std::vector<CoverProblem::Row> rows;
  for (const Sphere& sphere : finer) rows.push_back({sphere.center, sphere.radius});
  problem_.add_rows(rows);
}

SphereLevel LevelFitter::run() {
  add_candidates();
  add_own();
  Columns solution = greedy_set_cover(problem_.instance());
  improve(solution);
  const std::vector<std::int32_t> parent = parents(solution);
  SphereLevel level;
  level.parent_of.resize(finer_.size());
  for (std::size_t i = 0; i < solution.size(); ++i) {
    std::vector<Sphere> children;
    for (std::size_t child = 0; child < finer_.size(); ++child) {
      if (parent[child] != static_cast<std::int32_t>(i)) continue;
      children.push_back(finer_[child]);
      level.parent_of[child] = static_cast<std::int32_t>(level.spheres.size());
    }
    if (!children.empty()) level.spheres.push_back(sphere_for(solution[i], children));
  }
  return level;
}

void LevelFitter::add_candidates() {
  const std::size_t each = std::clamp<std::size_t>(
      kStarts / std::max<std::size_t>(1, finer_.size()), 2, kStartsPerSphere);
  Random random(options_.seed);
  const Vector3d reach = Vector3d::Constant(error_);
  std::vector<Vector3d> starts;
  for (const Sphere& sphere : finer_) {
    starts.push_back(sphere.center);
    for (std::size_t i = 1; i < each; ++i) {
      starts.push_back(
          random.in({Vector3d(sphere.center - reach), Vector3d(sphere.center + reach)}));
    }
  }
  problem_.add_candidates(candidates_from(clearance_, starts, error_, options_.seed, local_));
}

void LevelFitter::add_own() {
  std::vector<Candidate> own;
  for (std::size_t row = 0; row < finer_.size(); ++row) {
    if (!problem_.columns_of()[row].empty()) continue;
    // A finer sphere that protrudes by more than it should is enclosed all the same.
    const Sphere& sphere = finer_[row];
    const double least = (sphere.radius - error_) * (1.0 + 4.0 * kUnitRoundoff) +
                         4.0 * kUnitRoundoff * (sphere.radius + error_);
    own.push_back({sphere.center, std::max({0.0, clearance_(sphere.center).lower, least})});
  }
  problem_.add_candidates(own);
}

void LevelFitter::improve(Columns& solution) {
  Columns tried = solution;
  // Unlike CoverGoal it never searches in larger steps again: the rows are all there is to prove.
  std::size_t step = CoverGoal::largest_step(solution.size());
  std::uint64_t seed = options_.seed;
  CoverSearch::Rows all;
  for (std::size_t row = 0; row < finer_.size(); ++row) all.add(row);
  for (int round = 0; round < options_.effort && solution.size() > 1; ++round) {
    const std::size_t target = solution.size() - std::min(step, solution.size() - 1);
    const std::atomic<bool> unneeded{false};
    CoverSearch search(problem_.instance().columns.size(), problem_.columns_of(), all, tried);
    const bool covers = search.reach(target, kWork * problem_.entries(), ++seed, unneeded);
    tried.assign(search.best_columns().begin(), search.best_columns().end());
    if (covers) {
      spread(clearance_, problem_, tried);
      solution = tried;
      continue;
    }
    step = std::max<std::size_t>(1, step / 2);
    const std::vector<std::uint32_t> open = open_rows(problem_.instance(), tried);
    std::vector<Vector3d> points;
    for (const std::uint32_t row : open) points.push_back(finer_[row].center);
    problem_.add_candidates(reach_for(clearance_, problem_, tried, open));
    problem_.add_candidates(candidates_from(clearance_, points, error_, ++seed, local_));
  }
}

std::vector<std::int32_t> LevelFitter::parents(const Columns& solution) const {
  std::vector<std::int32_t> parent(finer_.size(), -1);
  std::vector<double> spare(finer_.size(), -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < solution.size(); ++i) {
    const Candidate& candidate = problem_.candidate(solution[i]);
    for (const std::uint32_t row : problem_.instance().columns[solution[i]]) {
      const double margin = problem_.margin(candidate, problem_.rows()[row]);
      if (margin <= spare[row]) continue;
      spare[row] = margin;
      parent[row] = static_cast<std::int32_t>(i);
    }
  }
  return parent;
}

Sphere LevelFitter::sphere_for(std::size_t column, const std::vector<Sphere>& children) const {
  if (children.size() == 1) return children.front();
  const auto with_reserve = [&](double radius) {
    return std::max(options_.min_radius, mul_up(radius, 1.0 + SphereLevel::kReserve));
  };
  Sphere tight = enclosing_sphere(std::span<const Sphere>(children));
  tight.radius = with_reserve(tight.radius);
  const double clearance = clearance_(tight.center).lower;
  if (clearance >= 0.0 && sub_up(tight.radius, clearance) <= options_.max_error) return tight;
  Sphere own{problem_.candidate(column).center, 0.0};
  for (const Sphere& child : children) {
    own.radius =
        std::max(own.radius, add_up(distance_upper(own.center, child.center), child.radius));
  }
  own.radius = with_reserve(own.radius);
  return own;
}

}  // namespace spherule::internal
