// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/plan_source.h"

#include "collide/kernels/plan_trees.h"
#include "collide/kernels/tree_kernel.h"
#include "collide/meshes/solid_mesh.h"
#include "robot/model/kinematics.h"
#include "robot/model/link_paths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

namespace spherule::internal {
namespace {

static_assert(kLargestJointPosition == kLargestPosition);

struct ShapeOf {
  SearchTreeCache& cache;

  PlanSource::Shape operator()(const std::shared_ptr<const SphereTree>& tree) const {
    return cache.of(tree);
  }
  PlanSource::Shape operator()(const std::shared_ptr<const SolidMesh>& mesh) const {
    return cache.of(mesh);
  }
  PlanSource::Shape operator()(const Primitive& primitive) const { return primitive; }
};

PlanSource::Path steps_of(const PathReach& reach, const RobotModel& robot,
                          const MovingFrames& frames) {
  PlanSource::Path path;
  for (const PathReach::Step& step : reach.steps()) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(step.joint)];
    path.push_back({frames.frame_of_link[static_cast<std::size_t>(joint.child_link)], step.turns,
                    step.first, step.second});
  }
  return path;
}

// Of a pair of bodies, by what is proved of it or else by its spheres; `margin` as FreeCellsSource
// has it.
class CellsSource {
 public:
  CellsSource(const RobotModel& robot, const MovingFrames& frames, const PlanSource& source)
      : robot_(robot), source_(source), joints_(source.frames.size()) {
    for (const Joint& joint : robot.joints()) {
      if (!joint.moves()) continue;
      const auto link = static_cast<std::size_t>(joint.child_link);
      joints_[static_cast<std::size_t>(frames.frame_of_link[link])] = &joint;
    }
    for (const int joint : robot.variable_joints()) {
      const auto link =
          static_cast<std::size_t>(robot.joints()[static_cast<std::size_t>(joint)].child_link);
      frame_of_variable_.push_back(frames.frame_of_link[link]);
    }
    // Both bodies, at both ends of what a motion is compared with (compiled_plan.cpp). A power of
    // two, so that cells serve scenes of almost any size.
    margin_ = std::max(kLeastMargin, std::exp2(std::ceil(std::log2(8.0 * source.pose_error))));
  }

  std::shared_ptr<const FreeCells> of(const CheckedPair& pair) {
    if (pair.boxes == nullptr) {
      if (++searched_ > kMostSearched) return nullptr;
      const FreeCellsSource source = source_of(pair.piece, pair.other);
      if (!has_ranges(source.first) || !has_ranges(source.second)) return nullptr;
      return robot_.check_cache().free_cells.of(source);
    }
    std::vector<int> positions;
    for (const FreeBoxes::Variable& variable : pair.boxes->variables()) {
      positions.push_back(frame_of_variable_[static_cast<std::size_t>(variable.index)]);
    }
    return box_cells(*pair.boxes, positions);
  }

 private:
  FreeCellsSource source_of(int first, int second) const {
    FreeCellsSource result{side(first), side(second), margin_};
    auto& [a, b, margin] = result;
    while (!a.chain.empty() && !b.chain.empty() &&
           a.chain.front().position == b.chain.front().position) {
      a.chain.erase(a.chain.begin());
      b.chain.erase(b.chain.begin());
    }
    return result;
  }

  // Cells part the ranges of the joints, which those without limits have not.
  static bool has_ranges(const FreeCellsSource::Side& side) {
    return std::all_of(side.chain.begin(), side.chain.end(),
                       [](const auto& joint) { return std::isfinite(joint.upper); });
  }

  FreeCellsSource::Side side(int body) const {
    const PlanSource::Body& from = source_.bodies[static_cast<std::size_t>(body)];
    FreeCellsSource::Side result{{}, from.trees, from.frame_from_trees};
    for (int frame = from.frame; frame >= 0;) {
      const auto index = static_cast<std::size_t>(frame);
      const Joint& joint = *joints_[index];
      result.chain.push_back({source_.frames[index].parent_from_frame, joint.turns(), frame,
                              joint.lower, joint.upper});
      frame = source_.frames[index].parent;
    }
    std::reverse(result.chain.begin(), result.chain.end());
    return result;
  }

  static constexpr double kLeastMargin = 0x1p-33;
  // Each search takes longer than a test of the pair, and is compared with all that are kept.
  static constexpr int kMostSearched = 1024;

  const RobotModel& robot_;
  const PlanSource& source_;
  std::vector<const Joint*> joints_;    // that moves each frame
  std::vector<int> frame_of_variable_;  // whose position it is
  double margin_ = 0.0;
  int searched_ = 0;  // pairs whose cells were searched for
};

}  // namespace

