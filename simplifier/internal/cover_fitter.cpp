// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/internal/cover_fitter.h"

#include "simplifier/internal/cover_moves.h"
#include "simplifier/internal/cover_search.h"
#include "spheretree/rounding.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Shares of E.
constexpr double kSpacing = 0.3;         // half diagonal of the cells that rows stand for
constexpr double kCellRow = 0.1;         // radius of their rows
constexpr double kLeakRow = 0.03;        // radius of the rows that leaks become
constexpr double kFinest = 0.01;         // smallest cell of the proof
constexpr double kSheetReserve = 0.005;  // off the radius where S is as thin as the mesh
constexpr double kLeakSpacing = 0.15;    // leaks become rows this far apart

constexpr std::size_t kMinStarts = 2000;
constexpr std::size_t kMaxStarts = 10000;

constexpr std::uint64_t kWork = 12;     // of a search: visits per entry of the problem
constexpr std::size_t kFirstDrop = 8;   // this part of the count is the first step down
constexpr std::size_t kStepUp = 100;    // this part of the count is a step up
constexpr std::size_t kOpenRows = 100;  // that candidates are made for in a round

// At most `count` of the points, evenly picked.
std::vector<Vector3d> some_of(const std::vector<Vector3d>& points, std::size_t count) {
  if (points.size() <= count) return points;
  std::vector<Vector3d> picked;
  for (std::size_t i = 0; i < count; ++i) picked.push_back(points[i * points.size() / count]);
  return picked;
}

}  // namespace

void CoverFitter::Goal::raise() {
  step = std::max<std::size_t>(1, step / 2);
  target = proved == 0 ? target + 1 + target / kStepUp : easier();
}

void CoverFitter::Goal::reached(std::size_t count, bool first) {
  if (first) step = std::max<std::size_t>(1, count / kFirstDrop);
  proved = count;
  target = count - std::min(step, count - 1);
}

CoverFitter::CoverFitter(const Clearance& clearance, const MeshDistance& distance,
                         const CoverOptions& options)
    : clearance_(clearance),
      options_(options),
      error_(options.max_error),
      cells_(clearance, distance, kSpacing * options.max_error),
      problem_(options.max_error, options.min_radius) {}

std::vector<Sphere> CoverFitter::run() {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  // Of what the options allow for the search.
  const auto share_done = [&](int round) {
    const double rounds = static_cast<double>(round) / std::max(1, options_.effort);
    if (options_.seconds == 0.0) return rounds;
    const std::chrono::duration<double> elapsed = Clock::now() - start;
    return std::max(rounds, elapsed.count() / options_.seconds);
  };
  const Points sample = cells_.sample();
  problem_.add_rows(sample, kCellRow * error_);
  add_candidates(problem_, some_of(sample, std::clamp(sample.size() / 2, kMinStarts, kMaxStarts)),
                 sample);
  solution_ = greedy_set_cover(problem_.instance());
  goal_.target = solution_.size();
  prove_or_learn();
  for (int round = 0; round < options_.effort && best_.size() != 1; ++round) {
    const double share = share_done(round);
    if (share >= 1.0) break;
    report(share);
    if (search()) {
      spread(clearance_, problem_, solution_);
      prove_or_learn();
    } else {
      widen();
    }
  }
  return best_.empty() ? repaired() : best_;
}

bool CoverFitter::search() {
  const std::array<std::size_t, 2> targets{goal_.target, goal_.easier()};
  std::array<std::optional<CoverSearch>, 2> searches;
  std::array<bool, 2> covers{};
  tbb::parallel_for(std::size_t{0}, searches.size(), [&](std::size_t i) {
    searches[i].emplace(problem_.instance(), problem_.columns_of(), solution_,
                        options_.seed + batch_ + i);
    covers[i] = searches[i]->reach(targets[i], kWork * problem_.entries());
  });
  batch_ += searches.size();
  const std::size_t chosen = !covers[0] && covers[1] ? 1 : 0;
  const std::vector<std::uint32_t>& columns = searches[chosen]->best_columns();
  solution_.assign(columns.begin(), columns.end());
  if (!covers[0]) goal_.raise();
  return covers[chosen];
}

void CoverFitter::prove_or_learn() {
  std::vector<Sphere> balls = balls_of(problem_, solution_);
  const SolidCells::Leaks leaks = leaks_of(balls);
  if (!leaks.empty()) {
    learn(problem_, leaks);
    if (best_.empty()) goal_.target += 1 + goal_.target / kStepUp;
  } else if (best_.empty() || balls.size() < best_.size()) {
    goal_.reached(balls.size(), best_.empty());
    best_ = std::move(balls);
  }
}

void CoverFitter::widen() {
  std::vector<std::uint32_t> open = open_rows(problem_, solution_);
  if (open.size() > kOpenRows) open.resize(kOpenRows);
  Points points;
  for (const std::uint32_t row : open) points.push_back(problem_.rows()[row].point);
  problem_.add_candidates(reach_for(clearance_, problem_, solution_, open));
  add_candidates(problem_, points, {});
}

std::vector<Sphere> CoverFitter::repaired() {
  std::vector<Sphere> balls = balls_of(problem_, solution_);
  for (SolidCells::Leaks leaks = leaks_of(balls); !leaks.empty(); leaks = leaks_of(balls)) {
    CoverProblem rest(error_, options_.min_radius);
    learn(rest, leaks);
    const std::vector<Sphere> more = balls_of(rest, greedy_set_cover(rest.instance()));
    balls.insert(balls.end(), more.begin(), more.end());
  }
  return balls;
}

void CoverFitter::learn(CoverProblem& problem, const SolidCells::Leaks& leaks) {
  problem.add_rows(leaks.in_solid, kLeakRow * error_);
  add_candidates(problem, leaks.in_solid, leaks.in_solid);
  std::vector<Candidate> tiny;
  for (const Vector3d& p : leaks.pinched) tiny.push_back({p, -1.0});
  problem.add_rows(leaks.pinched, 0.0);
  problem.add_candidates(tiny);
}

void CoverFitter::add_candidates(CoverProblem& problem, const Points& points, const Points& own) {
  std::vector<Candidate> all =
      candidates_from(clearance_, points, error_, options_.seed + batch_++);
  for (const Vector3d& p : own) all.push_back({p, std::max(0.0, clearance_(p).lower)});
  problem.add_candidates(all);
}

// As stored: the computed clearance of a point of S may be negative by rounding; a little less than
// E can still be proved there.
std::vector<Sphere> CoverFitter::balls_of(const CoverProblem& problem,
                                          const Columns& columns) const {
  std::vector<Sphere> balls;
  for (const std::size_t c : columns) {
    const Candidate& at = problem.candidate(c);
    const double exact = clearance_(at.center).lower;
    const double allowed = at.clearance < 0.0 ? problem.radius(at.clearance)
                           : exact < 0.0      ? error_ * (1.0 - kSheetReserve)
                                              : next_down(add_down(exact, error_));
    balls.push_back({at.center, std::max(options_.min_radius, allowed)});
  }
  return balls;
}

void CoverFitter::report(double share) const {
  if (!options_.progress) return;
  const std::string state = best_.empty() ? std::string("nothing proved yet")
                                          : std::to_string(best_.size()) + " spheres proved";
  options_.progress(share, ("covering: " + state).c_str());
}

SolidCells::Leaks CoverFitter::leaks_of(const std::vector<Sphere>& balls) {
  const BallHierarchy hierarchy(balls);
  return cells_.find_leaks({balls, hierarchy}, kFinest * error_, kLeakSpacing * error_);
}

}  // namespace spherule::internal
