// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/cover_fitter.h"

#include "base/random.h"
#include "base/rounding.h"
#include "base/threads.h"
#include "geometry/sphere.h"
#include "simplifier/solid/cells.h"
#include "simplifier/stage2/bound/cover_bound.h"
#include "simplifier/stage2/cover_moves.h"
#include "simplifier/stage2/cover_problem.h"
#include "simplifier/stage2/search/cover_search.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

namespace spherule::internal {
namespace {

using Eigen::Vector3d;

// Half diagonal of the cells that rows stand for, as a share of E or of how far spheres reach
// (SolidCells): at the start the first for which there are not too few of them, in the end the
// first for which there are many.
constexpr std::array kSpacings{0.7, 0.5, 0.3, 0.2, 0.14};
constexpr std::size_t kFewCells = 10000;
constexpr std::size_t kManyCells = 30000;
// Rounds without a better answer, after which cells become finer, a search of more than the default
// effort perturbs spheres, or the search ends: a share of the rounds that are allowed, within
// limits.
constexpr int kPatience = 1;
constexpr int kStuck = 3;
constexpr int kConvergedShare = 4;
constexpr int kConvergedAtLeast = 40;
constexpr int kConvergedAtMost = 400;

// Surroundings of rows: the radii as shares of the cells' spacing and, in all, of E; the discs as
// shares of how much further than E spheres reach.
constexpr double kCellRadius = 0.3;
constexpr double kCellDisc = 0.05;
constexpr double kLargestDisc = 0.5;  // of E: a sphere about the point itself contains them all
constexpr double kLeakRadius = 0.1;   // of the rows that leaks become
constexpr double kLeakDisc = 0.015;

// Shares of E.
constexpr double kFinest = 0.01;       // smallest cell of the proof
constexpr double kLeakSpacing = 0.15;  // leaks become rows this far apart

constexpr std::size_t kStartsPerRow = 10;  // a start for so many rows
constexpr std::size_t kMinStarts = 2000;
constexpr std::size_t kMaxStarts = 10000;
// Times that candidates are grown, again from where no sphere of those before covers: what is still
// left gets a small sphere of its own, of which large thin parts would need a great many.
constexpr int kPasses = 5;

constexpr std::uint64_t kWork = 60;     // of a search: visits per entry of the core it begins with
constexpr std::size_t kSampling = 10;   // a search begins with one of so many rows
constexpr std::size_t kForgetting = 4;  // times as large as it was the problem may grow
// So many leaks more than there are spheres to gain may still be mended by fewer spheres.
constexpr std::size_t kHopefulLeaks = 8;
constexpr std::size_t kOpenRows = 100;        // that candidates are made for in a round
constexpr std::size_t kOpenRowsIfStuck = 30;  // filled up to, where spheres are perturbed, too
constexpr std::size_t kPerturbed = 300;       // spheres at most, in a round

// What a lower bound is made of, for every sphere proved and at least.
constexpr std::size_t kBoundPoints = 240;
constexpr std::size_t kMinBoundPoints = 6000;
constexpr std::size_t kBoundCenters = 60;
constexpr std::size_t kMinBoundCenters = 1000;

// At most `count` of the items, evenly picked.
template <typename Item>
std::vector<Item> some_of(const std::vector<Item>& items, std::size_t count) {
  if (items.size() <= count) return items;
  std::vector<Item> picked;
  for (std::size_t i = 0; i < count; ++i) picked.push_back(items[i * items.size() / count]);
  return picked;
}

}  // namespace

double CoverFitter::finest(double max_error) {
  return kFinest * max_error;
}

double CoverFitter::leak_spacing(double max_error) {
  return kLeakSpacing * max_error;
}

CoverFitter::CoverFitter(const Clearance& clearance, const MeshDistance& distance,
                         const CoverOptions& options, std::span<const Sphere> given,
                         std::vector<BoxCell> part)
    : clearance_(clearance),
      distance_(distance),
      options_(options),
      error_(options.max_error),
      local_(options.max_error, options.zones),
      problem_(options.max_error, options.min_radius, options.zones),
      part_(std::move(part)),
      given_(given.begin(), given.end()) {
  if (part_.empty()) part_.push_back(BoxCell::around(clearance.box()));
  check_resolved(clearance, tightest_error(options.zones, options.max_error), kFinest);
}

CoverFitter::Spheres CoverFitter::run(Spheres proved) {
  // Of what the options allow for the search.
  const auto share_done = [&](int round) {
    const double rounds = static_cast<double>(round) / std::max(1, options_.effort);
    if (options_.seconds == 0.0) return rounds;
    return std::max(rounds, watch_.seconds() / options_.seconds);
  };
  begin(std::move(proved));
  CoverYield yield(options_.effort, CoverOptions{}.effort);
  yield.add(best_.spheres.size());
  const int converged =
      std::clamp(options_.effort / kConvergedShare, kConvergedAtLeast, kConvergedAtMost);
  for (int round = 0; round < options_.effort && best_.spheres.size() > 1; ++round) {
    const double share = share_done(round);
    if (share >= 1.0 || options_.stop.stop_requested()) break;
    report(share);
    in_vain_ = improve() ? 0 : in_vain_ + 1;
    if (in_vain_ >= kPatience && refine()) in_vain_ = 0;
    yield.add(best_.spheres.size());
    if (in_vain_ >= converged || !yield.pays()) break;
  }
  bound();
  return best_;
}

void CoverFitter::divide() {
  cells_.emplace(clearance_, distance_, local_, error_, kSpacings[spacing_], part_);
}

const SolidCells& CoverFitter::divided() {
  if (cells_) return *cells_;
  if (options_.progress) options_.progress(0.0, "covering: dividing the solid");
  divide();
  while (cells_->size() < kFewCells && spacing_ + 1 < kSpacings.size()) {
    ++spacing_;
    divide();
  }
  return *cells_;
}

void CoverFitter::begin(Spheres proved) {
  const auto announce = [&](const char* what) {
    if (options_.progress) options_.progress(0.0, what);
  };
  divided();
  announce("covering: searching for places of spheres");
  build_problem(proved.places);
  first_entries_ = problem_.entries();
  if (!proved.spheres.empty()) {
    best_ = std::move(proved);
    goal_.reached(best_.spheres.size());
    start_from_best();
    return;
  }
  solution_ = greedy_set_cover(problem_.instance());
  announce("covering: proving the first answer");
  prove_or_learn();
}

bool CoverFitter::improve() {
  const std::size_t before = best_.spheres.size();
  if (search()) {
    spread(clearance_, problem_, solution_);
    prove_or_learn();
  } else if (!options_.stop.stop_requested()) {
    widen();
  }
  if (problem_.entries() > kForgetting * first_entries_) forget();
  return best_.spheres.size() < before;
}

bool CoverFitter::refine() {
  if (cells_made_ > kManyCells || spacing_ + 1 == kSpacings.size()) return false;
  ++spacing_;
  const std::vector<CoverProblem::Row> rows = problem_.rows();
  const std::size_t learned = sampled_;
  divide();
  build_problem(best_.places);
  problem_.add_rows(std::span(rows).subspan(learned));
  add_own(problem_, sampled_);
  know_from(sampled_);
  first_entries_ = problem_.entries();
  start_from_best();
  return true;
}

void CoverFitter::start_from_best() {
  solution_.resize(best_.places.size());
  std::iota(solution_.begin(), solution_.end(), std::size_t{0});
  goal_.restart();
}

void CoverFitter::build_problem(const std::vector<Candidate>& candidates) {
  problem_ = CoverProblem(error_, options_.min_radius, options_.zones);
  problem_.add_candidates(candidates);
  cells_made_ = cells_->size();
  Points sample = cells_->sample();
  const SphereHierarchy given(given_);
  std::erase_if(sample, [&](const Vector3d& p) { return given.nearest(p, 0.0).upper < 0.0; });
  sampled_ = sample.size();
  add_rows(problem_, sample, {kCellRadius * kSpacings[spacing_], kCellDisc},
           some_of(sample, std::clamp(sampled_ / kStartsPerRow, kMinStarts, kMaxStarts)));
  known_ = {};
  for (std::size_t row = 0; row < sampled_; row += kSampling) known_.add(row);
}

void CoverFitter::know_from(std::size_t row) {
  for (; row < problem_.rows().size(); ++row) known_.add(row);
}

void CoverFitter::bound() {
  if (!options_.lower_bound || options_.min_radius > 0.0 || !given_.empty()) return;
  if (options_.stop.stop_requested()) return;
  Points points;
  for (const CoverProblem::Row& row : problem_.rows()) points.push_back(row.point);
  Points centers;
  for (std::size_t c = 0; c < problem_.instance().columns.size(); ++c) {
    centers.push_back(problem_.candidate(c).center);
  }
  points = some_of(points, kBoundPoints * best_.spheres.size() + kMinBoundPoints);
  centers = some_of(centers, kBoundCenters * best_.spheres.size() + kMinBoundCenters);
  lower_bound_ = cover_bound(
      {clearance_, distance_, error_, points, centers, options_.stop, options_.progress});
}

bool CoverFitter::search() {
  const std::array<std::size_t, 2> targets{goal_.target(), goal_.easier()};
  std::array<std::optional<LazyCoverSearch>, 2> searches;
  std::array<bool, 2> covers{};
  // The second, if the first succeeds; both, if a stop is requested.
  std::array<std::atomic<bool>, 2> unneeded{};
  const std::stop_callback quit(options_.stop, [&] { unneeded[0] = unneeded[1] = true; });
  parallel_for(0, searches.size(), [&](std::size_t i) {
    searches[i].emplace(problem_.instance(), problem_.columns_of(), known_, solution_);
    covers[i] = searches[i]->reach(targets[i], kWork, options_.seed + seeds_used_ + i, unneeded[i]);
    if (i == 0 && covers[0]) unneeded[1] = true;
  });
  seeds_used_ += searches.size();
  const LazyCoverSearch& chosen = *searches[covers[0] ? 0 : 1];
  solution_ = chosen.columns();
  known_ = chosen.known();
  if (!covers[0]) goal_.failed();
  return covers[0] || covers[1];
}

void CoverFitter::prove_or_learn() {
  Spheres spheres = spheres_of(problem_, solution_);
  SolidCells::Leaks leaks = leaks_of(spheres.spheres);
  const std::size_t leak_count = leaks.in_solid.size() + leaks.pinched.size();
  const std::size_t rows = problem_.rows().size();
  if (leak_count > 0) learn(problem_, leaks);
  know_from(rows);
  if (!best_.spheres.empty() &&
      spheres.spheres.size() + leak_count >= best_.spheres.size() + kHopefulLeaks)
    return;
  spheres = mended(std::move(spheres), std::move(leaks));
  if (!best_.spheres.empty() && spheres.spheres.size() >= best_.spheres.size()) return;
  goal_.reached(spheres.spheres.size());
  best_ = std::move(spheres);
  if (options_.on_proved) options_.on_proved(given_.size() + best_.spheres.size());
}

void CoverFitter::widen() {
  const std::vector<std::uint32_t> open =
      some_of(open_rows(problem_.instance(), solution_), kOpenRows);
  Points points;
  for (const std::uint32_t row : open) points.push_back(problem_.rows()[row].point);
  // Where few are left open it takes new places for other spheres, too.
  Random random(options_.seed + seeds_used_++);
  const bool stuck = in_vain_ >= kStuck && options_.effort > CoverOptions{}.effort;
  while (points.size() < (stuck ? kOpenRowsIfStuck : kOpenRows)) {
    points.push_back(problem_.rows()[random.index(problem_.rows().size())].point);
  }
  std::vector<Candidate> wider = reach_for(clearance_, problem_, solution_, open);
  const auto add = [&wider](const std::vector<Candidate>& more) {
    wider.insert(wider.end(), more.begin(), more.end());
  };
  add(candidates_from(clearance_, points, error_, options_.seed + seeds_used_++, local_));
  if (stuck) {
    // Others in each round.
    Columns some = solution_;
    while (some.size() > kPerturbed) {
      std::swap(some[random.index(some.size())], some.back());
      some.pop_back();
    }
    add(perturbed(clearance_, problem_, some, options_.seed + seeds_used_++));
  }
  problem_.add_candidates(wider);
}

CoverFitter::Spheres CoverFitter::mended(Spheres spheres, SolidCells::Leaks leaks) {
  for (; !leaks.empty(); leaks = leaks_of(spheres.spheres)) {
    CoverProblem rest(error_, options_.min_radius, options_.zones);
    learn(rest, leaks);
    spheres.append(spheres_of(rest, greedy_set_cover(rest.instance())));
  }
  return spheres;
}

// The columns of the solution stay, one for every row, and of the others the newer half.
void CoverFitter::forget() {
  const std::size_t count = problem_.instance().columns.size();
  std::vector<char> kept(count, 0);
  for (const std::size_t c : solution_) kept[c] = 1;
  for (const std::vector<std::uint32_t>& columns : problem_.columns_of()) kept[columns.front()] = 1;
  std::fill(kept.begin() + static_cast<std::ptrdiff_t>(count / 2), kept.end(), 1);
  const std::vector<std::size_t> number = problem_.keep_only(kept);
  for (std::size_t& c : solution_) c = number[c];
}

void CoverFitter::learn(CoverProblem& problem, const SolidCells::Leaks& leaks) {
  add_rows(problem, leaks.in_solid, {kLeakRadius * kSpacings[spacing_], kLeakDisc}, leaks.in_solid);
  const std::size_t first = problem.rows().size();
  std::vector<CoverProblem::Row> rows;
  for (const Vector3d& p : leaks.pinched) {
    rows.push_back({.point = p, .radius = kFinest * error_ * local_.scale(p), .pinched = true});
  }
  problem.add_rows(rows);
  add_own(problem, first);
}

void CoverFitter::add_rows(CoverProblem& problem, const Points& points,
                           const Surroundings& surroundings, const Points& starts) {
  const std::size_t first = problem.rows().size();
  std::vector<CoverProblem::Row> rows(points.size());
  parallel_for(0, points.size(), [&](std::size_t i) {
    const Vector3d& p = points[i];
    const double error = error_ * local_.scale(p);
    const ClearanceAt at = clearance_(p);
    const double width = cap_width_at(clearance_, p, at, error);
    const double disc = std::min(surroundings.disc * (width - error), kLargestDisc * error);
    rows[i] = {p, surroundings.radius * error, disc, at.away};
  });
  problem.add_rows(rows);
  Points inflated_from = starts;
  for (int pass = 0; pass < kPasses && !inflated_from.empty(); ++pass) {
    problem.add_candidates(
        candidates_from(clearance_, inflated_from, error_, options_.seed + seeds_used_++, local_));
    inflated_from = some_of(uncoverable(problem, first), kMaxStarts);
  }
  add_own(problem, first);
}

CoverFitter::Points CoverFitter::uncoverable(const CoverProblem& problem, std::size_t row) {
  Points points;
  for (; row < problem.rows().size(); ++row) {
    if (problem.columns_of()[row].empty()) points.push_back(problem.rows()[row].point);
  }
  return points;
}

void CoverFitter::add_own(CoverProblem& problem, std::size_t row) const {
  std::vector<Candidate> own;
  for (; row < problem.rows().size(); ++row) {
    if (!problem.columns_of()[row].empty()) continue;
    const auto& [point, radius, disc, normal, pinched] = problem.rows()[row];
    own.push_back({point, pinched ? kPinched : std::max(0.0, clearance_(point).lower)});
  }
  problem.add_candidates(own);
}

CoverFitter::Spheres CoverFitter::spheres_of(const CoverProblem& problem,
                                             const Columns& columns) const {
  Spheres spheres;
  for (const std::size_t c : columns) {
    spheres.places.push_back(problem.candidate(c));
    spheres.spheres.push_back(problem.sphere(c, clearance_));
  }
  return spheres;
}

void CoverFitter::report(double share) const {
  if (!options_.progress) return;
  options_.progress(share,
                    ("covering: " + std::to_string(best_.spheres.size()) + " spheres proved" +
                     (lower_bound_ > 0 ? ", at least " + std::to_string(lower_bound_) : ""))
                        .c_str());
}

SolidCells::Leaks CoverFitter::leaks_of(const std::vector<Sphere>& spheres) {
  std::vector<Sphere> all(given_);
  all.insert(all.end(), spheres.begin(), spheres.end());
  const SphereHierarchy hierarchy(all);
  return cells_->find_leaks({all, hierarchy}, finest(error_), leak_spacing(error_));
}

namespace {

using Eigen::Vector3d;

constexpr std::size_t kStarts = 10000;        // of candidates, in all
constexpr std::size_t kStartsPerSphere = 24;  // at most
constexpr std::uint64_t kLevelWork = 50;      // of a search: visits per entry of the problem

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
    const bool covers = search.reach(target, kLevelWork * problem_.entries(), ++seed, unneeded);
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
