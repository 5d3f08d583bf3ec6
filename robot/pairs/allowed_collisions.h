// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Which pairs of a robot's links may touch each other, and why.
//
// @code{.cpp}
// #include <spherule/robot/pairs/allowed_collisions.h>
// #include <cassert>
//
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// spherule::AllowedCollisions allowed(robot);
// assert(allowed.reason(0, 1) == spherule::AllowedReason::kAdjacent);
// allowed.forbid("base", "arm");  // tests them nevertheless
// assert(!allowed.allows("base", "arm"));
// @endcode

#include "robot/files/srdf.h"
#include "robot/model/robot_model.h"
#include "robot/pairs/link_pairs.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spherule {

class LinkPairs;

// Why two links are not tested against each other, or not everywhere.
enum class AllowedReason : std::uint8_t {
  kTested,       // they are
  kRigid,        // no joint moves them against each other
  kAdjacent,     // one joint joins them, directly or past links without spheres
  kGiven,        // by name: an SRDF, or the user
  kNever,        // touched in none of the sampled configurations: likely, not proved
  kAlways,       // touched in all of the sampled configurations
  kProvedNever,  // proved never to touch within the limits of the joints (link_pairs.h)
  kFreeInBoxes,  // tested, but in configurations in which they are proved free (link_pairs.h)
};

// For people: what stands in tables and files.
std::string_view name_of(AllowedReason reason);

// Which pairs of a robot's links may touch each other, and why: a symmetric matrix, of which a
// query reads a bit by the indices of two links; names are looked up when it is made. A link and
// itself are never tested. A copy is a value of its own.
class AllowedCollisions {
 public:
  static constexpr std::size_t kMaxLinks = 4096;

  // All pairs are tested but those of links that no joint moves against each other, and those that
  // one joint joins: directly, or past links that carry no spheres and that other joints do not
  // move.
  //
  // Throws Error for a robot of more than kMaxLinks links: the matrix has their square.
  explicit AllowedCollisions(const RobotModel& robot);

  // The links, in the order of their indices.
  const std::vector<std::string>& link_names() const { return names_; }

  // What is allowed already keeps its reason. Throws Error for names that are no links, indices out
  // of range, and the reason of a pair that is tested.
  void allow(std::string_view first, std::string_view second);
  void allow(int first, int second, AllowedReason reason);
  // The pairs that an SRDF disables. Throws Error for names that are no links, before any is taken.
  void allow(std::span<const std::pair<std::string, std::string>> pairs);
  // As an SRDF says: the pairs that it disables, by the default of their links, too, are allowed,
  // and those that it enables are tested, neighbours or not. Those of other robots' links are
  // passed over.
  void apply(const SemanticDescription& semantics);
  // The pairs that are proved never to touch, as kProvedNever: beyond the limits of the joints, or
  // with padding, they are not tested either. A scene that is given the proofs
  // (RobotScene::set_link_pairs()) tests them there. Throws Error for proofs of other links, joints
  // or tighter limits, and those of an attached tool, before any is taken.
  void allow(const LinkPairs& pairs);
  // Every pair, as given: links are tested against obstacles and attached objects alone.
  void allow_all();
  // Tests them again. Throws Error as allow() does, and for a link and itself.
  void forbid(std::string_view first, std::string_view second);

  // Indices of links, in range.
  bool allows(int first, int second) const noexcept {
    const std::size_t i = index(first, second);
    return (bits_[i / 64] >> (i % 64) & 1U) != 0;
  }
  // Throws Error for names that are no links.
  bool allows(std::string_view first, std::string_view second) const;
  // Why it is allowed, or kTested. Indices of links, in range, as above.
  AllowedReason reason(int first, int second) const noexcept {
    return names_.empty() ? AllowedReason::kTested : reasons_[index(first, second)];
  }

  // Two links, and why they are allowed to touch.
  struct Pair {
    int first = 0;  // the smaller index
    int second = 0;
    AllowedReason reason = AllowedReason::kTested;
  };
  // All pairs of two links that are allowed, in order.
  std::vector<Pair> pairs() const;

  // Throws Error for a robot with other links; where pairs are proved, also for one with other
  // joints, or limits beyond those of the robot it was made for.
  void require_robot(const RobotModel& robot) const;

 private:
  std::size_t index(int first, int second) const noexcept {
    assert(first >= 0 && first < static_cast<int>(names_.size()) && second >= 0 &&
           second < static_cast<int>(names_.size()));
    return static_cast<std::size_t>(first) * names_.size() + static_cast<std::size_t>(second);
  }
  int link(std::string_view name) const;
  void set(int first, int second, AllowedReason reason);

  std::vector<std::string> names_;
  // What proofs hold for: mechanism_fingerprint(), and the limits of each variable.
  std::uint64_t mechanism_;
  std::vector<std::pair<double, double>> limits_;
  std::vector<std::uint64_t> bits_;
  std::vector<AllowedReason> reasons_;
};

}  // namespace spherule

// Pairs of links that are proved never to touch, for lists of ignored pairs.
//
// @code{.cpp}
//
// spherule::RobotModel robot("base");
// robot.add_link("arm", "base", {.name = "turn", .type = spherule::JointType::kContinuous});
// const auto proofs = spherule::prove_link_pairs(robot, {});  // without bodies: of no pair
// std::vector<spherule::DisabledPair> pairs{{.link_a = "arm", .link_b = "base", .reason = ""}};
// spherule::add_missing_pairs(spherule::pairs_proved_never(robot, proofs), robot, pairs);
// assert(pairs.size() == 1);
// @endcode

namespace spherule {

// The reason of pairs that are proved never to touch, in lists of ignored pairs.
inline constexpr std::string_view kProvedNeverReason = "Never (proved within the limits)";

// The pairs of links that are proved never to touch, by name, for lists of ignored pairs. Throws
// Error for proofs of another robot, of tighter limits, or of an attached tool.
std::vector<DisabledPair> pairs_proved_never(const RobotModel& robot, const LinkPairs& proofs);

// Appends those of the pairs that are about links of the robot and not known yet, in either order.
void add_missing_pairs(std::span<const DisabledPair> pairs, const RobotModel& robot,
                       std::vector<DisabledPair>& known);

}  // namespace spherule
