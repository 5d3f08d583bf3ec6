// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/cover/alarm_sample.h"
#include "robot/cover/link_errors.h"

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
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

// E from the coarsest to the finest, each finer by the fourth root of 2 than the last one.
std::vector<double> error_steps(double coarsest, double finest);

// Which step of its ladder each link is at, by the index of the ladder.
using ErrorSteps = std::vector<std::size_t>;

// The search of choose_link_errors(). Its parts are kept by reference.
class ErrorSearch {
 public:
  ErrorSearch(const AlarmJudge& judge, std::vector<ErrorLadder>& ladders, const CoverLinks& cover,
              PairProofs proofs);

  // The samples of all calls that follow.
  void add_sample(const AlarmSample& sample);

  // Refines from `steps` on until each sample has at most so many refused, and exchanges spheres
  // that do not matter for ones that do. Returns whether it got there; without, all links that
  // would help are at their finest.
  bool run(std::span<const std::size_t> most_refused, ErrorSteps& steps,
           const std::function<void(const char*)>& tell);

  // Of the covers at these steps.
  std::size_t spheres(const ErrorSteps& steps) const;
  // Links covered so far, each E counted.
  std::size_t covers() const { return covers_; }
  // Covers what is not covered yet of these (a ladder and a step each, each ladder once).
  void require(std::span<const std::pair<std::size_t, std::size_t>> wanted);

 private:
  // What is known of a sample.
  struct Sampled {
    const AlarmSample* sample = nullptr;
    std::vector<PostureSet> open{};  // of each pair
    // Of a pair with the links at these steps.
    std::map<std::tuple<std::size_t, std::size_t, std::size_t>, PostureSet> alarms{};
  };
  // Among covers that are feasible, which one is gone on with.
  enum class Prefer { kFewestSpheres, kMostSpheresForEachRefusal };

  const PostureSet& alarms(Sampled& in, std::size_t pair, const ErrorSteps& steps);
  // How many postures are refused, summed over the samples; none if there are too many in one.
  std::optional<std::size_t> refused(const ErrorSteps& steps,
                                     std::span<const std::size_t> most_refused);
  bool refine(ErrorSteps& steps);
  bool coarsen_link(std::span<const std::size_t> most_refused, Prefer prefer, ErrorSteps& steps);
  ErrorSteps coarsened(std::span<const std::size_t> most_refused, ErrorSteps steps);
  bool exchange(std::span<const std::size_t> most_refused, ErrorSteps& steps);

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
