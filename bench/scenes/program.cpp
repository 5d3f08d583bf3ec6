// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenes/program.h"

#include "base/error.h"
#include "bench/scenes/inverse_kinematics.h"
#include "bench/scenes/table.h"
#include "bench/scenes/weld_pass.h"

#include <algorithm>
#include <random>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector3d;

constexpr double kTableDistance = 1.55;
constexpr double kWorkpieceYaw = 0.2;  // radians

constexpr ArmPositions kHome{0.0, -0.15, 0.1, 0.0, 1.1, 0.0};
// Behind the fixture post, and a clear way round to it.
constexpr ArmPositions kStation{0.52, 0.32, 0.18, 0.0, 0.6, 0.0};
constexpr ArmPositions kAboveStation{0.52, -0.2, -0.2, 0.0, 0.9, 0.0};

// Configurations of one pass: home to above the seam, down, weld, up, home.
constexpr std::size_t kTransfer = 55;
constexpr std::size_t kDescent = 30;
constexpr std::size_t kWeld = 770;
constexpr double kClearHeight = 0.06;  // metres above the seam where a descent starts
// Every so many passes the torch visits the station.
constexpr std::size_t kPassesBetweenVisits = 3;

// The orientation that points z along the wire and puts the torch's body towards the robot.
Pose world_from_wire(const WireTarget& target, const Pose& world_from_piece) {
  const Vector3d position = world_from_piece * target.position;
  const Vector3d z = world_from_piece.matrix() * target.direction;
  const Vector3d to_robot(-position.x(), -position.y(), 0.0);
  const Vector3d x = (to_robot - to_robot.dot(z) * z).normalized();
  Eigen::Matrix3d turn;
  turn << x, z.cross(x), z;
  return Pose(Eigen::Quaterniond(turn), position);
}

class ProgramWriter {
 public:
  explicit ProgramWriter(const Pose& flange_from_wire)
      : robot_(make_robot()), wire_from_flange_(flange_from_wire.inverse()) {
    add(on_joint_grid(kHome));
  }

  ArmPositions solve(const WireTarget& target, const ArmPositions& start) const {
    const auto solution = solve_inverse_kinematics(
        robot_, world_from_wire(target, world_from_workpiece()) * wire_from_flange_, start);
    if (!solution) throw Error("program", "a target is out of the robot's reach");
    return *solution;
  }

  // Straight in joint space, `steps` configurations with the end, without the start.
  void move_to(const ArmPositions& end, std::size_t steps) {
    const ArmPositions start = last();
    for (std::size_t i = 1; i <= steps; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(steps);
      ArmPositions between;
      for (std::size_t j = 0; j < between.size(); ++j) {
        between[j] = start[j] + share * (end[j] - start[j]);
      }
      add(on_joint_grid(between));
    }
  }

  void follow(const WireTarget& target, bool is_critical = false) {
    add(solve(target, last()), is_critical);
  }

  std::size_t size() const { return program_.configurations.size(); }
  Program take() { return std::move(program_); }

 private:
  const ArmPositions& last() const { return program_.configurations.back(); }
  void add(const ArmPositions& configuration, bool is_critical = false) {
    program_.configurations.push_back(configuration);
    program_.is_critical.push_back(is_critical ? 1 : 0);
  }

  RobotModel robot_;
  Pose wire_from_flange_;
  Program program_;
};

// Along the wire between the seam's first or last target and the clear height above it.
WireTarget backed_off(WireTarget target, double share) {
  target.position -= share * kClearHeight * target.direction;
  return target;
}

void weld(ProgramWriter& writer, const std::vector<WireTarget>& targets) {
  writer.move_to(writer.solve(backed_off(targets.front(), 1.0), kHome), kTransfer);
  for (std::size_t i = kDescent; i > 0; --i) {
    writer.follow(backed_off(targets.front(), static_cast<double>(i) / kDescent));
  }
  for (const WireTarget& target : targets) writer.follow(target, true);
  for (std::size_t i = 1; i <= kDescent; ++i) {
    writer.follow(backed_off(targets.back(), static_cast<double>(i) / kDescent));
  }
}

}  // namespace

Pose world_from_table() {
  return Pose::from_translation({kTableDistance, 0.0, 0.0});
}

Pose world_from_workpiece() {
  return Pose(Eigen::Quaterniond(Eigen::AngleAxisd(kWorkpieceYaw, Vector3d::UnitZ())),
              {kTableDistance, 0.0, kTableHeight + kWorkpieceHeight});
}

Program make_program(const Pose& flange_from_wire) {
  ProgramWriter writer(flange_from_wire);
  const auto passes = make_weld_passes(kWeld);
  for (std::size_t pass = 0; pass < passes.size(); ++pass) {
    weld(writer, passes[pass]);
    if (pass % kPassesBetweenVisits == 0) {
      writer.move_to(kStation, kTransfer);
      writer.move_to(kAboveStation, kTransfer / 2);
    }
    writer.move_to(kHome, kTransfer);
  }
  // The robot waits nowhere: what is left of the program's length is a slow last move.
  if (writer.size() > kProgramSize) throw Error("program", "longer than planned");
  writer.move_to(kAboveStation, kProgramSize - writer.size());
  return writer.take();
}

std::vector<ArmPositions> shuffled(std::vector<ArmPositions> program, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  // Fisher and Yates; the standard library's shuffle differs between implementations.
  for (std::size_t left = program.size(); left > 1; --left) {
    std::swap(program[left - 1], program[engine() % left]);
  }
  return program;
}

}  // namespace spherule
