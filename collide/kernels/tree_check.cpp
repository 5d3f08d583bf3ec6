// SPDX-License-Identifier: BSD-3-Clause
#include "collide/kernels/tree_check.h"

#include "base/error.h"
#include "base/rounding.h"
#include "collide/search/relative_pose.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <variant>

namespace spherule::internal {
namespace {

int filled_up(int count) {
  return (count + 3) / 4 * 4;
}

const Kernels& kernels_for(InstructionSet instructions) {
  if (!is_available(instructions)) throw Error("instruction set", "this machine has not got it");
#if defined(SPHERULE_X86_KERNELS)
  if (instructions == InstructionSet::kAvx512) return avx512_kernels();
  if (instructions == InstructionSet::kAvx2) return avx2_kernels();
#endif
  return portable_kernels();
}

const SearchTrees& trees_of(const PlanSource::Obstacle& obstacle) {
  return *std::get<std::shared_ptr<const SearchTrees>>(obstacle.shape);
}

}  // namespace

TreeCheck::Scratch::Scratch(const TreeCheck& check)
    : cache_(check.problem_, check.reach_, check.tilt_) {
  const auto variables = static_cast<std::size_t>(filled_up(check.problem_.variable_count));
  middle_.resize(variables);
  sines_.resize(variables);
  cosines_.resize(variables);
  poses_.resize(check.frames_.size());
  roots_.resize(check.bodies_.size());
  tasks_.resize(static_cast<std::size_t>(check.task_count_));
  lane_variables_.resize(variables);
  lane_poses_.resize(check.frames_.size());
  std::size_t nodes = 0;
  for (const KernelBody& body : check.bodies_) {
    nodes = std::max(nodes, static_cast<std::size_t>(body.node_count));
  }
  queues_.resize(5);
  placed_.resize(nodes + 1);
  generations_.resize(nodes + 1);
  memories_.resize(check.pairs_.size());
  view_ = {.sines = sines_.data(),
           .cosines = cosines_.data(),
           .poses = poses_.data(),
           .roots = roots_.data(),
           .tasks = tasks_.data(),
           .lane_variables = lane_variables_.data(),
           .lane_poses = lane_poses_.data(),
           .queues = {queues_.data(), placed_.data(), generations_.data(), &generation_},
           .memories = memories_.data()};
}

// Reports the spheres of joined sets as the caller knows them.
struct TreeCheck::Translator {
  const TreeCheck& check;
  ConfirmFunction confirm_function;
  void* context;

  static bool confirm(void* translator, std::int32_t lane, KernelPair pair,
                      std::int32_t body_sphere, std::int32_t obstacle_sphere) {
    const Translator& self = *static_cast<const Translator*>(translator);
    const TreeCheck& check = self.check;
    const Origin& body = check.body_origins_[static_cast<std::size_t>(pair.body)]
                                            [static_cast<std::size_t>(body_sphere)];
    const Origin& obstacle = check.obstacle_origins_[static_cast<std::size_t>(pair.obstacle)]
                                                    [static_cast<std::size_t>(obstacle_sphere)];
    const std::int32_t test =
        check.tests_[static_cast<std::size_t>(body.part) * check.obstacle_count_ +
                     static_cast<std::size_t>(obstacle.part)];
    return self.confirm_function(self.context, lane, {test, body.sphere, obstacle.sphere});
  }
};

bool TreeCheck::is_in_range(std::span<const double> positions) {
  return std::all_of(positions.begin(), positions.end(),
                     [](double position) { return std::abs(position) <= kLargestPosition; });
}

bool TreeCheck::collides(std::span<const double> positions, Scratch& scratch,
                         ConfirmFunction confirm_function, void* context) const {
  assert(is_in_range(positions));
  assert(positions.size() >= static_cast<std::size_t>(problem_.variable_count));
  Translator translator{*this, confirm_function, context};
  return scratch.cache_.collides(*kernels_, problem_, positions.data(), scratch.view_,
                                 &Translator::confirm, &translator);
}

std::optional<bool> TreeCheck::is_free_along(std::span<const double> from,
                                             std::span<const double> to, Scratch& scratch) const {
  assert(is_in_range(from) && is_in_range(to));
  for (std::size_t i = 0; i < static_cast<std::size_t>(problem_.variable_count); ++i) {
    scratch.middle_[i] = 0.5 * from[i] + 0.5 * to[i];
  }
  return scratch.cache_.is_free_along(*kernels_, problem_, from.data(), to.data(),
                                      scratch.middle_.data(), scratch.view_);
}

void TreeCheck::remember_contact(std::int32_t test, const Sphere& sphere, double depth,
                                 Scratch& scratch) const {
  const auto body = static_cast<std::size_t>(body_of_test_[static_cast<std::size_t>(test)]);
  const auto& [frame, frame_from_body] = body_places_[body];
  scratch.cache_.remember_contact(frame, {frame_from_body * sphere.center, sphere.radius}, depth,
                                  scratch.view_);
}

KernelBlockAnswer TreeCheck::collides(std::span<const double* const, kBlock> configurations,
                                      Scratch& scratch, ConfirmFunction confirm_function,
                                      void* context) const {
  Translator translator{*this, confirm_function, context};
  return kernels_->check_block(problem_, configurations.data(), scratch.view_, &Translator::confirm,
                               &translator);
}

// Bodies and obstacles that are searched together: obstacles that meet the same bodies, and bodies
// on one frame that meet the same obstacles. Only those that are in a test are here, and the pairs
// stand in the order in which they, or what they are joined with, are first named.
struct TreeCheck::Scene {
  std::vector<Joined> bodies;
  std::vector<Joined> obstacles;
  std::vector<KernelPair> pairs;

