// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/robot_collision.h"

#include "base/error.h"
#include "robot/check/body_pairs.h"
#include "robot/check/robot_scene.h"
#include "robot/cover/alarm_sample.h"
#include "robot/model/joint_positions.h"

#include <cassert>
#include <cstddef>
#include <random>
#include <utility>

namespace spherule {

bool robot_collides(const RobotModel& robot, std::span<const Pose> world_from_link,
                    const SphereTree& obstacle, const Pose& world_from_obstacle) noexcept {
  const std::vector<Link>& links = robot.links();
  assert(world_from_link.size() == links.size());
  for (std::size_t i = links.size(); i-- > 0;) {
    for (const auto& tree : links[i].trees) {
      if (collides(*tree, world_from_link[i], obstacle, world_from_obstacle)) return true;
    }
  }
  return false;
}

std::vector<PairStatus> pair_statuses(const RobotModel& robot, const AllowedCollisions& allowed,
                                      std::shared_ptr<const LinkPairs> proofs) {
  RobotScene scene(robot);
  scene.set_allowed_collisions(allowed);
  scene.set_link_pairs(proofs);
  std::vector<PairStatus> result;
  const std::vector<Link>& links = robot.links();
  for (std::size_t first = 0; first < links.size(); ++first) {
    for (std::size_t second = first + 1; second < links.size(); ++second) {
      if (links[first].trees.empty() || links[second].trees.empty()) continue;
      PairStatus& status = result.emplace_back();
      status.first = static_cast<int>(first);
      status.second = static_cast<int>(second);
      status.reason = scene.reason(links[first].name, links[second].name);
      const LinkPair* const pair =
          proofs == nullptr ? nullptr : proofs->find(status.first, status.second);
      if (pair == nullptr) continue;
      status.verdict = pair->verdict;
      status.free_share = pair->boxes.free_share();
    }
  }
  return result;
}

std::string_view kind_of(const PairStatus& status) {
  if (status.reason != AllowedReason::kTested || !status.verdict) return name_of(status.reason);
  return *status.verdict == PairVerdict::kTouching ? "can touch" : name_of(*status.verdict);
}

SampledCollisions sample_collisions(const RobotModel& robot, const AllowedCollisions& allowed,
                                    const SampleCollisionsOptions& options) {
  if (options.configurations == 0) throw Error("sample", "it has no configurations");
  require_limits(robot);
  std::vector<internal::CheckedPiece> pieces;
  std::vector<std::vector<int>> pieces_of(robot.links().size());
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    for (const auto& tree : robot.links()[link].trees) {
      pieces_of[link].push_back(static_cast<int>(pieces.size()));
      pieces.push_back({.tree = tree, .link = static_cast<int>(link)});
    }
  }
  SampledCollisions result{options.configurations, {}};
  std::vector<internal::CheckedPair> pairs;
  std::vector<std::size_t> end_of;  // of each pair of links, among those of pieces
  for (std::size_t first = 0; first < pieces_of.size(); ++first) {
    for (std::size_t second = first + 1; second < pieces_of.size(); ++second) {
      const SampledPair pair{static_cast<int>(first), static_cast<int>(second)};
      if (allowed.allows(pair.first, pair.second)) continue;
      if (pieces_of[first].empty() || pieces_of[second].empty()) continue;
      for (const int a : pieces_of[first]) {
        for (const int b : pieces_of[second]) pairs.push_back({a, b, false});
      }
      result.pairs.push_back(pair);
      end_of.push_back(pairs.size());
    }
  }
  const std::size_t tested = pairs.size();
  const internal::BodyPairs checked(robot, Pose(), std::move(pieces), {}, std::move(pairs), tested);
  internal::BodyPairs::Scratch scratch;
  std::mt19937_64 bits(options.seed);
  std::vector<double> configuration(static_cast<std::size_t>(robot.variable_count()));
  for (std::size_t n = 0; n < options.configurations; ++n) {
    internal::draw_configuration(robot, bits, configuration);
    checked.place(configuration, scratch);
    std::size_t i = 0;
    for (std::size_t pair = 0; pair < result.pairs.size(); ++pair) {
      bool touched = false;
      for (; i < end_of[pair]; ++i) touched = touched || checked.touches(i, scratch);
      result.pairs[pair].touched += touched ? 1 : 0;
    }
  }
  for (SampledPair& pair : result.pairs) {
    if (pair.touched == 0) pair.reason = AllowedReason::kNever;
    if (pair.touched == options.configurations) pair.reason = AllowedReason::kAlways;
  }
  return result;
}

void allow_sampled(const SampledCollisions& sampled, AllowedCollisions& allowed) {
  for (const SampledPair& pair : sampled.pairs) {
    if (pair.reason != AllowedReason::kTested) allowed.allow(pair.first, pair.second, pair.reason);
  }
}

}  // namespace spherule
