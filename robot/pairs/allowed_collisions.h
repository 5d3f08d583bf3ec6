// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Which pairs of a robot's links may touch each other, and why. What is proved of pairs stands in
// LinkPairs, which a scene takes besides (RobotScene::set_link_pairs()).
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

#include "robot/files/robot_description.h"
#include "robot/model/robot_model.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spherule {

// Why two links are not tested against each other, or not everywhere.
enum class AllowedReason : std::uint8_t {
  kTested,    // they are
  kRigid,     // no joint moves them against each other
  kAdjacent,  // one joint joins them, directly or past links without spheres
  kGiven,     // by name: an SRDF, or the user
  kNever,     // touched in none of the sampled configurations: likely, not proved
  kAlways,    // touched in all of the sampled configurations
  // Of RobotScene::reason() alone, as LinkPairs says:
  kProvedNever,  // proved never to touch within the limits of the joints
  kFreeInBoxes,  // tested, but in configurations in which they are proved free
};

// For people: what stands in tables and files.
std::string_view name_of(AllowedReason reason);

// Which pairs of a robot's links may touch each other, and why: a symmetric matrix. A link
// and itself are never tested. A copy is a value of its own.
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
  // of range, and a reason that is not one of what is allowed.
  void allow(std::string_view first, std::string_view second);
  void allow(int first, int second, AllowedReason reason);
  // The pairs that an SRDF disables, or a file of spheres ignores. Throws Error for names that are
  // no links, before any is taken.
  void allow(std::span<const DisabledPair> pairs);
  // As an SRDF says: the pairs that it disables, by the default of their links, too, are allowed,
  // and those that it enables are tested, neighbours or not. Those of other robots' links are
  // passed over.
  void apply(const SemanticDescription& semantics);
  // Every pair, as given: links are tested against obstacles and attached objects alone.
  void allow_all();
  // Tests them again. Throws Error as allow() does, and for a link and itself.
  void forbid(std::string_view first, std::string_view second);

  // Indices of links, in range.
  bool allows(int first, int second) const noexcept {
    return reason(first, second) != AllowedReason::kTested;
  }
  // Throws Error for names that are no links.
  bool allows(std::string_view first, std::string_view second) const;
  // Why it is allowed, or kTested. Indices of links, in range, as above.
  AllowedReason reason(int first, int second) const noexcept {
    return reasons_[index(first, second)];
  }

  // Two links, and why they are allowed to touch.
  struct Pair {
    int first = 0;  // the smaller index
    int second = 0;
    AllowedReason reason = AllowedReason::kTested;
  };
  // All pairs of two links that are allowed, in order.
  std::vector<Pair> pairs() const;

  // Throws Error for a robot with other links.
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
  std::vector<AllowedReason> reasons_;
};

}  // namespace spherule
