// SPDX-License-Identifier: BSD-3-Clause
#include "collide/kernels/compiled_plan.h"

#include "base/error.h"
#include "base/rounding.h"
#include "collide/kernels/tree_kernel.h"
#include "collide/search/packed_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

// Error budget, v being the unit roundoff of Real (2^-24 or 2^-53); n frames lie between the root
// and a body. No point of the body, and no centre of a node of its tree, is further from the root
// than W: the lengths of the chain, kLargestPosition for each shift, and how far the tree reaches
// in its frame. X bounds W for all bodies, and how far obstacles reach that are trees.
//   placed centres (`error` of a body): 38 v n W and 12 v W of plan_poses.h, and in double what its
//     sines err by, less than 5e-11 n W;
//   the middles of parts: positions err by less than kMiddleError, which moves a point by less than
//     that times 2 W a joint (once for a shift);
//   poses for which the answer holds: `pose_error` for each of the two ends between which a motion
//   is
//     compared (from the middle to the exact mechanism, and from there to the computed poses of any
//     other configuration), of both bodies, with the slack of the canonical test: 4 pose_error;
//   centres were moved to their frame in double: 1e-12 X.
// The first is counted twice (plan_search.h).

namespace spherule::internal {
namespace {

constexpr double kPerScene = 1e-12;
constexpr double kVelocityErrors = 16.0;
// What is below this is an axis at a right angle, and costs less as zero: far below the budget of
// rotations in single precision.
constexpr double kNegligible = 0x1p-40;

template <class Real>
constexpr double kSineErrors = 0.0;
template <>
constexpr double kSineErrors<double> = 5e-11;

template <class Real>
PlanFrame<Real> root_frame() {
  return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}, 0, 0, false};
}

// Whether a joint moves the one body against the root that does not move the other.
bool moves_otherwise(const PlanSource& source, int body, int other) {
  const auto frame_of = [&](int index) {
    return source.bodies[static_cast<std::size_t>(index)].frame;
  };
  int frame = frame_of(other);
  while (frame > frame_of(body)) frame = source.frames[static_cast<std::size_t>(frame)].parent;
  return frame != frame_of(body);
}

PlanFreeCells compiled_cells(const FreeCells* cells) {
  static_assert(PlanFreeCells::kCells == FreeCells::kCells && FreeCells::kMostJoints == 2);
  PlanFreeCells result{};
  if (cells == nullptr) return result;
  result.words = cells->words().data();
  for (std::size_t i = 0; i < 2; ++i) {
    result.position[i] = cells->axes()[i].position;
    result.lower[i] = cells->axes()[i].lower;
    result.scale[i] = cells->axes()[i].scale;
  }
  return result;
}

}  // namespace

int position_count(std::span<const PlanSource::Frame> frames) {
  int count = 0;
  for (const PlanSource::Frame& frame : frames) count = std::max(count, frame.position + 1);
  return count;
}

std::vector<Chain> chains_of(std::span<const PlanSource::Frame> frames) {
  std::vector<Chain> chains;
  for (const PlanSource::Frame& frame : frames) {
    Chain chain = frame.parent < 0 ? Chain() : chains[static_cast<std::size_t>(frame.parent)];
    chain.length +=
        frame.parent_from_frame.translation().norm() + (frame.prismatic ? kLargestPosition : 0.0);
    chain.frames += 1.0;
    if (chain.frames > kLongestLaneChain) {
      throw Error("robot", "too many joints stand on each other");
    }
    chains.push_back(chain);
  }
  return chains;
}

template <class Real>
struct CompiledPlan<Real>::Reach {
  std::vector<Chain> chains;
  std::vector<double> reach;   // W of each body
  std::vector<double> error;   // of its placed centres
  std::vector<double> joints;  // n
  double largest = 0.0;        // the largest W
  double largest_error = 0.0;
  double scene = 0.0;  // X
};

