// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/internal/error_search.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace spherule::internal {
namespace {

// Links are refined by so many steps of their ladders at first.
constexpr std::size_t kStride = 2;

}  // namespace

std::vector<double> error_steps(double coarsest, double finest) {
  std::vector<double> result;
  for (int n = 0;; ++n) {
    const double error = coarsest * std::pow(2.0, -0.25 * n);
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

std::optional<std::size_t> ErrorSearch::refused(const ErrorSteps& steps,
                                                std::span<const std::size_t> most_refused) {
  std::size_t result = 0;
  for (std::size_t s = 0; s < samples_.size(); ++s) {
    PostureSet of_sample(samples_[s].sample->free());
    for (std::size_t pair = 0; pair < judge_.pairs().size(); ++pair) {
      of_sample |= alarms(samples_[s], pair, steps);
    }
    const std::size_t count = of_sample.size();
    if (count > most_refused[s]) return std::nullopt;
    result += count;
  }
  return result;
}

// All links of pairs that refuse something: which of them could do with coarser spheres shows
// afterwards, where it is known what all of them do together. One after another, the links that
// look best early are refined far beyond their worth.
bool ErrorSearch::refine(ErrorSteps& steps) {
  std::set<std::pair<std::size_t, std::size_t>> wanted;
  for (Sampled& in : samples_) {
    for (std::size_t pair = 0; pair < judge_.pairs().size(); ++pair) {
      if (alarms(in, pair, steps).size() == 0) continue;
      for (const std::size_t ladder : {first_ladder_[pair], second_ladder_[pair]}) {
        const std::size_t last = ladders_[ladder].errors.size() - 1;
        if (steps[ladder] < last) wanted.emplace(ladder, std::min(steps[ladder] + kStride, last));
      }
    }
  }
  require(std::vector(wanted.begin(), wanted.end()));
  for (const auto& [ladder, step] : wanted) steps[ladder] = step;
  return !wanted.empty();
}

bool ErrorSearch::coarsen_link(std::span<const std::size_t> most_refused, Prefer prefer,
                               ErrorSteps& steps) {
  const std::size_t spheres_now = spheres(steps);
  const auto refused_now = static_cast<double>(*refused(steps, most_refused));
  double best = 0.0;
  ErrorSteps best_steps;
  for (std::size_t ladder = 0; ladder < ladders_.size(); ++ladder) {
    for (std::size_t step = 0; step < steps[ladder]; ++step) {
      if (!ladders_[ladder].trees[step]) continue;
      ErrorSteps next = steps;
      next[ladder] = step;
      const std::size_t count = spheres(next);
      if (count >= spheres_now) continue;
      const std::optional<std::size_t> refused_then = refused(next, most_refused);
      if (!refused_then) continue;
      const auto saved = static_cast<double>(spheres_now - count);
      const double more = std::max(static_cast<double>(*refused_then) - refused_now, 0.5);
      const double worth = prefer == Prefer::kFewestSpheres ? saved : saved / more;
      if (worth <= best) continue;
      best = worth;
      best_steps = next;
    }
  }
  if (best_steps.empty()) return false;
  steps = best_steps;
  return true;
}

ErrorSteps ErrorSearch::coarsened(std::span<const std::size_t> most_refused, ErrorSteps steps) {
  ErrorSteps other = steps;
  while (coarsen_link(most_refused, Prefer::kMostSpheresForEachRefusal, steps)) {
  }
  while (coarsen_link(most_refused, Prefer::kFewestSpheres, other)) {
  }
  return spheres(other) < spheres(steps) ? other : steps;
}

// Refines a link where it was covered finer already, and makes others coarser for it.
bool ErrorSearch::exchange(std::span<const std::size_t> most_refused, ErrorSteps& steps) {
  for (std::size_t ladder = 0; ladder < ladders_.size(); ++ladder) {
    ErrorSteps next = steps;
    if (++next[ladder] >= ladders_[ladder].errors.size() || !ladders_[ladder].trees[next[ladder]] ||
        !refused(next, most_refused)) {
      continue;
    }
    next = coarsened(most_refused, next);
    if (spheres(next) >= spheres(steps)) continue;
    steps = next;
    return true;
  }
  return false;
}

bool ErrorSearch::run(std::span<const std::size_t> most_refused, ErrorSteps& steps,
                      const std::function<void(const char*)>& tell) {
  while (!refused(steps, most_refused)) {
    tell("refining links");
    if (!refine(steps)) return false;
  }
  // The steps between those that were taken.
  std::vector<std::pair<std::size_t, std::size_t>> between;
  for (std::size_t ladder = 0; ladder < steps.size(); ++ladder) {
    if (steps[ladder] > 0) between.emplace_back(ladder, steps[ladder] - 1);
  }
  require(between);
  tell("exchanging spheres");
  steps = coarsened(most_refused, steps);
  while (exchange(most_refused, steps)) {
  }
  return true;
}

}  // namespace spherule::internal
