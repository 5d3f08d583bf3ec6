// SPDX-License-Identifier: BSD-3-Clause
#include "bench/checkers/workload.h"

#include "bench/scenes/work_cell.h"
#include "robot/model/kinematics.h"
#include "tests/support/fcl_solid.h"

#include <algorithm>
#include <utility>

namespace spherule {
namespace {

// E and D in metres. The torch's are tighter than the robot's: its nozzle works millimetres off the
// metal, and D is what passes between the wire and the nozzle's rim.
constexpr double kRobotError = 0.020;
constexpr double kTorchError = 0.003;
constexpr double kWorkpieceError = 0.001;
constexpr double kTableError = 0.020;
constexpr double kExternal = 0.100;
constexpr double kTorchExternal = 0.012;

TriangleMesh moved(TriangleMesh mesh, const Pose& pose) {
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = pose * vertex;
  return mesh;
}

template <class Count>
std::size_t sum(const Workload& workload, const Count& count) {
  std::size_t result = 0;
  for (const Body& body : workload.bodies) result += count(body.part);
  for (const Obstacle& obstacle : workload.obstacles) result += count(obstacle.part);
  return result;
}

}  // namespace

std::size_t triangle_count(const Workload& workload) {
  return sum(workload, [](const Part& part) { return part.mesh.triangles.size(); });
}

std::size_t sphere_count(const Workload& workload) {
  return sum(workload, [](const Part& part) { return part.tree->spheres().size(); });
}

bool is_tested(const Body& body, const Obstacle& obstacle) {
  return body.link != 0 || obstacle.part.name != "table";
}

Workload make_cell(std::string name, std::span<const TriangleMesh> links, const TriangleMesh& torch,
                   const Pose& flange_from_wire) {
  Workload cell{.name = std::move(name), .robot = make_robot()};
  const int last = static_cast<int>(links.size()) - 1;
  cell.bodies.push_back({{.name = "torch",
                          .mesh = moved(torch, link6_from_flange()),
                          .max_error = kTorchError,
                          .min_external_diameter = kTorchExternal},
                         last});
  for (int link = last; link >= 0; --link) {
    const auto index = static_cast<std::size_t>(link);
    cell.bodies.push_back({{.name = cell.robot.links()[index].name,
                            .mesh = links[index],
                            .max_error = kRobotError,
                            .min_external_diameter = kExternal},
                           link});
  }
  cell.obstacles.push_back({{.name = "workpiece",
                             .mesh = make_workpiece(),
                             .max_error = kWorkpieceError,
                             .min_external_diameter = kExternal},
                            world_from_workpiece()});
  cell.obstacles.push_back({{.name = "table",
                             .mesh = make_table(),
                             .max_error = kTableError,
                             .min_external_diameter = kExternal},
                            world_from_table()});
  Program program = make_program(flange_from_wire);
  cell.program = std::move(program.configurations);
  cell.is_critical = std::move(program.is_critical);
  return cell;
}

Workload make_paper_cell() {
  return make_cell("paper-cell", make_robot_links(), make_torch(), flange_from_wire());
}

void SingleChecker::check(std::span<const ArmPositions> configurations,
                          std::span<std::uint8_t> verdicts) {
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    forward_kinematics(robot_, configurations[i], world_from_link_);
    verdicts[i] = collides(world_from_link_) ? 1 : 0;
  }
}

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
