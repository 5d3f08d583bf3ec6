// SPDX-License-Identifier: BSD-3-Clause
#include "collide/kernels/compiled_wide_plan.h"

#include "collide/internal/single_precision.h"

#include <algorithm>
#include <limits>

namespace spherule::internal {
namespace {

constexpr std::size_t rounded_to_lanes(std::size_t count) {
  return (count + kPlanLanes - 1) / kPlanLanes * kPlanLanes;
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
  const std::size_t groups = rounded_to_lanes(moving) / kPlanLanes;
  partners_.assign(moving * groups, 0);
  never_.assign(moving * groups, 0);
  for (std::size_t first = 0; first < moving; ++first) {
    bodies_[first].first_pair = static_cast<std::int32_t>(pair_tests_.size());
    struct Partner {
      std::int32_t pair;
      std::int32_t second;
    };
    std::vector<Partner> partners;
    for (std::int32_t p = 0; p < plan.pair_count; ++p) {
      if (plan.pairs[p].first != static_cast<std::int32_t>(first)) continue;
      partners.push_back({p, plan.pairs[p].second});
    }
    std::sort(partners.begin(), partners.end(),
              [](const Partner& a, const Partner& b) { return a.second < b.second; });
    for (const Partner& partner : partners) {
      const auto second = static_cast<std::size_t>(partner.second);
      const std::size_t group = first * groups + second / kPlanLanes;
      const auto bit = static_cast<std::uint8_t>(1U << (second % kPlanLanes));
      partners_[group] |= bit;
      if (partner.pair >= plan.first_never) never_[group] |= bit;
      pair_tests_.push_back(plan.first_pair + partner.pair);
    }
  }
  plan_ = {frames_.data(),
           bodies_.data(),
           tree_of_.data(),
           static_cast<std::int32_t>(placed_count_),
           static_cast<std::int32_t>(groups),
           partners_.data(),
           never_.data(),
           pair_tests_.data()};
}

void CompiledWidePlan::add_body(const SearchTrees& trees, const Pose& pose, double inflation,
                                bool is_confirmed, std::int32_t frame) {
  const PackedTree& tree = trees_.emplace_back(trees.wide, trees.wide_spheres, pose, inflation);
  WideBody& body = bodies_.emplace_back();
  body = {};
  for (int k = 0; k < 3; ++k) body.center[k] = static_cast<float>(tree.root().center[k]);
  body.radius = static_cast<float>(tree.root().radius);
  body.margin = is_confirmed ? std::numeric_limits<float>::infinity()
                             : rounded_up_to_single(3.0 * tree.largest_growth());
  body.frame = frame;
  body.first_node = static_cast<std::int32_t>(placed_count_);
  if (frame != 0) placed_count_ += static_cast<std::size_t>(tree.node_count());
  depth_ = std::max(depth_, tree.depth());
}

WideMemory::WideMemory(const CheckPlan<float>& plan, const CompiledWidePlan& wide) {
  const std::size_t positions = rounded_to_lanes(static_cast<std::size_t>(plan.position_count));
  const std::size_t bodies = rounded_to_lanes(static_cast<std::size_t>(plan.body_count));
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
