// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/internal/plan_source.h"

#include "collide/robot/internal/moving_frames.h"
#include "collide/solid_mesh.h"

#include <memory>
#include <variant>

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

}  // namespace

RobotPlanSource make_plan_source(const BodyPairs& pairs, std::size_t count) {
  const MovingFrames frames(pairs.robot());
  SearchTreeCache& cache = pairs.robot().search_trees();
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
  for (std::size_t i = 0; i < count; ++i) {
    const CheckedPair& pair = pairs.pairs()[i];
    PlanSource::Path path = steps_of(pairs.path(i), pairs.robot(), frames);
    if (path.empty()) {
      result.fixed_pairs.push_back(i);
      continue;
    }
    source.tests.push_back({pair.piece, pair.other, pair.is_obstacle});
    result.pair_of_test.push_back(i);
    if (!pair.is_obstacle) source.pair_paths.push_back(std::move(path));
  }
  return result;
}

}  // namespace spherule::internal
