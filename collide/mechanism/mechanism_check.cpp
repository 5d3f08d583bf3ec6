// SPDX-License-Identifier: BSD-3-Clause
#include "collide/mechanism/mechanism_check.h"

#include "base/error.h"
#include "base/rounding.h"
#include "collide/mechanism/mechanism_parts.h"
#include "collide/search/packed_tree.h"
#include "collide/search/relative_pose.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace spherule {
namespace {

int filled_up(int count) {
  return (count + 3) / 4 * 4;
}

}  // namespace

MechanismCheck::~MechanismCheck() = default;
MechanismCheck::MechanismCheck(const MechanismCheck&) noexcept = default;
MechanismCheck& MechanismCheck::operator=(const MechanismCheck&) noexcept = default;

MechanismCheck::Scratch::Scratch(const MechanismCheck& check)
    : memory_(std::make_unique<Memory>()) {
  require_rounding_to_nearest();
  const Parts& parts = *check.parts_;
  memory_->owner = check.parts_;
  const auto variables = static_cast<std::size_t>(filled_up(parts.problem.variable_count));
  memory_->middle.resize(variables);
  memory_->sines.resize(variables);
  memory_->cosines.resize(variables);
  memory_->poses.resize(parts.frames.size());
  memory_->roots.resize(parts.bodies.size());
  memory_->tasks.resize(static_cast<std::size_t>(parts.task_count));
  memory_->lane_variables.resize(variables);
  memory_->lane_poses.resize(parts.frames.size());
  std::size_t nodes = 0;
  for (const internal::KernelBody& body : parts.bodies) {
    nodes = std::max(nodes, static_cast<std::size_t>(body.node_count));
  }
  memory_->queues.resize(5);
  memory_->placed.resize(nodes + 1);
  memory_->generations.resize(nodes + 1);
  memory_->memories.resize(parts.scene.pairs.size());
  memory_->view = {.sines = memory_->sines.data(),
                   .cosines = memory_->cosines.data(),
                   .poses = memory_->poses.data(),
                   .roots = memory_->roots.data(),
                   .tasks = memory_->tasks.data(),
                   .lane_variables = memory_->lane_variables.data(),
                   .lane_poses = memory_->lane_poses.data(),
                   .queues = {memory_->queues.data(), memory_->placed.data(),
                              memory_->generations.data(), &memory_->generation},
                   .memories = memory_->memories.data()};
  memory_->motion.emplace(parts.problem, parts.reach, parts.tilt);
}

MechanismCheck::Scratch::~Scratch() = default;
MechanismCheck::Scratch::Scratch(Scratch&&) noexcept = default;
MechanismCheck::Scratch& MechanismCheck::Scratch::operator=(Scratch&&) noexcept = default;

void MechanismCheck::require_own(const Scratch& scratch) const {
  if (!scratch.memory_ || scratch.memory_->owner != parts_) {
    throw Error("scratch", "it was made for another check");
  }
}

bool MechanismCheck::is_in_range(std::span<const double> variables) {
  return std::all_of(variables.begin(), variables.end(),
                     [](double v) { return std::abs(v) <= MechanismCheck::kLargestVariable; });
}

bool MechanismCheck::collides(std::span<const double> variables, Scratch& scratch,
                              ConfirmFunction confirm_function, void* context) const {
  assert(is_in_range(variables));
  assert(variables.size() >= static_cast<std::size_t>(parts_->problem.variable_count));
  require_own(scratch);
  Translator translator{parts_->scene, confirm_function, context};
  Scratch::Memory& memory = *scratch.memory_;
  return memory.motion->collides(*parts_->kernels, parts_->problem, variables.data(), memory.view,
                                 &Translator::confirm, &translator);
}

std::optional<bool> MechanismCheck::is_free_along(std::span<const double> from,
                                                  std::span<const double> to,
                                                  Scratch& scratch) const {
  assert(is_in_range(from) && is_in_range(to));
  require_own(scratch);
  Scratch::Memory& memory = *scratch.memory_;
  for (std::size_t i = 0; i < static_cast<std::size_t>(parts_->problem.variable_count); ++i) {
    memory.middle[i] = 0.5 * from[i] + 0.5 * to[i];
  }
  return memory.motion->is_free_along(*parts_->kernels, parts_->problem, from.data(), to.data(),
                                      memory.middle.data(), memory.view);
}

bool MechanismCheck::is_following(const Scratch& scratch) const {
  require_own(scratch);
  return scratch.memory_->motion->is_following();
}

void MechanismCheck::remember_contact(int frame, const Sphere& sphere, double depth,
                                      Scratch& scratch) const {
  require_own(scratch);
  scratch.memory_->motion->remember_contact(frame, sphere, depth, scratch.memory_->view);
}

MechanismCheck::BlockAnswer MechanismCheck::collides(
    std::span<const double* const, kBlock> configurations, Scratch& scratch,
    ConfirmFunction confirm_function, void* context) const {
  static_assert(kBlock == internal::kLanes && kLargestVariable == internal::kLargestKernelVariable);
  require_own(scratch);
  Translator translator{parts_->scene, confirm_function, context};
  const auto [hits, refused] =
      parts_->kernels->check_block(parts_->problem, configurations.data(), scratch.memory_->view,
                                   &Translator::confirm, &translator);
  return {hits, refused};
}

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
  }
  internal::check_obstacles(obstacles);
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

