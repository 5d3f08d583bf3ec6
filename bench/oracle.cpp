// SPDX-License-Identifier: BSD-3-Clause
#include "bench/oracle.h"

#include "bench/fcl_models.h"
#include "collide/robot/kinematics.h"

#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace spherule {
namespace {

using Model = FclModel<fcl::OBBRSSd>;

struct Solid {
  explicit Solid(const TriangleMesh& m) : mesh(m), model(m), points(component_points(m)) {}

  bool contains(const Eigen::Vector3d& point) const {
    return model.box.contains(point) && std::abs(winding_number(mesh, point)) > 0.5;
  }

  TriangleMesh mesh;
  Model model;
  std::vector<Eigen::Vector3d> points;
};

bool contains_a_point(const Solid& outer, const Pose& world_from_outer, const Solid& inner,
                      const Pose& world_from_inner) {
  const Pose outer_from_inner = world_from_outer.inverse() * world_from_inner;
  return std::any_of(inner.points.begin(), inner.points.end(), [&](const Eigen::Vector3d& point) {
    return outer.contains(outer_from_inner * point);
  });
}

bool touch(const Solid& a, const Pose& world_from_a, const Solid& b, const Pose& world_from_b) {
  const auto pose_a = fcl_pose<double>(world_from_a);
  const auto pose_b = fcl_pose<double>(world_from_b);
  if (!a.model.world_box(pose_a).intersects(b.model.world_box(pose_b))) return false;
  fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  return fcl::collide(a.model.geometry.get(), pose_a, b.model.geometry.get(), pose_b, request,
                      result) > 0 ||
         contains_a_point(a, world_from_a, b, world_from_b) ||
         contains_a_point(b, world_from_b, a, world_from_a);
}

}  // namespace

struct Oracle::Impl {
  RobotModel robot;
  std::vector<std::pair<Solid, Pose>> obstacles;
  struct Moving {
    Solid solid;
    std::size_t link;
    std::vector<std::size_t> against;
  };
  std::vector<Moving> bodies;
};

Oracle::Oracle(const Workload& workload) {
  auto impl = std::make_unique<Impl>();
  impl->robot = workload.robot;
  for (const Obstacle& obstacle : workload.obstacles) {
    impl->obstacles.emplace_back(Solid(obstacle.part.mesh), obstacle.world_from_part);
  }
  for (const Body& body : workload.bodies) {
    impl->bodies.push_back({Solid(body.part.mesh), static_cast<std::size_t>(body.link), {}});
    for (std::size_t i = 0; i < workload.obstacles.size(); ++i) {
      if (is_tested(body, workload.obstacles[i])) impl->bodies.back().against.push_back(i);
    }
  }
  impl_ = std::move(impl);
}

Oracle::~Oracle() = default;

std::vector<std::uint32_t> Oracle::touching_bodies(
    std::span<const JointPositions> configurations) const {
  std::vector<std::uint32_t> result;
  std::vector<Pose> world_from_link;
  for (const JointPositions& configuration : configurations) {
    forward_kinematics(impl_->robot, configuration, world_from_link);
    std::uint32_t bits = 0;
    for (std::size_t body = 0; body < impl_->bodies.size(); ++body) {
      const Impl::Moving& moving = impl_->bodies[body];
      const bool hit =
          std::any_of(moving.against.begin(), moving.against.end(), [&](std::size_t i) {
            const auto& [solid, pose] = impl_->obstacles[i];
            return touch(moving.solid, world_from_link[moving.link], solid, pose);
          });
      bits |= hit ? 1U << body : 0U;
    }
    result.push_back(bits);
  }
  return result;
}

}  // namespace spherule
