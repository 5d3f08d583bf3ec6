// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/internal/shared_work.h"
#include "collide/robot/robot_tree_checker.h"
#include "spheretree/error.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace spherule {

// Returns the number of variables.
std::size_t RobotTreeChecker::require_sizes(std::span<const double> configurations,
                                            std::span<const std::uint8_t> verdicts) const {
  const auto variables = static_cast<std::size_t>(robot_.variable_count());
  if (configurations.size() != verdicts.size() * variables) {
    throw Error("configurations", std::to_string(configurations.size()) + " numbers for " +
                                      std::to_string(verdicts.size()) +
                                      " verdicts on a robot with " + std::to_string(variables) +
                                      " variables");
  }
  return variables;
}

void RobotTreeChecker::collides(std::span<const double> configurations,
                                std::span<Scratch> scratches,
                                std::span<std::uint8_t> verdicts) const {
  static_assert(kPiece % MechanismCheck::kBlock == 0);
  const std::size_t variables = require_sizes(configurations, verdicts);
  if (scratches.empty()) throw Error("configurations", "there is no scratch to judge them with");
  if (scratches.size() == 1 || verdicts.size() < kFewestShared) {
    return collides(configurations, scratches.front(), verdicts);  // to share out would allocate
  }
  for (const Scratch& scratch : scratches) require_own(scratch);
  const std::size_t pieces = (verdicts.size() + kPiece - 1) / kPiece;
  internal::share_work(pieces, scratches.size(), [&](std::size_t worker, std::size_t piece) {
    const std::size_t first = piece * kPiece;
    const std::size_t count = std::min(kPiece, verdicts.size() - first);
    collides(configurations.subspan(first * variables, count * variables), scratches[worker],
             verdicts.subspan(first, count));
  });
}

void RobotTreeChecker::collides(std::span<const double> configurations, Scratch& scratch,
                                std::span<std::uint8_t> verdicts) const {
  constexpr std::size_t kBlock = MechanismCheck::kBlock;
  require_own(scratch);
  const std::size_t variables = require_sizes(configurations, verdicts);
  const auto configuration = [&](std::size_t i) {
    return configurations.subspan(i * variables, variables);
  };
  for (std::size_t first = 0; first < verdicts.size(); first += kBlock) {
    const std::size_t last = std::min(first + kBlock, verdicts.size()) - 1;
    std::array<const double*, kBlock> block;  // filled up with the last one
    for (std::size_t i = 0; i < kBlock; ++i) {
      const std::size_t index = std::min(first + i, last);
      block[i] = positions_.of(configuration(index), scratch.room_, i).data();
    }
    int placed = -1;
    std::uint32_t unconfirmed = 0;
    const MechanismCheck::BlockAnswer answer =
        check_->collides(block, scratch.memory_, [&](int index, const MechanismContact& contact) {
          bool is_placed = std::exchange(placed, index) == index;
          scratch.unconfirmed_.clear();
          const std::size_t asked = std::min(first + static_cast<std::size_t>(index), last);
          const bool touch = touches(configuration(asked), contact, is_placed, scratch);
          if (!scratch.unconfirmed_.empty()) unconfirmed |= 1U << index;
          return touch;
        });
    for (std::size_t i = first; i <= last; ++i) {
      const auto says = [&](std::uint32_t bits) { return (bits >> (i - first) & 1U) != 0; };
      bool hit = always_ || says(answer.collides);
      if (says(answer.out_of_range)) {
        hit = collides_exactly(configuration(i), scratch);
      } else if (!hit && says(unconfirmed)) {
        hit = collides(configuration(i), scratch);
      }
      verdicts[i] = hit ? 1 : 0;
    }
  }
}

}  // namespace spherule