namespace spherule::internal {
namespace {

constexpr int kLargestIndex = 1 << 20;  // of a variable: there is memory for all up to it

[[noreturn]] void refuse(const std::string& what, std::size_t index, const std::string& why) {
  throw Error("mechanism", what + " " + std::to_string(index) + ' ' + why);
}

bool is_below(int index, std::size_t count) {
  return index >= 0 && static_cast<std::size_t>(index) < count;
}

}  // namespace

void check_frames(std::span<const MechanismFrame> frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].parent < -1 || frames[i].parent >= static_cast<int>(i)) {
      refuse("frame", i, "does not come after its parent");
    }
    if (frames[i].variable < 0 || frames[i].variable > kLargestIndex) {
      refuse("frame", i, "has no variable that could be");
    }
  }
}

void check_body(std::size_t body, int frame, std::size_t frame_count, bool has_shape) {
  if (!is_below(frame, frame_count)) refuse("body", body, "is on no frame");
  if (!has_shape) refuse("body", body, "has no shape");
}

void check_obstacles(std::span<const MechanismObstacle> obstacles) {
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    if (!obstacles[i].tree) refuse("obstacle", i, "has no tree");
  }
}

void check_pairs(std::span<const MechanismPair> pairs, std::size_t bodies, std::size_t obstacles) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!is_below(pairs[i].body, bodies) || !is_below(pairs[i].obstacle, obstacles)) {
      refuse("pair", i, "names what is not there");
    }
  }
}

void check_pose_error(double pose_error) {
  if (!(pose_error >= 0.0 && pose_error <= kMaxCoordinate)) {
    throw Error("pose error", "it is negative, not finite or too large");
  }
}

KernelFrame kernel_frame(const MechanismFrame& frame) {
  KernelFrame result = {};
  const Eigen::Matrix3d rotation = frame.parent_from_frame.matrix();
  const Eigen::Vector3d& origin = frame.parent_from_frame.translation();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result.rotation[j][i] = rotation(i, j);
    result.origin[i] = origin[i];
  }
  result.parent = frame.parent;
  result.variable = frame.variable;
  result.prismatic = frame.prismatic;
  return result;
}

int variable_count(std::span<const MechanismFrame> frames) {
  int count = 0;
  for (const MechanismFrame& frame : frames) count = std::max(count, frame.variable + 1);
  return count;
}

std::vector<Chain> chains_of(std::span<const MechanismFrame> frames) {
  std::vector<Chain> chains;
  for (const MechanismFrame& frame : frames) {
    Chain chain = frame.parent < 0 ? Chain() : chains[static_cast<std::size_t>(frame.parent)];
    chain.length += frame.parent_from_frame.translation().norm() +
                    (frame.prismatic ? MechanismCheck::kLargestVariable : 0.0);
    chain.frames += 1.0;
    if (chain.frames > kLongestLaneChain) {
      throw Error("mechanism", "too many frames stand on each other");
    }
    chains.push_back(chain);
  }
  return chains;
}

const Kernels& kernels_for(InstructionSet instructions) {
  if (!is_available(instructions)) throw Error("instruction set", "this machine has not got it");
#if defined(SPHERULE_X86_KERNELS)
  if (instructions == InstructionSet::kAvx512) return avx512_kernels();
  if (instructions == InstructionSet::kAvx2) return avx2_kernels();
#endif
  return portable_kernels();
}

namespace {

void add(JoinedSpheres& joined, int part, const SphereTree& tree, const Pose& pose) {
  const std::span<const Sphere> spheres = tree.spheres();
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    joined.spheres.push_back({pose * spheres[i].center, spheres[i].radius});
    joined.origins.push_back({part, static_cast<std::int32_t>(i)});
  }
}

}  // namespace

JoinedScene::JoinedScene(std::span<const MechanismBody> all_bodies,
                         std::span<const MechanismObstacle> all_obstacles,
                         std::span<const MechanismPair> all_pairs) {
  std::vector<std::set<int>> met_by(all_obstacles.size());
  for (const MechanismPair& pair : all_pairs) {
    met_by[static_cast<std::size_t>(pair.obstacle)].insert(pair.body);
  }
  std::map<std::set<int>, int> obstacle_groups;
  std::vector<int> group_of_obstacle(all_obstacles.size(), -1);
  for (std::size_t i = 0; i < all_obstacles.size(); ++i) {
    if (met_by[i].empty()) continue;
    const auto [group, is_new] =
        obstacle_groups.emplace(met_by[i], static_cast<int>(obstacles.size()));
    if (is_new) obstacles.emplace_back();
    group_of_obstacle[i] = group->second;
    add(obstacles[static_cast<std::size_t>(group->second)], static_cast<int>(i),
        *all_obstacles[i].tree, all_obstacles[i].root_from_tree);
  }

  std::vector<std::vector<int>> intersects(all_bodies.size());  // groups, in the order of the pairs
  for (const MechanismPair& pair : all_pairs) {
    std::vector<int>& groups = intersects[static_cast<std::size_t>(pair.body)];
    const int group = group_of_obstacle[static_cast<std::size_t>(pair.obstacle)];
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  }
  std::map<std::pair<int, std::vector<int>>, int> body_groups;
  std::vector<char> is_added(all_bodies.size(), 0);
  for (const MechanismPair& pair : all_pairs) {
    const auto body = static_cast<std::size_t>(pair.body);
    if (std::exchange(is_added[body], 1) != 0) continue;
    const int frame = all_bodies[body].frame;
    const auto [group, is_new] =
        body_groups.emplace(std::pair(frame, intersects[body]), static_cast<int>(bodies.size()));
    if (is_new) {
      bodies.push_back({.frame = frame});
      for (const int obstacle : intersects[body]) pairs.push_back({group->second, obstacle});
    }
    add(bodies[static_cast<std::size_t>(group->second)], pair.body, *all_bodies[body].tree,
        all_bodies[body].frame_from_tree);
  }
}

}  // namespace spherule::internal
