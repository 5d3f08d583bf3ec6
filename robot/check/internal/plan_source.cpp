// SPDX-License-Identifier: BSD-3-Clause
#include "robot/check/internal/plan_source.h"

#include "collide/kernels/check_cache.h"
#include "collide/solid_mesh.h"
#include "robot/check/internal/box_cells.h"
#include "robot/model/internal/moving_frames.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>
#include <vector>

namespace spherule::internal {
namespace {

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
      return robot_.check_cache().free_cells.of(source_of(pair.piece, pair.other));
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

RobotPlanSource make_plan_source(const BodyPairs& pairs, std::size_t count) {
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
  for (std::size_t i = 0; i < count; ++i) {
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
  return result;
}

}  // namespace spherule::internal
