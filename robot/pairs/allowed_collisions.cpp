// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/allowed_collisions.h"

#include "base/error.h"
#include "base/text.h"
#include "robot/model/link_paths.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace spherule {
namespace {

AllowedReason reason_of(internal::Joined joined) {
  constexpr std::array kReasons = {AllowedReason::kRigid, AllowedReason::kAdjacent,
                                   AllowedReason::kTested};
  return kReasons[static_cast<std::size_t>(joined)];
}

}  // namespace

std::string_view name_of(AllowedReason reason) {
  constexpr std::array<std::string_view, 8> kNames = {"tested",
                                                      "rigid",
                                                      "adjacent",
                                                      "given",
                                                      "never in the sample",
                                                      "always in the sample",
                                                      "proved never",
                                                      "free in boxes"};
  static_assert(kNames.size() == static_cast<std::size_t>(AllowedReason::kFreeInBoxes) + 1);
  return kNames[static_cast<std::size_t>(reason)];
}

AllowedCollisions::AllowedCollisions(const RobotModel& robot) {
  if (robot.links().size() > kMaxLinks) {
    throw Error("robot", "it has more than " + std::to_string(kMaxLinks) +
                             " links, too many for a table of their pairs");
  }
  for (const Link& link : robot.links()) names_.push_back(link.name);
  const int count = static_cast<int>(names_.size());
  reasons_.resize(names_.size() * names_.size(), AllowedReason::kTested);
  const internal::LinkRelations relations(robot);
  const auto has_spheres = [&](int link) {
    return !robot.links()[static_cast<std::size_t>(link)].trees.empty();
  };
  for (int first = 0; first < count; ++first) {
    const auto related = relations.of(first, has_spheres);
    for (int second = first; second < count; ++second) {
      set(first, second, reason_of(related[static_cast<std::size_t>(second)].joined));
    }
  }
}

int AllowedCollisions::link(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) {
    throw Error("link " + std::string(name),
                "the robot has no such link" + internal::did_you_mean(name, names_));
  }
  return static_cast<int>(found - names_.begin());
}

void AllowedCollisions::set(int first, int second, AllowedReason reason) {
  reasons_[index(first, second)] = reason;
  reasons_[index(second, first)] = reason;
}

void AllowedCollisions::allow(std::string_view first, std::string_view second) {
  allow(link(first), link(second), AllowedReason::kGiven);
}

void AllowedCollisions::allow(std::span<const DisabledPair> pairs) {
  for (const DisabledPair& pair : pairs) (void)(link(pair.link_a), link(pair.link_b));
  for (const DisabledPair& pair : pairs) allow(pair.link_a, pair.link_b);
}

void AllowedCollisions::apply(const SemanticDescription& semantics) {
  std::map<std::string_view, int> links;
  for (std::size_t i = 0; i < names_.size(); ++i) links.emplace(names_[i], static_cast<int>(i));
  const auto with_links = [&](const std::string& first, const std::string& second, auto action) {
    const auto a = links.find(first);
    const auto b = links.find(second);
    if (a != links.end() && b != links.end()) action(a->second, b->second);
  };
  for (const DisabledPair& pair : disabled_among(semantics, names_)) {
    with_links(pair.link_a, pair.link_b, [&](int a, int b) { allow(a, b, AllowedReason::kGiven); });
  }
  for (const auto& [first, second] : enabled_only(semantics)) {
    with_links(first, second, [&](int a, int b) { set(a, b, AllowedReason::kTested); });
  }
}

void AllowedCollisions::allow(int first, int second, AllowedReason reason) {
  const int count = static_cast<int>(names_.size());
  if (first < 0 || second < 0 || first >= count || second >= count) {
    throw Error("allowed collisions", "link " + std::to_string(first) + " or " +
                                          std::to_string(second) + " is not there: the robot has " +
                                          std::to_string(count) + " links");
  }
  if (reason == AllowedReason::kTested || reason >= AllowedReason::kProvedNever) {
    throw Error("allowed collisions", "a pair that is tested or proved is not allowed");
  }
  if (!allows(first, second)) set(first, second, reason);
}

void AllowedCollisions::allow_all() {
  const int count = static_cast<int>(names_.size());
  for (int first = 0; first < count; ++first) {
    for (int second = first + 1; second < count; ++second) {
      allow(first, second, AllowedReason::kGiven);
    }
  }
}

void AllowedCollisions::forbid(std::string_view first, std::string_view second) {
  const int a = link(first);
  const int b = link(second);
  if (a == b)
    throw Error("link " + names_[static_cast<std::size_t>(a)], "it cannot collide with itself");
  set(a, b, AllowedReason::kTested);
}

bool AllowedCollisions::allows(std::string_view first, std::string_view second) const {
  return allows(link(first), link(second));
}

void AllowedCollisions::require_robot(const RobotModel& robot) const {
  if (!std::equal(names_.begin(), names_.end(), robot.links().begin(), robot.links().end(),
                  [](const std::string& name, const Link& link) { return name == link.name; })) {
    throw Error("allowed collisions", "they are those of a robot with other links");
  }
}

std::vector<AllowedCollisions::Pair> AllowedCollisions::pairs() const {
  std::vector<Pair> result;
  const int count = static_cast<int>(names_.size());
  for (int first = 0; first < count; ++first) {
    for (int second = first + 1; second < count; ++second) {
      if (allows(first, second)) result.push_back({first, second, reason(first, second)});
    }
  }
  return result;
}

}  // namespace spherule