  Scene(const PlanSource& source, std::span<const PlanSource::Test> tests) {
    std::vector<std::set<int>> met_by(source.obstacles.size());
    for (const PlanSource::Test& test : tests) {
      met_by[static_cast<std::size_t>(test.other)].insert(test.body);
    }
    std::map<std::set<int>, int> obstacle_groups;
    std::vector<int> group_of_obstacle(source.obstacles.size(), -1);
    for (std::size_t i = 0; i < source.obstacles.size(); ++i) {
      if (met_by[i].empty()) continue;
      const auto [group, is_new] =
          obstacle_groups.emplace(met_by[i], static_cast<int>(obstacles.size()));
      if (is_new) obstacles.emplace_back();
      group_of_obstacle[i] = group->second;
      add(obstacles[static_cast<std::size_t>(group->second)], static_cast<int>(i),
          trees_of(source.obstacles[i]), source.obstacles[i].root_from_shape);
    }

    std::vector<std::vector<int>> meets(source.bodies.size());  // groups, in the tests' order
    for (const PlanSource::Test& test : tests) {
      std::vector<int>& groups = meets[static_cast<std::size_t>(test.body)];
      const int group = group_of_obstacle[static_cast<std::size_t>(test.other)];
      if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
    }
    std::map<std::pair<int, std::vector<int>>, int> body_groups;
    std::vector<char> is_added(source.bodies.size(), 0);
    for (const PlanSource::Test& test : tests) {
      const auto index = static_cast<std::size_t>(test.body);
      if (std::exchange(is_added[index], 1) != 0) continue;
      const PlanSource::Body& body = source.bodies[index];
      const auto [group, is_new] =
          body_groups.emplace(std::pair(body.frame, meets[index]), static_cast<int>(bodies.size()));
      if (is_new) {
        bodies.push_back({.frame = body.frame});
        for (const int obstacle : meets[index]) pairs.push_back({group->second, obstacle});
      }
      add(bodies[static_cast<std::size_t>(group->second)], test.body, *body.trees,
          body.frame_from_trees);
    }
  }

 private:
  static void add(Joined& joined, int part, const SearchTrees& trees, const Pose& pose) {
    const std::span<const Sphere> spheres = trees.narrow.spheres();
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      joined.spheres.push_back({pose * spheres[i].center, spheres[i].radius});
      joined.origins.push_back({part, static_cast<std::int32_t>(i)});
    }
  }
};

namespace {

// Error budget, v = 2^-24, u = 2^-53; n frames lie between the root and a body. No point of the
// body, and no centre of a node of its tree, is further from the root than W: the lengths of the
// chain, kLargestPosition for each shift, and how far the tree reaches in its frame.
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
// grown by KernelBody::lane_error beside it, see tree_poses.h.
constexpr double kPerLength = 12.0 * kFloatRoundoff;
constexpr double kPerFrame = 5.0 * kSineError;
constexpr double kPerScene = 1e-12;

// What is below this is an axis at a right angle, and costs less as zero: far below the budget of
// tree_poses.h, where entries are rounded by up to 6e-8.
constexpr double kNegligible = 0x1p-40;

KernelLaneFrame lane_frame(const KernelFrame& frame) {
  KernelLaneFrame result = {};
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
KernelBody kernel_body(const PackedTree& tree, int frame, double reach, double links) {
  const auto& [center, radius] = tree.root();
  return {tree.nodes(),
          tree.leaves(),
          tree.node_count(),
          {center.x(), center.y(), center.z()},
          {static_cast<float>(center.x()), static_cast<float>(center.y()),
           static_cast<float>(center.z())},
          static_cast<float>(radius),
          frame,
          rounded_up_to_single(3.0 * tree.largest_inflation()),
          rounded_up_to_single(kLaneErrorPerFrame * links * reach)};
}

KernelObstacle kernel_obstacle(const PackedTree& tree) {
  const auto& [center, radius] = tree.root();
  return {tree.nodes(),
          tree.leaves(),
          {static_cast<float>(center.x()), static_cast<float>(center.y()),
           static_cast<float>(center.z())},
          static_cast<float>(radius),
          rounded_up_to_single(3.0 * tree.largest_inflation())};
}

KernelFrame kernel_frame(const PlanSource::Frame& frame) {
  KernelFrame result = {};
  const Eigen::Matrix3d rotation = frame.parent_from_frame.matrix();
  const Eigen::Vector3d& origin = frame.parent_from_frame.translation();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result.rotation[j][i] = rotation(i, j);
    result.origin[i] = origin[i];
  }
  result.parent = frame.parent;
  result.variable = frame.position;
  result.prismatic = frame.prismatic;
  return result;
}

// Tasks that wait at most: every step takes one and leaves at most 64, a node of which lies a level
// deeper, so that at most 63 wait for every level of the two trees.
std::int64_t task_bound(int body_depth, int obstacle_depth) {
  return 63 * (std::int64_t{body_depth} + obstacle_depth + 1) + 1;
}

}  // namespace

