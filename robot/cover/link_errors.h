// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// E link by link, for few spheres and few false alarms.

#include "robot/cover/false_alarms.h"
#include "spheretree/sphere_tree.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace spherule {

// A link and its E, in metres.
struct LinkError {
  int link = 0;
  double max_error = 0.0;
};

// Covers links with spheres, each at its own E, and returns a tree for each; equal for equal input.
// It is called for no link twice at once.
using CoverLinks =
    std::function<std::vector<std::shared_ptr<const SphereTree>>(std::span<const LinkError>)>;

// What is required of E, link by link.
struct LinkErrorOptions {
  double goal = 0.01;  // the largest share of free postures that spheres may refuse, in (0, 1)
  // Between these each link gets its E, in metres; each step is finer by the fourth root of 2.
  double coarsest_error = 0.04;
  double finest_error = 0.0025;
  std::vector<LinkError> fixed{};  // links whose E is not chosen
  // Postures of which at most the goal may be refused, too, one configuration behind the other.
  std::vector<double> given{};
  // Random postures of the search, and which proofs spare tests. Other seeds give the postures by
  // which a choice is verified.
  FalseAlarmOptions sample{.postures = 40000};
};

// The E of a link and the spheres that its cover has.
struct ChosenError {
  int link = 0;
  double max_error = 0.0;
  std::size_t spheres = 0;
};

// E of all links.
struct LinkErrorChoice {
  std::vector<ChosenError> links{};  // in the order of their indices
  std::size_t spheres = 0;           // of all of them
  // Verified: with a confidence of kConfidence, spheres refuse at most the goal among all free
  // postures within the limits, as postures show that the choice was not made by; and at most the
  // goal of the given ones.
  bool is_reached = false;
  double upper_bound = 1.0;  // of that share with that confidence
  FalseAlarms verified{};    // the postures of the verification
  FalseAlarms given{};       // the given ones, if there are any
  // What every link at its coarsest E comes to, in the sample that the choice is made by.
  FalseAlarms coarsest{};
  std::size_t coarsest_spheres = 0;
  std::size_t covers = 0;  // links that were covered for the search, each E counted

  static constexpr double kConfidence = 0.95;
  // A verification takes so many times the postures of the search.
  static constexpr std::size_t kVerification = 5;
};

// Chooses E link by link for few spheres that refuse at most the goal of the free postures.
//
// From the coarsest covers on, all links of pairs that refuse something are refined by a step,
// until at most the goal is refused, less a reserve for chance. Then links are made coarser again
// as long as the goal holds, those that save most spheres for each posture that is then refused
// first, and links are refined again where that lets others save more. What is chosen is covered by
// `final_covers` (null: the same) and verified on new postures; where that fails, the search goes
// on with a larger reserve, up to four times. Each verification has its share of 1 - kConfidence,
// so that the promise holds for the last one. The search is greedy: fewer spheres may do.
//
// `robot` need not have trees; each link with a body is covered. Equal for equal input and options,
// on any number of threads. Throws Error for options out of range, a fixed link without a body, and
// as measure_false_alarms().
LinkErrorChoice choose_link_errors(const RobotModel& robot, std::span<const LinkBody> bodies,
                                   const AllowedCollisions& allowed, const LinkPairs* proofs,
                                   const CoverLinks& search_covers, const CoverLinks& final_covers,
                                   const LinkErrorOptions& options = {});

}  // namespace spherule
