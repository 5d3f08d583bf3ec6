// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/internal/error_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace spherule::internal {
namespace {

// What a pair that still refuses a posture beside others counts, of one that refuses it alone:
// refining both ends in fewer refused postures, where refining either alone does not.
constexpr double kAlarmWeight = 0.05;

}  // namespace

std::vector<double> error_steps(double coarsest, double finest) {
  std::vector<double> result;
  for (int n = 0;; ++n) {
    const double error = coarsest * std::pow(2.0, -0.5 * n);
    // A finest E that is a power of the step is reached in spite of rounding.
    if (error < finest * (1.0 - 1e-9)) return result;
    result.push_back(error);
  }
}

ErrorSearch::ErrorSearch(const AlarmJudge& judge, std::vector<ErrorLadder>& ladders,
                         const CoverLinks& cover, PairProofs proofs)
    : judge_(judge), ladders_(ladders), cover_(cover), proofs_(proofs) {
  const auto ladder_of = [&](int link) {
    const auto found = std::find_if(ladders_.begin(), ladders_.end(),
                                    [&](const ErrorLadder& l) { return l.link == link; });
    return static_cast<std::size_t>(found - ladders_.begin());
  };
  for (const TestedPair& pair : judge_.pairs()) {
    first_ladder_.push_back(ladder_of(pair.first));
    second_ladder_.push_back(ladder_of(pair.second));
  }
}

void ErrorSearch::add_sample(const AlarmSample& sample) {
  Sampled added{&sample, {}, {}};
  for (std::size_t pair = 0; pair < judge_.pairs().size(); ++pair) {
    added.open.push_back(sample.open(pair, proofs_));
  }
  samples_.push_back(std::move(added));
}

void ErrorSearch::require(std::span<const std::pair<std::size_t, std::size_t>> wanted) {
  std::vector<std::pair<std::size_t, std::size_t>> missing;
  std::vector<LinkError> errors;
  for (const auto& [ladder, step] : wanted) {
    if (ladders_[ladder].trees[step]) continue;
    missing.emplace_back(ladder, step);
    errors.push_back({ladders_[ladder].link, ladders_[ladder].errors[step]});
  }
  if (missing.empty()) return;
  std::vector<std::shared_ptr<const SphereTree>> trees = cover_(errors);
  for (std::size_t i = 0; i < missing.size(); ++i) {
    ladders_[missing[i].first].trees[missing[i].second] = std::move(trees[i]);
  }
  covers_ += missing.size();
}

std::size_t ErrorSearch::spheres(const ErrorSteps& steps) const {
  std::size_t result = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    result += ladders_[i].trees[steps[i]]->spheres().size();
  }
  return result;
}

const PostureSet& ErrorSearch::alarms(Sampled& in, std::size_t pair, const ErrorSteps& steps) {
  const std::size_t first = first_ladder_[pair];
  const std::size_t second = second_ladder_[pair];
  const auto key = std::tuple(pair, steps[first], steps[second]);
  const auto known = in.alarms.find(key);
  if (known != in.alarms.end()) return known->second;
  const std::span of_first(&ladders_[first].trees[steps[first]], 1);
  const std::span of_second(&ladders_[second].trees[steps[second]], 1);
  return in.alarms.emplace(key, in.sample->overlaps(pair, of_first, of_second, in.open[pair]))
      .first->second;
}

ErrorSearch::Value ErrorSearch::value(const ErrorSteps& steps,
                                      std::span<const std::size_t> most_refused) {
  Value result{.is_feasible = true};
  for (std::size_t s = 0; s < samples_.size(); ++s) {
    PostureSet refused(samples_[s].sample->free());
    std::size_t alarm_count = 0;
    for (std::size_t pair = 0; pair < judge_.pairs().size(); ++pair) {
      const PostureSet& of_pair = alarms(samples_[s], pair, steps);
      refused |= of_pair;
      alarm_count += of_pair.size();
    }
    const double free = static_cast<double>(std::max<std::size_t>(samples_[s].sample->free(), 1));
    const std::size_t count = refused.size();
    if (count > most_refused[s]) {
      result.is_feasible = false;
      result.excess += static_cast<double>(count - most_refused[s]) / free;
    }
    result.alarms += static_cast<double>(alarm_count) / free;
  }
  return result;
}

std::vector<std::vector<std::size_t>> ErrorSearch::moves(const ErrorSteps& steps) {
  std::set<std::vector<std::size_t>> result;
  for (std::size_t pair = 0; pair < judge_.pairs().size(); ++pair) {
    const bool has_alarms = std::any_of(samples_.begin(), samples_.end(), [&](Sampled& in) {
      return alarms(in, pair, steps).size() > 0;
    });
    if (!has_alarms) continue;
    const std::size_t first = first_ladder_[pair];
    const std::size_t second = second_ladder_[pair];
    if (can_refine(first, steps)) result.insert({first});
    if (can_refine(second, steps)) result.insert({second});
    if (can_refine(first, steps) && can_refine(second, steps)) result.insert({first, second});
  }
  return {result.begin(), result.end()};
}

bool ErrorSearch::refine(std::span<const std::size_t> most_refused, ErrorSteps& steps) {
  const std::vector<std::vector<std::size_t>> all = moves(steps);
  std::vector<std::pair<std::size_t, std::size_t>> wanted;
  for (const std::vector<std::size_t>& move : all) {
    if (move.size() == 1) wanted.emplace_back(move[0], steps[move[0]] + 1);
  }
  require(wanted);
  const Value now = value(steps, most_refused);
  const std::size_t spheres_now = spheres(steps);
  double best = -std::numeric_limits<double>::infinity();
  ErrorSteps best_steps = steps;
  for (const std::vector<std::size_t>& move : all) {
    ErrorSteps next = steps;
    for (const std::size_t ladder : move) ++next[ladder];
    const Value after = value(next, most_refused);
    const double gain = now.excess - after.excess + kAlarmWeight * (now.alarms - after.alarms);
    const std::size_t spheres_after = spheres(next);
    const auto added = static_cast<double>(spheres_after > spheres_now ? spheres_after - spheres_now
                                                                       : std::size_t{1});
    // Of moves that spare nothing, the one that costs least spheres.
    const double worth = gain > 0.0 ? gain / added : gain - added;
    if (worth <= best) continue;
    best = worth;
    best_steps = next;
  }
  const bool moved = best_steps != steps;
  steps = best_steps;
  return moved;
}

bool ErrorSearch::coarsen(std::span<const std::size_t> most_refused, ErrorSteps& steps) {
  const std::size_t spheres_now = spheres(steps);
  std::size_t fewest = spheres_now;
  ErrorSteps best_steps = steps;
  for (std::size_t ladder = 0; ladder < ladders_.size(); ++ladder) {
    for (std::size_t step = 0; step < steps[ladder]; ++step) {
      // Every coarser step was covered on the way to this one.
      ErrorSteps next = steps;
      next[ladder] = step;
      const std::size_t count = spheres(next);
      if (count >= fewest || !value(next, most_refused).is_feasible) continue;
      fewest = count;
      best_steps = next;
    }
  }
  steps = best_steps;
  return fewest < spheres_now;
}

bool ErrorSearch::run(std::span<const std::size_t> most_refused, ErrorSteps& steps,
                      const std::function<void(const char*)>& tell) {
  while (!value(steps, most_refused).is_feasible) {
    tell("refining");
    if (!refine(most_refused, steps)) return false;
  }
  tell("coarsening");
  while (coarsen(most_refused, steps)) {
  }
  return true;
}

}  // namespace spherule::internal
