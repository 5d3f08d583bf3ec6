// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/internal/tested_pairs.h"

#include "spheretree/error.h"

#include <algorithm>
#include <string>

namespace spherule::internal {

void check_obstacles(std::span<const PlacedTree> obstacles) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    if (!obstacles[i].tree) throw Error("obstacle " + std::to_string(i), "it has no tree");
  }
}

void check_untested(std::span<const UntestedPair> untested, const RobotModel& robot,
                    std::size_t obstacle_count) {
  for (const UntestedPair& pair : untested) {
    if (pair.link < 0 || static_cast<std::size_t>(pair.link) >= robot.links().size() ||
        pair.obstacle >= obstacle_count) {
      throw Error("untested pair", "link " + std::to_string(pair.link) + " or obstacle " +
                                       std::to_string(pair.obstacle) + " is not there");
    }
  }
}

bool is_untested(std::span<const UntestedPair> untested, std::size_t link, std::size_t obstacle) {
  return std::any_of(untested.begin(), untested.end(), [&](const UntestedPair& pair) {
    return static_cast<std::size_t>(pair.link) == link && pair.obstacle == obstacle;
  });
}

}  // namespace spherule::internal