template <class Real>
CompiledPlan<Real>::CompiledPlan(const PlanSource& source) {
  constexpr double v = kRoundoff<Real>;
  Reach reach;
  reach.chains = chains_of(source.frames);
  for (const PlanSource::Body& body : source.bodies) {
    const Chain chain =
        body.frame < 0 ? Chain() : reach.chains[static_cast<std::size_t>(body.frame)];
    double size = 0.0;
    for (const Sphere& sphere : body.trees->narrow.spheres()) {
      size = std::max(size, (body.frame_from_trees * sphere.center).norm() + sphere.radius);
    }
    // Spheres around others reach no further than twice as far.
    const double length = chain.length + 2.0 * size;
    reach.joints.push_back(chain.frames);
    reach.reach.push_back(length);
    reach.error.push_back(((38.0 * v + kSineErrors<Real>)*chain.frames + 12.0 * v) * length);
    reach.largest = std::max(reach.largest, length);
    reach.largest_error = std::max(reach.largest_error, reach.error.back());
  }
  reach.scene = reach.largest;
  for (const PlanSource::Obstacle& obstacle : source.obstacles) {
    reach.scene = std::max(reach.scene, reach_of(obstacle));
  }
  if (!(reach.scene <= kMaxCoordinate)) throw Error("robot", "it or an obstacle reaches too far");
  plan_.position_count = std::max(1, position_count(source.frames));
  compile_frames(source);
  compile_bodies(source, reach);
  compile_obstacles(source, reach);
  compile_tests(source, reach);
  compile_pairs(source);
  compile_paths(source.body_paths, body_paths_);
  plan_.frames = frames_.data();
  plan_.frame_count = static_cast<std::int32_t>(frames_.size());
  plan_.bodies = bodies_.data();
  plan_.body_count = static_cast<std::int32_t>(bodies_.size());
  plan_.groups = groups_.data();
  plan_.obstacles = obstacles_.data();
  plan_.first_pair = static_cast<std::int32_t>(groups_.size()) * kPlanLanes;
  plan_.test_count = plan_.first_pair + static_cast<std::int32_t>(pairs_.size());
  plan_.word_count = (plan_.test_count + 63) / 64;
  plan_.pairs = pairs_.data();
  plan_.free_cells = pair_cells_.data();
  plan_.pair_count = static_cast<std::int32_t>(pairs_.size());
  plan_.first_never = static_cast<std::int32_t>(std::count_if(
      source.tests.begin(), source.tests.end(),
      [](const PlanSource::Test& test) { return !test.is_obstacle && !test.never_touches; }));
  plan_.bound_count = 1 + static_cast<std::int32_t>(pair_paths_.size());
  plan_.body_paths = body_paths_.data();
  plan_.pair_paths = pair_paths_.data();
  plan_.steps = steps_.data();
  plan_.slides = std::any_of(source.frames.begin(), source.frames.end(),
                             [](const PlanSource::Frame& frame) { return frame.prismatic; });
  plan_.bound_slack = rounded_up<Real>(1.0 + (4.0 * static_cast<double>(longest_path_) + 32.0) * v);
  center_error_ = reach.largest_error;
  plan_.velocity_error = rounded_up<Real>(kVelocityErrors * center_error_);
}

template <class Real>
void CompiledPlan<Real>::compile_frames(const PlanSource& source) {
  frames_.push_back(root_frame<Real>());
  for (const PlanSource::Frame& frame : source.frames) {
    PlanFrame<Real> compiled = root_frame<Real>();
    const Eigen::Matrix3d& rotation = frame.parent_from_frame.matrix();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double entry = rotation(i, j);
        compiled.rotation[j][i] = static_cast<Real>(std::abs(entry) < kNegligible ? 0.0 : entry);
      }
      compiled.origin[i] = static_cast<Real>(frame.parent_from_frame.translation()[i]);
    }
    compiled.parent = frame.parent + 1;
    compiled.position = frame.position;
    compiled.prismatic = frame.prismatic;
    frames_.push_back(compiled);
  }
}

// Appends the tree, placed, to the nodes; returns where it begins. `largest` is the most that was
// added to the radius of a leaf.
template <class Real>
std::int32_t CompiledPlan<Real>::add_tree(const SearchTrees& trees, const Pose& pose,
                                          double inflation, double& largest) {
  const SphereTree& tree = trees.narrow;
  const auto first = static_cast<std::int32_t>(nodes_.size());
  // Depth first; a node's end is known once what is below it is there.
  const auto visit = [&](const auto& self, std::size_t node) -> void {
    const std::size_t place = nodes_.size();
    PlanNode<Real>& added = nodes_.emplace_back();
    const Sphere& sphere = trees.narrow_spheres[node];
    const Eigen::Vector3d center = pose * sphere.center;
    for (int i = 0; i < 3; ++i) added.center[i] = static_cast<Real>(center[i]);
    added.radius = inflated_radius<Real>(sphere.radius, inflation);
    added.sphere = tree.is_leaf(node) ? tree.sphere_index(node) : -1;
    if (tree.is_leaf(node)) {
      largest = std::max(largest, sub_up(static_cast<double>(added.radius), sphere.radius));
    } else {
      for (std::int32_t i = 0; i < tree.child_count(node); ++i) {
        self(self, static_cast<std::size_t>(tree.first_child(node) + i));
      }
    }
    nodes_[place].next = static_cast<std::int32_t>(nodes_.size()) - first;
  };
  visit(visit, 0);
  // Opening a node of either tree puts at most so many tasks in the place of one, a level deeper.
  height_ = std::max(height_, static_cast<std::size_t>(tree.depth()) + 1);
  task_count_ = SearchTrees::kNarrow * (2 * height_ + 1) + 2;
  return first;
}

