// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "robot/model/link_paths.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace spherule::test {

// Of two bodies on a straight motion in joint space, over all of it, for each unit of its time.
struct PathBounds {
  double speed = 0.0;  // of a point of one, as seen from the other
  double bend = 0.0;   // half of what that velocity changes by: half an acceleration
};

// The formula of collide/kernels/plan_vectors.h for one path, without slack for rounding: for a
// motion on which no joint's position changes by more than `rates` in all, and no prismatic joint's
// magnitude exceeds `shifts`. Both are indexed by the robot's joints. Where the second body does
// not move it is the root.
inline PathBounds path_bounds(const internal::PathReach& reach, bool second_moves,
                              std::span<const double> rates, std::span<const double> shifts) {
  using Step = internal::PathReach::Step;
  const std::vector<Step>& steps = reach.steps();
  const std::size_t count = steps.size();
  // One more joint is passed; `sum` is of those before it.
  const auto pass = [&](const Step& step, double distance, double& shifted, PathBounds& sum) {
    const auto j = static_cast<std::size_t>(step.joint);
    const double travel = rates[j] * (step.turns ? distance + shifted : distance);
    if (step.turns) sum.bend += rates[j] * (0.5 * travel + sum.speed);
    sum.speed += travel;
    if (!step.turns) shifted += shifts[j];
  };
  // Of the second body, behind each joint.
  std::vector<PathBounds> second(count + 1);
  double shifted = 0.0;
  for (std::size_t k = count; second_moves && k-- > 0;) {
    second[k] = second[k + 1];
    pass(steps[k], steps[k].second, shifted, second[k]);
  }
  PathBounds first;
  PathBounds best{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  shifted = 0.0;
  for (std::size_t s = 0; s <= count; ++s) {
    if (second_moves || s == count) {
      best.speed = std::min(best.speed, first.speed + second[s].speed);
      best.bend = std::min(best.bend, first.bend + second[s].bend);
    }
    if (s < count) pass(steps[s], steps[s].first, shifted, first);
  }
  return best;
}

}  // namespace spherule::test
