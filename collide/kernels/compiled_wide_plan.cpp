// SPDX-License-Identifier: BSD-3-Clause
#include "collide/kernels/compiled_wide_plan.h"

#include "collide/search/single_precision.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace spherule::internal {
namespace {

constexpr std::size_t rounded_up(std::size_t count, std::size_t unit) {
  return (count + unit - 1) / unit * unit;
}

}  // namespace

CompiledWidePlan::CompiledWidePlan(const PlanSource& source, const CompiledPlan<float>& compiled) {
  const CheckPlan<float>& plan = compiled.plan();
  for (std::int32_t f = 0; f < plan.frame_count; ++f) {
    const PlanFrame<float>& frame = plan.frames[f];
    WideFrame& wide = frames_.emplace_back();
    wide = {};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) wide.rotation[i][j] = frame.rotation[i][j];
      wide.origin[i] = frame.origin[i];
    }
    wide.parent = frame.parent;
    wide.position = frame.position;
    wide.prismatic = frame.prismatic;
  }
  for (std::size_t i = 0; i < source.bodies.size(); ++i) {
    const PlanSource::Body& from = source.bodies[i];
    add_body(*from.trees, from.frame_from_trees, compiled.inflation(i), from.is_confirmed,
             plan.bodies[i].frame);
  }
  const std::size_t moving = bodies_.size();
  for (std::size_t i = 0; i < source.obstacles.size(); ++i) {
    const PlanSource::Obstacle& from = source.obstacles[i];
    const auto* const trees = std::get_if<std::shared_ptr<const SearchTrees>>(&from.shape);
    tree_of_.push_back(trees == nullptr ? -1 : static_cast<std::int32_t>(bodies_.size()));
    if (trees == nullptr) continue;
    add_body(**trees, from.root_from_shape, compiled.obstacle_inflation(i), from.is_confirmed, 0);
  }
  // The nodes of a tree stay where they are when the tree is moved.
  for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i].nodes = trees_[i].nodes();
  // Every task that is taken leaves at most 64, a node of which is a level deeper.
  task_count_ = 64 * (2 * static_cast<std::size_t>(depth_) + 1) + 1;
  compile_partners(plan, moving);
  const auto touching =
      std::partition_point(partners_.begin(), partners_.end(),
                           [](const WidePartners& entry) { return entry.partners != entry.never; });
  plan_ = {frames_.data(),
           bodies_.data(),
           tree_of_.data(),
           static_cast<std::int32_t>(placed_count_),
           partners_.data(),
           static_cast<std::int32_t>(partners_.size()),
           static_cast<std::int32_t>(touching - partners_.begin()),
           pair_tests_.data()};
}

// Each pair is searched for from one of its sides. A body is compared with many others at a time,
// so that few bodies should do this: whichever has most pairs that are left takes them all, what
// never touches last.
void CompiledWidePlan::compile_partners(const CheckPlan<float>& plan, std::size_t bodies) {
  const auto pairs = static_cast<std::size_t>(plan.pair_count);
  const auto side = [&](std::size_t pair, int k) {
    return static_cast<std::size_t>(k == 0 ? plan.pairs[pair].first : plan.pairs[pair].second);
  };
  std::vector<int> from(pairs, -1);  // which side searches for the other
  std::vector<std::vector<std::size_t>> pairs_of(bodies);
  for (std::size_t p = 0; p < pairs; ++p) {
    for (const int k : {0, 1}) pairs_of[side(p, k)].push_back(p);
  }
  for (const std::size_t end : {static_cast<std::size_t>(plan.first_never), pairs}) {
    std::vector<std::size_t> counts(bodies, 0);
    for (std::size_t p = 0; p < end; ++p) {
      if (from[p] >= 0) continue;
      for (const int k : {0, 1}) ++counts[side(p, k)];
    }
    while (true) {
      const auto most = std::max_element(counts.begin(), counts.end());
      if (most == counts.end() || *most == 0) break;
      const auto body = static_cast<std::size_t>(most - counts.begin());
      for (const std::size_t p : pairs_of[body]) {
        if (p >= end || from[p] >= 0) continue;
        from[p] = side(p, 0) == body ? 0 : 1;
        for (const int k : {0, 1}) --counts[side(p, k)];
      }
    }
  }
  // Of each body, with their pairs.
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> partners(bodies);
  for (std::size_t p = 0; p < pairs; ++p) {
    partners[side(p, from[p])].emplace_back(side(p, 1 - from[p]), p);
  }
  for (std::size_t body = 0; body < bodies; ++body) {
    std::sort(partners[body].begin(), partners[body].end());
    for (const auto& [other, pair] : partners[body]) {
      const auto group = static_cast<std::int32_t>(other / WidePartners::kGroup);
      const auto index = static_cast<std::int32_t>(body);
      if (partners_.empty() || partners_.back().body != index || partners_.back().group != group) {
        partners_.push_back({index, group, static_cast<std::int32_t>(pair_tests_.size()), 0, 0});
      }
      const auto bit = static_cast<std::uint16_t>(1U << (other % WidePartners::kGroup));
      partners_.back().partners |= bit;
      if (pair >= static_cast<std::size_t>(plan.first_never)) partners_.back().never |= bit;
      pair_tests_.push_back(plan.first_pair + static_cast<std::int32_t>(pair));
    }
  }
  std::stable_partition(partners_.begin(), partners_.end(),
                        [](const WidePartners& entry) { return entry.partners != entry.never; });
}

void CompiledWidePlan::add_body(const SearchTrees& trees, const Pose& pose, double inflation,
                                bool is_confirmed, std::int32_t frame) {
  const PackedTree& tree = trees_.emplace_back(trees.wide, trees.wide_spheres, pose, inflation);
  WideBody& body = bodies_.emplace_back();
  body = {};
  for (int k = 0; k < 3; ++k) body.center[k] = static_cast<float>(tree.root().center[k]);
  body.radius = static_cast<float>(tree.root().radius);
  body.margin = is_confirmed ? std::numeric_limits<float>::infinity()
                             : rounded_up_to_single(3.0 * tree.largest_inflation());
  body.frame = frame;
  body.first_node = static_cast<std::int32_t>(placed_count_);
  if (frame != 0) placed_count_ += static_cast<std::size_t>(tree.node_count());
  depth_ = std::max(depth_, tree.depth());
}

WideMemory::WideMemory(const CheckPlan<float>& plan, const CompiledWidePlan& wide) {
  const std::size_t positions =
      rounded_up(static_cast<std::size_t>(plan.position_count), kPlanLanes);
  const std::size_t bodies =
      rounded_up(static_cast<std::size_t>(plan.body_count), WidePartners::kGroup);
  positions_.resize(positions);
  sines_.resize(positions);
  cosines_.resize(positions);
  poses_.resize(static_cast<std::size_t>(plan.frame_count));
  for (std::vector<float>& coordinate : roots_) coordinate.resize(bodies);
  radii_.resize(bodies);
  for (std::size_t i = 0; i < static_cast<std::size_t>(plan.body_count); ++i) {
    radii_[i] = wide.plan().bodies[i].radius;
  }
  placed_.resize(kPlanLanes * static_cast<std::size_t>(wide.plan().placed_count));
  stamps_.resize(placed_.size());
  tasks_.resize(wide.task_count());
  view_ = {positions_.data(),
           sines_.data(),
           cosines_.data(),
           poses_.data(),
           {roots_[0].data(), roots_[1].data(), roots_[2].data()},
           radii_.data(),
           placed_.data(),
           stamps_.data(),
           &evaluation_,
           tasks_.data(),
           &recent_};
}

}  // namespace spherule::internal
