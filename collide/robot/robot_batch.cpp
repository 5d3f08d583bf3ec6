// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/internal/configuration_batch.h"
#include "collide/robot/robot_tree_checker.h"

#include <algorithm>
#include <array>
#include <utility>

namespace spherule {

void RobotTreeChecker::collides(std::span<const double> configurations,
                                std::span<Scratch> scratches,
                                std::span<std::uint8_t> verdicts) const {
  static_assert(kPiece % MechanismCheck::kBlock == 0);
  const std::size_t variables = internal::require_sizes(robot_, configurations, verdicts);
  for (const Scratch& scratch : scratches) require_own(scratch);
  internal::share_configurations(
      configurations, variables, {.piece = kPiece, .fewest = kFewestShared}, scratches, verdicts,
      [&](std::span<const double> piece, Scratch& scratch, std::span<std::uint8_t> its_verdicts) {
        collides(piece, scratch, its_verdicts);
      });
}

void RobotTreeChecker::collides(std::span<const double> configurations, Scratch& scratch,
                                std::span<std::uint8_t> verdicts) const {
  constexpr std::size_t kBlock = MechanismCheck::kBlock;
  require_own(scratch);
  const std::size_t variables = internal::require_sizes(robot_, configurations, verdicts);
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