TreeCheck::TreeCheck(const PlanSource& source, std::size_t first_test, InstructionSet instructions)
    : obstacle_count_(source.obstacles.size()),
      tests_(source.bodies.size() * source.obstacles.size(), -1),
      kernels_(&kernels_for(instructions)) {
  const std::span<const PlanSource::Test> tests = std::span(source.tests).subspan(first_test);
  for (const PlanSource::Body& body : source.bodies) {
    body_places_.emplace_back(body.frame, body.frame_from_trees);
  }
  bool is_confirmed = false;
  for (std::size_t i = 0; i < source.tests.size(); ++i) {
    const PlanSource::Test& test = source.tests[i];
    body_of_test_.push_back(test.body);
    if (i < first_test) continue;
    const auto body = static_cast<std::size_t>(test.body);
    const auto obstacle = static_cast<std::size_t>(test.other);
    tests_[body * obstacle_count_ + obstacle] = static_cast<std::int32_t>(i);
    is_confirmed =
        is_confirmed || source.bodies[body].is_confirmed || source.obstacles[obstacle].is_confirmed;
  }
  const Scene scene(source, tests);
  for (const PlanSource::Frame& frame : source.frames) {
    frames_.push_back(kernel_frame(frame));
    lane_frames_.push_back(lane_frame(frames_.back()));
  }
  compile_trees(scene, source, tests);
  if (is_confirmed) {
    for (KernelBody& body : bodies_) body.margin = std::numeric_limits<float>::infinity();
  }
  pairs_ = scene.pairs;
  problem_ = {.frames = frames_.data(),
              .lane_frames = lane_frames_.data(),
              .frame_count = static_cast<std::int32_t>(frames_.size()),
              .variable_count = position_count(source.frames),
              .bodies = bodies_.data(),
              .body_count = static_cast<std::int32_t>(bodies_.size()),
              .obstacles = obstacles_.data(),
              .pairs = pairs_.data(),
              .pair_count = static_cast<std::int32_t>(pairs_.size())};
}

void TreeCheck::compile_trees(const Scene& scene, const PlanSource& source,
                              std::span<const PlanSource::Test> tests) {
  const std::vector<Chain> chains = chains_of(source.frames);
  std::vector<SphereTree> body_trees;
  std::vector<SphereTree> obstacle_trees;
  double bound = 0.0;  // X
  for (const Joined& body : scene.bodies) {
    body_origins_.push_back(body.origins);
    body_trees.push_back(build_tree(body.spheres));
    reach_.push_back(chains[static_cast<std::size_t>(body.frame)].length +
                     node_reach(body_trees.back()));
    bound = std::max(bound, reach_.back());
  }
  for (const Joined& obstacle : scene.obstacles) {
    obstacle_origins_.push_back(obstacle.origins);
    obstacle_trees.push_back(build_tree(obstacle.spheres));
    bound = std::max(bound, node_reach(obstacle_trees.back()));
  }
  const auto reach = [](const SearchTrees& trees, const Pose& pose) {
    return trees.narrow.reach() + pose.translation().norm();
  };
  for (const PlanSource::Test& test : tests) {
    const PlanSource::Body& body = source.bodies[static_cast<std::size_t>(test.body)];
    const PlanSource::Obstacle& obstacle = source.obstacles[static_cast<std::size_t>(test.other)];
    bound = std::max({bound, reach(*body.trees, body.frame_from_trees),
                      reach(trees_of(obstacle), obstacle.root_from_shape)});
  }
  if (!(bound <= kMaxCoordinate)) throw Error("robot", "it or an obstacle reaches too far");
  trees_.reserve(body_trees.size() + obstacle_trees.size());
  int body_depth = 1;
  int obstacle_depth = 1;
  for (std::size_t i = 0; i < body_trees.size(); ++i) {
    const int frame = scene.bodies[i].frame;
    const double links = chains[static_cast<std::size_t>(frame)].frames;
    tilt_.push_back(kPerFrame * (links + 1.0));
    const PackedTree& tree = trees_.emplace_back(
        body_trees[i], (kPerLength + tilt_[i]) * reach_[i] + kPerScene * bound + source.pose_error);
    body_depth = std::max(body_depth, tree.depth());
    bodies_.push_back(kernel_body(tree, frame, reach_[i], links));
  }
  for (const SphereTree& obstacle : obstacle_trees) {
    const PackedTree& tree = trees_.emplace_back(obstacle, kPerScene * bound);
    obstacle_depth = std::max(obstacle_depth, tree.depth());
    obstacles_.push_back(kernel_obstacle(tree));
  }
  task_count_ = task_bound(body_depth, obstacle_depth);
}

}  // namespace spherule::internal