RobotPlanSource make_plan_source(const BodyPairs& pairs) {
  const MovingFrames frames(pairs.robot());
  SearchTreeCache& cache = pairs.robot().check_cache().search_trees;
  RobotPlanSource result;
  PlanSource& source = result.source;
  source.frames = frames.frames;
  source.pose_error = pairs.pose_error();
  for (const CheckedPiece& piece : pairs.pieces()) {
    const auto link = static_cast<std::size_t>(piece.link);
    source.bodies.push_back({frames.frame_of_link[link], cache.of(piece.tree),
                             frames.frame_from_link[link], piece.mesh != nullptr});
  }
  const Pose root_from_world = pairs.world_from_root().inverse();
  for (const PlacedShape& obstacle : pairs.obstacles()) {
    const Pose root_from_shape = root_from_world * obstacle.world_from_shape;
    const bool is_confirmed =
        obstacle.mesh != nullptr ||
        std::holds_alternative<std::shared_ptr<const SolidMesh>>(obstacle.shape);
    source.obstacles.push_back(
        {std::visit(ShapeOf{cache}, obstacle.shape), root_from_shape, is_confirmed});
  }
  for (std::size_t i = 0; i < source.bodies.size(); ++i) {
    source.body_paths.push_back(steps_of(pairs.path_to_root(i), pairs.robot(), frames));
  }
  CellsSource cells(pairs.robot(), frames, source);
  for (std::size_t i = 0; i < pairs.pairs().size(); ++i) {
    if (i == pairs.static_tree_pairs_begin()) result.first_static_tree = source.tests.size();
    const CheckedPair& pair = pairs.pairs()[i];
    PlanSource::Path path = steps_of(pairs.path(i), pairs.robot(), frames);
    if (path.empty()) {
      result.fixed_pairs.push_back(i);
      continue;
    }
    source.tests.push_back({pair.piece, pair.other, pair.is_obstacle});
    result.pair_of_test.push_back(i);
    if (pair.is_obstacle) continue;
    PlanSource::Test& test = source.tests.back();
    test.is_proved_somewhere = pair.boxes != nullptr;
    test.never_touches = pair.boxes != nullptr && pair.boxes->is_all_free();
    // What never touches is hardly ever tested.
    if (!test.never_touches) test.free_cells = cells.of(pair);
    source.pair_paths.push_back(std::move(path));
  }
  if (pairs.static_tree_pairs_begin() == pairs.pairs().size()) {
    result.first_static_tree = source.tests.size();
  }
  return result;
}

}  // namespace spherule::internal

// The kernels compute the coordinate of a position with an error below 1e-13 of a cell, of which
// none is wider than 200 / 64. What a leaf that is not proved takes of a cell without its being
// noted, at most half of kNegligible at either end of either interval, lies within
// FreeBoxes::kTolerance of a leaf beside it in this cell that is free: one that is not takes the
// cell, because each takes one at least.

namespace spherule::internal {
namespace {

constexpr double kNegligible = 1e-13;
// Cells of narrower ranges are not worth having.
constexpr double kNarrowest = 1e-6;
constexpr int kCells = FreeCells::kCells;
static_assert(1e-13 * (2.0 * FreeBoxes::kLargestPosition / kCells) + kNegligible <
              FreeBoxes::kTolerance);

// The cells that an interval takes more of than is negligible, from the first to the one behind the
// last; that of its middle at least.
std::array<int, 2> cells_taken(const FreeCells::Axis& axis, double lower, double upper) {
  const auto coordinate = [&](double value) {
    return std::clamp((value - axis.lower) * axis.scale, 0.0, static_cast<double>(kCells));
  };
  const int middle =
      std::min(static_cast<int>(std::floor(coordinate(0.5 * lower + 0.5 * upper))), kCells - 1);
  const int first = static_cast<int>(std::floor(coordinate(lower + 0.5 * kNegligible)));
  const int end = static_cast<int>(std::ceil(coordinate(upper - 0.5 * kNegligible)));
  return {std::min(first, middle), std::max(end, middle + 1)};
}

}  // namespace

std::shared_ptr<const FreeCells> box_cells(const FreeBoxes& boxes, std::span<const int> positions) {
  const std::vector<FreeBoxes::Variable>& variables = boxes.variables();
  if (variables.empty() || variables.size() > FreeCells::kMostJoints) return nullptr;
  std::array<FreeCells::Axis, FreeCells::kMostJoints> axes{};
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const double width = variables[i].upper - variables[i].lower;
    if (!(width > kNarrowest)) return nullptr;
    axes[i] = {positions[i], variables[i].lower, kCells / width};
  }
  if (variables.size() == 1) axes[1] = {positions[0], 0.0, 0.0};
  std::array<std::uint64_t, kCells> words{};
  std::fill_n(words.begin(), variables.size() == 1 ? 1 : kCells, ~std::uint64_t{0});
  boxes.for_each_leaf([&](bool is_free, std::span<const double> lower,
                          std::span<const double> upper) {
    if (is_free) return;
    const auto [first, end] = cells_taken(axes[0], lower[0], upper[0]);
    const std::uint64_t bits = ~std::uint64_t{0} >> (kCells - (end - first)) << first;
    const auto [row, last_row] =
        variables.size() == 1 ? std::array<int, 2>{0, 1} : cells_taken(axes[1], lower[1], upper[1]);
    for (int j = row; j < last_row; ++j) words[static_cast<std::size_t>(j)] &= ~bits;
  });
  const bool has_any =
      std::any_of(words.begin(), words.end(), [](std::uint64_t word) { return word != 0; });
  return has_any ? std::make_shared<const FreeCells>(axes, words) : nullptr;
}

}  // namespace spherule::internal
