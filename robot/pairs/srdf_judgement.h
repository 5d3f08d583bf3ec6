// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Is what an SRDF states about pairs of links true, and what could be added to it?

#include "robot/files/robot_description.h"
#include "robot/pairs/link_pairs.h"

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace spherule {

// What is true of two links that an SRDF disables.
enum class DisabledVerdict : std::uint8_t {
  kTouches,     // they do, in a posture within the limits (PairVerdict::kTouching)
  kUnknown,     // neither a contact nor a proof was found
  kNever,       // proved: they never do within the limits
  kAdjacent,    // one joint joins them, directly or past links without bodies
  kRigid,       // no joint moves them against each other
  kNoBody,      // one of them has no body: there is nothing to test
  kOtherRobot,  // one of them is no link of the robot
};

// For people: what stands in tables.
std::string_view name_of(DisabledVerdict verdict);

// A pair of an SRDF, judged.
struct JudgedPair {
  DisabledPair pair;
  DisabledVerdict verdict = DisabledVerdict::kUnknown;
  std::vector<double> witness{};  // where they touch: a configuration
  double smallest_gap = std::numeric_limits<double>::infinity();  // found, in metres; of kUnknown
  // The links touch (kTouches), though the SRDF states that they do not: its reason is not
  // "Default", "Always", "User" or kDisabledByDefault, which are decisions. Any other reason, such
  // as "Never" or "Adjacent", counts as that statement, and so does a missing one.
  bool is_wrong = false;
  // The SRDF states that the links do not touch, as for is_wrong, of links for which neither a
  // contact nor a proof was found (kUnknown).
  bool is_open = false;
};

// An SRDF's list of disabled pairs, judged.
struct SrdfJudgement {
  // In the order of the file; then those that are disabled by the default of a link, of links with
  // bodies.
  std::vector<JudgedPair> pairs{};
  // Pairs of links that are proved never to touch and are not in the list, by their indices.
  std::vector<std::pair<int, int>> could_be_added{};
};

// Judges the disabled pairs of a semantic description by what is proved of the robot's links.
// Throws Error for proofs of another robot, of tighter limits, or of an attached tool.
SrdfJudgement judge_srdf(const RobotModel& robot, const SemanticDescription& semantics,
                         const LinkPairs& proofs);

// The reason of pairs that are proved never to touch, in lists of ignored pairs.
inline constexpr std::string_view kProvedNeverReason = "Never (proved within the limits)";

// The pairs of links that are proved never to touch, by name, for lists of ignored pairs. Throws
// Error for proofs of another robot, of tighter limits, or of an attached tool.
std::vector<DisabledPair> pairs_proved_never(const RobotModel& robot, const LinkPairs& proofs);

// Appends those of the pairs that are about links of the robot and not known yet, in either order.
void add_missing_pairs(std::span<const DisabledPair> pairs, const RobotModel& robot,
                       std::vector<DisabledPair>& known);

}  // namespace spherule
