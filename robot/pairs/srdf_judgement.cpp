// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/srdf_judgement.h"

#include "robot/model/link_paths.h"
#include "robot/pairs/proof_scope.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace spherule {
namespace {

bool is_decision(std::string_view reason) {
  constexpr std::array<std::string_view, 4> kDecisions = {"Default", "Always", "User",
                                                          kDisabledByDefault};
  return std::find(kDecisions.begin(), kDecisions.end(), reason) != kDecisions.end();
}

DisabledVerdict verdict_of(PairVerdict verdict) {
  constexpr std::array kVerdicts = {DisabledVerdict::kNever, DisabledVerdict::kTouches,
                                    DisabledVerdict::kUnknown};
  return kVerdicts[static_cast<std::size_t>(verdict)];
}

}  // namespace

std::string_view name_of(DisabledVerdict verdict) {
  constexpr std::array<std::string_view, 7> kNames = {
      "touches", "unknown", "never", "adjacent", "rigid", "no body", "of another robot"};
  static_assert(kNames.size() == static_cast<std::size_t>(DisabledVerdict::kOtherRobot) + 1);
  return kNames[static_cast<std::size_t>(verdict)];
}

SrdfJudgement judge_srdf(const RobotModel& robot, const SemanticDescription& semantics,
                         const LinkPairs& proofs) {
  internal::require_never_holds(proofs, robot);
  std::vector<bool> with_body(robot.links().size(), false);
  for (const LinkPair& pair : proofs.pairs()) {
    for (const int link : {pair.first, pair.second})
      with_body[static_cast<std::size_t>(link)] = true;
  }
  const auto has_body = [&](int link) { return with_body[static_cast<std::size_t>(link)]; };
  SrdfJudgement result;
  std::set<std::pair<int, int>> listed;
  const internal::LinkRelations relations(robot);
  struct Found {
    int first, second;
    std::size_t at;  // in the result
  };
  std::vector<Found> found;
  std::vector<std::string> links_with_body;
  for (std::size_t i = 0; i < with_body.size(); ++i) {
    if (with_body[i]) links_with_body.push_back(robot.links()[i].name);
  }
  for (const DisabledPair& pair : disabled_among(semantics, links_with_body)) {
    JudgedPair& judged = result.pairs.emplace_back();
    judged.pair = pair;
    const int first = robot.find_link(pair.link_a);
    const int second = robot.find_link(pair.link_b);
    if (first < 0 || second < 0) {
      judged.verdict = DisabledVerdict::kOtherRobot;
    } else {
      found.push_back({first, second, result.pairs.size() - 1});
    }
  }
  // Those of one link together: what is related to it is found once.
  std::ranges::stable_sort(found, {}, &Found::first);
  int related_to = -1;
  std::vector<internal::LinkRelations::Relation> related;
  for (const auto& [first, second, at] : found) {
    JudgedPair& judged = result.pairs[at];
    const DisabledPair& pair = judged.pair;
    listed.insert(std::minmax(first, second));
    if (first != related_to) {
      related = relations.of(first, has_body);
      related_to = first;
    }
    const internal::Joined joined = related[static_cast<std::size_t>(second)].joined;
    const LinkPair* const proved = proofs.find(first, second);
    if (joined == internal::Joined::kRigidly) {
      judged.verdict = DisabledVerdict::kRigid;
    } else if (proved == nullptr) {
      judged.verdict = DisabledVerdict::kNoBody;
    } else if (proved->verdict != PairVerdict::kNever && joined == internal::Joined::kByOneJoint) {
      judged.verdict = DisabledVerdict::kAdjacent;
    } else {
      judged.verdict = verdict_of(proved->verdict);
      judged.witness = proved->witness;
      judged.smallest_gap = proved->smallest_gap;
      const bool is_stated = !is_decision(pair.reason);
      judged.is_wrong = judged.verdict == DisabledVerdict::kTouches && is_stated;
      judged.is_open = judged.verdict == DisabledVerdict::kUnknown && is_stated;
    }
  }
  for (const LinkPair& pair : proofs.pairs()) {
    if (pair.verdict == PairVerdict::kNever && !listed.contains({pair.first, pair.second})) {
      result.could_be_added.emplace_back(pair.first, pair.second);
    }
  }
  return result;
}

std::vector<DisabledPair> pairs_proved_never(const RobotModel& robot, const LinkPairs& proofs) {
  internal::require_never_holds(proofs, robot);
  std::vector<DisabledPair> result;
  for (const LinkPair& pair : proofs.pairs()) {
    if (pair.verdict != PairVerdict::kNever) continue;
    result.push_back({robot.links()[static_cast<std::size_t>(pair.first)].name,
                      robot.links()[static_cast<std::size_t>(pair.second)].name,
                      std::string(kProvedNeverReason)});
  }
  return result;
}

void add_missing_pairs(std::span<const DisabledPair> pairs, const RobotModel& robot,
                       std::vector<DisabledPair>& known) {
  std::set<std::pair<std::string, std::string>> names;
  for (const DisabledPair& pair : known) names.insert(std::minmax(pair.link_a, pair.link_b));
  for (const DisabledPair& pair : pairs) {
    if (robot.find_link(pair.link_a) < 0 || robot.find_link(pair.link_b) < 0) continue;
    if (names.insert(std::minmax(pair.link_a, pair.link_b)).second) known.push_back(pair);
  }
}

}  // namespace spherule
