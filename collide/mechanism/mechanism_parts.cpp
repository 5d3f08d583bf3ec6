// SPDX-License-Identifier: BSD-3-Clause
#include "collide/mechanism/mechanism_parts.h"

#include "collide/mechanism/mechanism_input.h"
#include "collide/search/relative_pose.h"
#include "collide/search/single_precision.h"
#include "spheretree/build.h"
#include "spheretree/error.h"
#include "spheretree/moved_from.h"
#include "spheretree/rounding.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace spherule {
namespace {

using internal::kFloatRoundoff;
using internal::PackedTree;

// Error budget, v = 2^-24, u = 2^-53; n frames lie between the root and a body. No point of the
// body, and no centre of a node of its tree, is further from the root than W: the lengths of the
// chain, kLargestVariable for each shift, and how far the tree reaches in its frame.
//   angles: the sine and cosine of a frame err by less than kSineError = 2e-11, which moves a point
//     beyond the frame by at most 2e-11 W; over n frames 2e-11 n W.
//   the chain in double: as in forward_kinematics, below 200 u W a frame, the frames' own rounded
//     rotations included: 2.3e-14 n W.
//   to single precision, for a centre c in the frame and R c + t: R and t rounded, sqrt(3) v |c| +
//     v |t|; c rounded, v |c|; three products and three sums a row, 4 v (|c| + |t|) a row at most,
//     over three rows 7 v (|c| + |t|). Together less than 10 v W. The sphere around all is placed
//     in double and then rounded: less.
//   centres are moved to their frame in double: 40 u (|p| + |t|) for a point p of a tree and its
//     pose's translation t. Let X bound that sum for all trees, and W for all bodies.
//   the slack of the canonical test, 152 u of the scene, which is less than 4 X, and of the scene
//     as the caller's poses have it, which is in pose_error.
// So the spheres of a body must be inflated by
//     12 v W + 1e-10 (n + 1) W + 1e-12 X + pose_error,
// and those of an obstacle by 1e-12 X. Where poses are computed in lanes, spheres of bodies are
// grown by KernelBody::lane_error beside it, see kernel_lanes.h.
constexpr double kPerLength = 12.0 * kFloatRoundoff;
constexpr double kPerFrame = 5.0 * internal::kSineError;
constexpr double kPerScene = 1e-12;

void check_input(std::span<const MechanismFrame> frames, std::span<const MechanismBody> bodies,
                 std::span<const MechanismObstacle> obstacles, std::span<const MechanismPair> pairs,
                 double pose_error) {
  internal::check_frames(frames);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    internal::check_body(i, bodies[i].frame, frames.size(), bodies[i].tree != nullptr);
    internal::require_content(bodies[i].tree->node_count() > 0, "SphereTree");
  }
  internal::check_obstacles(obstacles);
  for (const MechanismObstacle& obstacle : obstacles) {
    internal::require_content(obstacle.tree->node_count() > 0, "SphereTree");
  }
  internal::check_pairs(pairs, bodies.size(), obstacles.size());
  internal::check_pose_error(pose_error);
}

// What is below this is an axis at a right angle, and costs less as zero: far below the budget of
// kernel_lanes.h, where entries are rounded by up to 6e-8.
constexpr double kNegligible = 0x1p-40;

internal::KernelLaneFrame lane_frame(const internal::KernelFrame& frame) {
  internal::KernelLaneFrame result = {};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double entry = frame.rotation[j][i];
      result.rotation[j][i] = std::abs(entry) < kNegligible ? 0.0F : static_cast<float>(entry);
    }
    result.origin[i] = static_cast<float>(frame.origin[i]);
  }
  result.parent = frame.parent;
  result.variable = frame.variable;
  result.prismatic = frame.prismatic;
  return result;
}

// Margins as packed_tree.h has them. `reach` is W, `links` the frames between root and body.
internal::KernelBody kernel_body(const PackedTree& tree, int frame, double reach, double links) {
  const auto& [center, radius] = tree.root();
  return {tree.nodes(),
          tree.leaves(),
          tree.node_count(),
          {center.x(), center.y(), center.z()},
          {static_cast<float>(center.x()), static_cast<float>(center.y()),
           static_cast<float>(center.z())},
          static_cast<float>(radius),
          frame,
          internal::rounded_up_to_single(3.0 * tree.largest_inflation()),
          internal::rounded_up_to_single(internal::kLaneErrorPerFrame * links * reach)};
}

