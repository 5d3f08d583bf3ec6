// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/process_study.h"

#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/oracle.h"
#include "bench/planning/processor_time.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

namespace spherule {
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
