// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "collide/robot/internal/alarm_sample.h"
#include "collide/robot/link_errors.h"

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace spherule::internal {

// A link, the E that it may get, the coarsest first, and the covers that are known.
struct ErrorLadder {
  int link = 0;
  std::vector<double> errors{};
  std::vector<std::shared_ptr<const SphereTree>> trees{};  // for each E; null: not covered yet
};

// E from the coarsest to the finest, each finer by the square root of 2 than the last one.
std::vector<double> error_steps(double coarsest, double finest);

// Which step of its ladder each link is at, by the index of the ladder.
using ErrorSteps = std::vector<std::size_t>;

// The greedy search of choose_link_errors(). Its parts are kept by reference.
class ErrorSearch {
 public:
  ErrorSearch(const AlarmJudge& judge, std::vector<ErrorLadder>& ladders, const CoverLinks& cover,
              PairProofs proofs);

  // The samples of all calls that follow.
  void add_sample(const AlarmSample& sample);

  // Goes on from `steps` until each sample has at most so many refused, and makes links coarser
  // again then. Returns whether it got there; without, all that would help is at its finest.
  bool run(std::span<const std::size_t> most_refused, ErrorSteps& steps,
           const std::function<void(const char*)>& tell);

  std::size_t spheres(const ErrorSteps& steps) const;
  // Links covered so far, each E counted.
  std::size_t covers() const { return covers_; }
  // Covers what is not covered yet of these (a ladder and a step each).
  void require(std::span<const std::pair<std::size_t, std::size_t>> wanted);

 private:
  // What steps come to, in all samples.
  struct Value {
    bool is_feasible = false;
    double excess = 0.0;  // refused postures beyond what may be, as shares, summed
    double alarms = 0.0;  // postures refused by a pair, as shares, summed over pairs
  };
  struct Sampled {
    const AlarmSample* sample = nullptr;
    std::vector<PostureSet> open{};  // of each pair
    std::map<std::tuple<std::size_t, std::size_t, std::size_t>, PostureSet> alarms{};
  };

  const PostureSet& alarms(Sampled& in, std::size_t pair, const ErrorSteps& steps);
  Value value(const ErrorSteps& steps, std::span<const std::size_t> most_refused);
  // Sets of ladders of which each can be refined, and of which one has alarms.
  std::vector<std::vector<std::size_t>> moves(const ErrorSteps& steps);
  bool refine(std::span<const std::size_t> most_refused, ErrorSteps& steps);
  bool coarsen(std::span<const std::size_t> most_refused, ErrorSteps& steps);
  bool can_refine(std::size_t ladder, const ErrorSteps& steps) const {
    return steps[ladder] + 1 < ladders_[ladder].errors.size();
  }

  const AlarmJudge& judge_;
  std::vector<ErrorLadder>& ladders_;
  const CoverLinks& cover_;
  PairProofs proofs_;
  std::vector<std::size_t> first_ladder_;  // of each pair
  std::vector<std::size_t> second_ladder_;
  std::vector<Sampled> samples_;
  std::size_t covers_ = 0;
};

}  // namespace spherule::internal
