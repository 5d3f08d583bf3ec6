// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/process_study.h"

#include "base/error.h"
#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/checkers/workload.h"
#include "bench/planning/planner.h"
#include "bench/scenes/program.h"
#include "robot/model/kinematics.h"
#include "tests/support/turn_between.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

namespace spherule {
namespace {

using Eigen::Vector3d;

constexpr double kMostError = 1e-5;  // metres, and an entry of the rotation matrix
constexpr std::size_t kSeams = 3;

// The wire's end at a point of a seam, the wire between the seam's normal and the vertical, as in
// the weld program.
Pose world_from_wire(const SeamPoint& seam, double angle) {
  const Vector3d normal = (seam.normal_a + seam.normal_b).normalized();
  const Vector3d away = (normal + 2.0 * Vector3d::UnitZ()).normalized();
  const Eigen::Quaterniond turn = turn_between(Vector3d::UnitZ(), -away) *
                                  Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
  return world_from_workpiece() * Pose(turn, seam.point + standoff(seam) * normal);
}

void require_reached(const RobotModel& robot, const ArmPositions& positions,
                     const Pose& flange_from_wire, const Pose& target,
                     std::vector<Pose>& world_from_link) {
  forward_kinematics(robot, positions, world_from_link);
  const Pose wire = world_from_link.back() * link6_from_flange() * flange_from_wire;
  if ((wire.translation() - target.translation()).norm() > kMostError ||
      (wire.matrix() - target.matrix()).cwiseAbs().maxCoeff() > kMostError) {
    throw Error("process points", "a posture does not reach its place");
  }
}

}  // namespace

ProcessPoints make_process_points(const RobotModel& robot, const Pose& flange_from_wire,
                                  std::size_t points, std::size_t angles) {
  ProcessPoints result{.points = points, .angles = angles};
  const Pose wire_from_flange = flange_from_wire.inverse();
  std::vector<Pose> world_from_link;
  for (std::size_t i = 0; i < points; ++i) {
    const std::size_t pipe = i * kSeams / points;
    const double along = static_cast<double>(i * kSeams % points) / static_cast<double>(points);
    const SeamPoint seam =
        seam_point(static_cast<int>(pipe),
                   kLowestSeamAngle + (0.5 * std::numbers::pi - kLowestSeamAngle) * along);
    for (std::size_t k = 0; k < angles; ++k) {
      const Pose target = world_from_wire(
          seam, 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(angles));
      for (const ArmPositions& exact :
           inverse_kinematics_branches(robot, target * wire_from_flange)) {
        ++result.postures;
        const ArmPositions positions = on_joint_grid(exact);
        if (!is_within_limits(robot, positions)) continue;
        require_reached(robot, positions, flange_from_wire, target, world_from_link);
        result.configurations.push_back(positions);
        result.point_of.push_back(i);
      }
    }
  }
  return result;
}

namespace {

constexpr int kRuns = 3;

class SingleCalls : public Checker {
 public:
  explicit SingleCalls(const RobotChecker& checker) : checker_(checker), scratch_(checker) {}
  void check(std::span<const ArmPositions> configurations,
             std::span<std::uint8_t> verdicts) override {
    for (std::size_t i = 0; i < configurations.size(); ++i) {
      verdicts[i] = checker_.check_config(configurations[i], scratch_) ? 0 : 1;
    }
  }

 private:
  const RobotChecker& checker_;
  RobotChecker::Scratch scratch_;
};

class ManyACall : public Checker {
 public:
  explicit ManyACall(const RobotChecker& checker) : checker_(checker), scratch_(checker) {}
  void check(std::span<const ArmPositions> configurations,
             std::span<std::uint8_t> verdicts) override {
    if (configurations.empty()) return;
    checker_.check_configs({configurations.front().data(), configurations.size() * kJoints},
                           scratch_, verdicts);
    for (std::uint8_t& verdict : verdicts) verdict = verdict != 0 ? 0 : 1;
  }

 private:
  const RobotChecker& checker_;
  RobotChecker::Scratch scratch_;
};

// For each point, whether one of its postures is free.
std::vector<bool> points_with_a_free_posture(const ProcessPoints& points,
                                             const std::vector<std::uint8_t>& verdicts) {
  std::vector<bool> result(points.points, false);
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    if (verdicts[i] == 0) result[points.point_of[i]] = true;
  }
  return result;
}

std::size_t count_of(const std::vector<bool>& values) {
  return static_cast<std::size_t>(std::count(values.begin(), values.end(), true));
}

}  // namespace

ProcessStudy study_process_points(const Workload& workload, const RobotChecker& checker,
                                  const ProcessPoints& points) {
  ProcessStudy study{.points = points.points,
                     .angles = points.angles,
                     .postures = points.postures,
                     .configurations = points.configurations.size()};
  std::vector<std::uint8_t> truth;
  for (const std::uint32_t bits : Oracle(workload).touching_bodies(points.configurations)) {
    truth.push_back(bits != 0 ? 1 : 0);
  }
  study.free_configurations = static_cast<std::size_t>(std::count(truth.begin(), truth.end(), 0));
  const std::vector<bool> truly_free = points_with_a_free_posture(points, truth);
  study.free_points = count_of(truly_free);

  const auto add = [&](const std::string& name, Checker& engine) {
    std::vector<std::uint8_t> verdicts(points.configurations.size());
    double best = std::numeric_limits<double>::infinity();
    for (int run = 0; run < kRuns; ++run) {
      const double begin = processor_seconds();
      engine.check(points.configurations, verdicts);
      best = std::min(best, processor_seconds() - begin);
    }
    ProcessRow row{.engine = name,
                   .checks_a_second = static_cast<double>(verdicts.size()) / best,
                   .count = count(verdicts, truth)};
    const std::vector<bool> found_free = points_with_a_free_posture(points, verdicts);
    row.free_points = count_of(found_free);
    for (std::size_t i = 0; i < points.points; ++i) {
      row.lost_points += truly_free[i] && !found_free[i] ? 1 : 0;
    }
    study.rows.push_back(std::move(row));
  };
  SingleCalls single(checker);
  ManyACall batch(checker);
  add("spherule-single", single);
  add("spherule-batch", batch);
  using Setting = FclMeshSetting;
  for (const Setting& setting :
       {Setting{Setting::Volume::kObb, Setting::Precision::kFloat}, Setting{}}) {
    add("fcl-mesh " + to_string(setting), *make_fcl_mesh_checker(workload, setting));
  }
  return study;
}

}  // namespace spherule