internal::KernelObstacle kernel_obstacle(const PackedTree& tree) {
  const auto& [center, radius] = tree.root();
  return {tree.nodes(),
          tree.leaves(),
          {static_cast<float>(center.x()), static_cast<float>(center.y()),
           static_cast<float>(center.z())},
          static_cast<float>(radius),
          internal::rounded_up_to_single(3.0 * tree.largest_inflation())};
}

// Tasks that wait at most: every step takes one and leaves at most 64, a node of which lies a level
// deeper, so that at most 63 wait for every level of the two trees.
std::int64_t task_bound(int body_depth, int obstacle_depth) {
  return 63 * (std::int64_t{body_depth} + obstacle_depth + 1) + 1;
}

}  // namespace

MechanismCheck::MechanismCheck(std::span<const MechanismFrame> frames,
                               std::span<const MechanismBody> bodies,
                               std::span<const MechanismObstacle> obstacles,
                               std::span<const MechanismPair> pairs, double pose_error,
                               const MechanismCheckOptions& options) {
  check_input(frames, bodies, obstacles, pairs, pose_error);
  const internal::Kernels& kernels = internal::kernels_for(options.instructions);
  auto parts = std::make_unique<Parts>(internal::JoinedScene(bodies, obstacles, pairs));
  const internal::JoinedScene& scene = parts->scene;
  for (const MechanismFrame& frame : frames) {
    parts->frames.push_back(internal::kernel_frame(frame));
    parts->lane_frames.push_back(lane_frame(parts->frames.back()));
  }
  const std::vector<internal::Chain> chains = internal::chains_of(frames);
  std::vector<SphereTree> body_trees;
  std::vector<SphereTree> obstacle_trees;
  std::vector<double>& reach = parts->reach;  // W
  double bound = 0.0;                         // X
  for (const internal::JoinedSpheres& body : scene.bodies) {
    body_trees.push_back(build_tree(body.spheres));
    reach.push_back(chains[static_cast<std::size_t>(body.frame)].length +
                    internal::node_reach(body_trees.back()));
    bound = std::max(bound, reach.back());
  }
  for (const internal::JoinedSpheres& obstacle : scene.obstacles) {
    obstacle_trees.push_back(build_tree(obstacle.spheres));
    bound = std::max(bound, internal::node_reach(obstacle_trees.back()));
  }
  for (const MechanismPair& pair : pairs) {
    const MechanismBody& body = bodies[static_cast<std::size_t>(pair.body)];
    const MechanismObstacle& obstacle = obstacles[static_cast<std::size_t>(pair.obstacle)];
    bound = std::max({bound, body.tree->reach() + body.frame_from_tree.translation().norm(),
                      obstacle.tree->reach() + obstacle.root_from_tree.translation().norm()});
  }
  if (!(bound <= kMaxCoordinate)) throw Error("mechanism", "it or an obstacle reaches too far");
  parts->trees.reserve(body_trees.size() + obstacle_trees.size());
  int body_depth = 1;
  int obstacle_depth = 1;
  for (std::size_t i = 0; i < body_trees.size(); ++i) {
    const int frame = scene.bodies[i].frame;
    const double links = chains[static_cast<std::size_t>(frame)].frames;
    parts->tilt.push_back(kPerFrame * (links + 1.0));
    const PackedTree& tree = parts->trees.emplace_back(
        body_trees[i], (kPerLength + parts->tilt[i]) * reach[i] + kPerScene * bound + pose_error);
    body_depth = std::max(body_depth, tree.depth());
    parts->bodies.push_back(kernel_body(tree, frame, reach[i], links));
    if (options.always_exact) parts->bodies.back().margin = std::numeric_limits<float>::infinity();
  }
  for (const SphereTree& obstacle : obstacle_trees) {
    const PackedTree& tree = parts->trees.emplace_back(obstacle, kPerScene * bound);
    obstacle_depth = std::max(obstacle_depth, tree.depth());
    parts->obstacles.push_back(kernel_obstacle(tree));
  }
  parts->task_count = task_bound(body_depth, obstacle_depth);
  parts->kernels = &kernels;
  parts->problem = {.frames = parts->frames.data(),
                    .lane_frames = parts->lane_frames.data(),
                    .frame_count = static_cast<std::int32_t>(parts->frames.size()),
                    .variable_count = internal::variable_count(frames),
                    .bodies = parts->bodies.data(),
                    .body_count = static_cast<std::int32_t>(parts->bodies.size()),
                    .obstacles = parts->obstacles.data(),
                    .pairs = scene.pairs.data(),
                    .pair_count = static_cast<std::int32_t>(scene.pairs.size())};
  parts_ = std::move(parts);
}

}  // namespace spherule
