// SPDX-License-Identifier: BSD-3-Clause
#include "bench/oracle.h"

#include "robot/model/kinematics.h"
#include "tests/support/fcl_solid.h"

#include <algorithm>
#include <utility>

namespace spherule {

struct Oracle::Impl {
  RobotModel robot;
  std::vector<std::pair<FclSolid, Pose>> obstacles;
  struct Moving {
    FclSolid solid;
    std::size_t link;
    std::vector<std::size_t> against;
  };
  std::vector<Moving> bodies;
};

Oracle::Oracle(const Workload& workload) {
  auto impl = std::make_unique<Impl>();
  impl->robot = workload.robot;
  for (const Obstacle& obstacle : workload.obstacles) {
    impl->obstacles.emplace_back(FclSolid(obstacle.part.mesh), obstacle.world_from_part);
  }
  for (const Body& body : workload.bodies) {
    impl->bodies.push_back({FclSolid(body.part.mesh), static_cast<std::size_t>(body.link), {}});
    for (std::size_t i = 0; i < workload.obstacles.size(); ++i) {
      if (is_tested(body, workload.obstacles[i])) impl->bodies.back().against.push_back(i);
    }
  }
  impl_ = std::move(impl);
}

Oracle::~Oracle() = default;

std::vector<std::uint32_t> Oracle::touching_bodies(
    std::span<const ArmPositions> configurations) const {
  std::vector<std::uint32_t> result;
  std::vector<Pose> world_from_link;
  for (const ArmPositions& configuration : configurations) {
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