template <class Real>
void CompiledPlan<Real>::compile_bodies(const PlanSource& source, const Reach& reach) {
  std::vector<std::int32_t> firsts;
  for (std::size_t i = 0; i < source.bodies.size(); ++i) {
    const double middle = reach.joints[i] * kMiddleError * std::max(2.0 * reach.reach[i], 1.0);
    const double inflation =
        2.0 * reach.error[i] + 4.0 * source.pose_error + middle + kPerScene * reach.scene;
    inflations_.push_back(inflation);
    double largest = 0.0;
    firsts.push_back(
        add_tree(*source.bodies[i].trees, source.bodies[i].frame_from_trees, inflation, largest));
    PlanBody<Real>& body = bodies_.emplace_back();
    body.frame = source.bodies[i].frame + 1;
    body.node_count = static_cast<std::int32_t>(nodes_.size()) - firsts.back();
    body.first_center = static_cast<std::int32_t>(center_count_);
    body.error = rounded_up<Real>(reach.error[i]);
    body.is_confirmed = source.bodies[i].is_confirmed;
    body.margin =
        body.is_confirmed ? std::numeric_limits<Real>::infinity() : rounded_up<Real>(3.0 * largest);
    center_count_ += static_cast<std::size_t>(body.node_count);
  }
  // Obstacles that are trees follow: no more nodes after them, so that these stay where they are.
  std::vector<std::int32_t> tree_firsts(source.obstacles.size(), 0);
  obstacle_inflations_.assign(source.obstacles.size(), 0.0);
  for (std::size_t i = 0; i < source.obstacles.size(); ++i) {
    PlanObstacle<Real>& obstacle = obstacles_.emplace_back();
    const auto* const trees =
        std::get_if<std::shared_ptr<const SearchTrees>>(&source.obstacles[i].shape);
    if (trees == nullptr) continue;
    const double error = 2.0 * kRoundoff<Real> * reach_of(source.obstacles[i]);
    obstacle_inflations_[i] = 2.0 * error + kPerScene * reach.scene;
    double largest = 0.0;
    tree_firsts[i] =
        add_tree(**trees, source.obstacles[i].root_from_shape, obstacle_inflations_[i], largest);
    obstacle.shape = PlanShape::kTree;
    obstacle.error = rounded_up<Real>(error);
    obstacle.is_confirmed = source.obstacles[i].is_confirmed;
    obstacle.margin = obstacle.is_confirmed ? std::numeric_limits<Real>::infinity()
                                            : rounded_up<Real>(3.0 * largest);
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i].nodes = nodes_.data() + firsts[i];
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    if (obstacles_[i].shape == PlanShape::kTree)
      obstacles_[i].nodes = nodes_.data() + tree_firsts[i];
  }
}

template <class Real>
void CompiledPlan<Real>::compile_obstacles(const PlanSource& source, const Reach& reach) {
  for (std::size_t i = 0; i < source.obstacles.size(); ++i) {
    const PlanSource::Obstacle& obstacle = source.obstacles[i];
    if (obstacles_[i].shape != PlanShape::kTree) {
      obstacles_[i] = compiled_solid<Real>(obstacle, reach.largest);
    }
    obstacle_boxes_.push_back(compiled_box<Real>(obstacle, reach.largest));
  }
}

// Obstacles that a body never gets to are left out: all its points stay within the lengths of its
// chain behind the first joint (and its own) of where that joint is. Judged in double, so that
// plans of the same source have the same tests.
template <class Real>
void CompiledPlan<Real>::compile_tests(const PlanSource& source, const Reach& reach) {
  constexpr double kReachSlack = 1e-6;  // far above all roundings
  std::vector<PlanBoxes<double>> double_boxes;
  for (const PlanSource::Obstacle& obstacle : source.obstacles) {
    double_boxes.push_back(compiled_box<double>(obstacle, reach.largest));
  }
  std::vector<std::vector<std::size_t>> obstacle_tests(bodies_.size());
  for (std::size_t t = 0; t < source.tests.size(); ++t) {
    const PlanSource::Test& test = source.tests[t];
    if (test.is_obstacle) obstacle_tests[static_cast<std::size_t>(test.body)].push_back(t);
  }
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Sphere around = reachable(source, b, reach.reach[b]);
    const double limit = around.radius + kReachSlack * reach.reach[b] + 4.0 * source.pose_error;
    bodies_[b].first_group = static_cast<std::int32_t>(groups_.size());
    int lane = kPlanLanes;
    for (const std::size_t t : obstacle_tests[b]) {
      const PlanSource::Test& test = source.tests[t];
      const auto obstacle = static_cast<std::size_t>(test.other);
      if (distance_from_box(around.center, double_boxes[obstacle]) > limit) continue;
      const PlanBoxes<Real>& box = obstacle_boxes_[obstacle];
      if (lane == kPlanLanes) {
        groups_.push_back(empty_boxes<Real>());
        groups_.back().body = static_cast<std::int32_t>(b);
        source_tests_.resize(source_tests_.size() + kPlanLanes, -1);
        lane = 0;
      }
      PlanBoxes<Real>& group = groups_.back();
      for (int i = 0; i < 3; ++i) {
        group.lower[i][lane] = box.lower[i][0];
        group.upper[i][lane] = box.upper[i][0];
      }
      group.obstacle[lane] = test.other;
      source_tests_[source_tests_.size() - kPlanLanes + static_cast<std::size_t>(lane)] =
          static_cast<std::int32_t>(t);
      ++lane;
    }
    bodies_[b].group_count = static_cast<std::int32_t>(groups_.size()) - bodies_[b].first_group;
  }
}

// What never touches last. Short paths first: these are the pairs that are near each other, and
// paths of one length leave no lane idle.
template <class Real>
void CompiledPlan<Real>::compile_pairs(const PlanSource& source) {
  struct Numbered {
    std::size_t test;
    const PlanSource::Path* path;
  };
  std::vector<Numbered> order;
  for (std::size_t t = 0; t < source.tests.size(); ++t) {
    if (!source.tests[t].is_obstacle) order.push_back({t, &source.pair_paths[order.size()]});
  }
  const auto rank = [&](const Numbered& pair) {
    return std::pair(source.tests[pair.test].never_touches, pair.path->size());
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](const Numbered& a, const Numbered& b) { return rank(a) < rank(b); });
  std::vector<PlanSource::Path> paths;
  for (const Numbered& numbered : order) {
    const PlanSource::Test& test = source.tests[numbered.test];
    pairs_.push_back({test.body, test.other, moves_otherwise(source, test.other, test.body),
                      test.is_proved_somewhere});
    free_cells_.push_back(test.free_cells);
    pair_cells_.push_back(compiled_cells(test.free_cells.get()));
    source_tests_.push_back(static_cast<std::int32_t>(numbered.test));
    paths.push_back(*numbered.path);
  }
  compile_paths(paths, pair_paths_);
}

template <class Real>
void CompiledPlan<Real>::compile_paths(const std::vector<PlanSource::Path>& paths,
                                       std::vector<PlanPathGroup>& groups) {
  for (std::size_t first = 0; first < paths.size(); first += kPlanLanes) {
    const std::size_t count = std::min<std::size_t>(kPlanLanes, paths.size() - first);
    std::size_t longest = 0;
    for (std::size_t i = 0; i < count; ++i) longest = std::max(longest, paths[first + i].size());
    longest_path_ = std::max(longest_path_, longest);
    groups.push_back(
        {static_cast<std::int32_t>(steps_.size()), static_cast<std::int32_t>(longest)});
    for (std::size_t k = 0; k < longest; ++k) {
      PlanPathStep<Real>& step = steps_.emplace_back();
      step = {};
      std::fill_n(step.position, kPlanLanes, plan_.position_count);
      for (std::size_t i = 0; i < count; ++i) {
        const PlanSource::Path& path = paths[first + i];
        if (k >= path.size()) continue;
        step.first[i] = rounded_up<Real>(path[k].first);
        step.second[i] = rounded_up<Real>(path[k].second);
        step.turns[i] = path[k].turns ? Real(1) : Real(0);
        step.slides[i] = path[k].turns ? Real(0) : Real(1);
        step.position[i] = path[k].position;
      }
    }
  }
}

template class CompiledPlan<float>;
template class CompiledPlan<double>;

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
