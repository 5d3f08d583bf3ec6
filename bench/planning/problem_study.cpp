// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/problem_study.h"

#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/planning/problems.h"
#include "bench/studies/measure.h"

#include <algorithm>
#include <cmath>

namespace spherule {
namespace {

// The clock of the processor ticks in microseconds.
constexpr double kTick = 1e-6;

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : quantile(values, 0.5);
}

}  // namespace

std::size_t ProblemRow::ended(PlanEnd end) const {
  return static_cast<std::size_t>(std::count_if(
      plans.begin(), plans.end(), [end](const Plan& plan) { return plan.end == end; }));
}

std::size_t ProblemRow::paths_in_contact() const {
  return static_cast<std::size_t>(
      std::count_if(contacts.begin(), contacts.end(), [](std::size_t n) { return n > 0; }));
}

void ProblemStudy::add(const ProblemStudy& other) {
  if (rows.empty()) {
    *this = other;
    return;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ProblemRow& more = other.rows[i];
    rows[i].plans.insert(rows[i].plans.end(), more.plans.begin(), more.plans.end());
    rows[i].contacts.insert(rows[i].contacts.end(), more.contacts.begin(), more.contacts.end());
    rows[i].tested += more.tested;
  }
}

ProblemStudy study_problems(const Workload& workload, const RobotChecker& checker,
                            const std::vector<PlanningProblem>& problems,
                            const PlanOptions& options, double recheck_step) {
  const auto meshes = make_fcl_mesh_checker(
      workload, {FclMeshSetting::Volume::kObb, FclMeshSetting::Precision::kFloat});
  const auto judge = make_fcl_mesh_checker(workload, {});
  return study_problems({checker, contact_test(*meshes)}, contact_test(*judge), problems, options,
                        recheck_step);
}

ProblemStudy study_problems(const PlanningEngines& engines, const ContactTest& judge,
                            const std::vector<PlanningProblem>& problems,
                            const PlanOptions& options, double recheck_step) {
  ProblemStudy study{.options = options, .recheck_step = recheck_step};
  study.rows = {{Validity::kProved}, {Validity::kSampled}, {Validity::kMeshes}};
  for (std::size_t i = 0; i < problems.size(); ++i) {
    for (ProblemRow& row : study.rows) {
      PlanOptions one = options;
      one.seed += static_cast<std::uint32_t>(i);
      row.plans.push_back(plan(engines, row.validity, problems[i], one));
      const PathCheck found = check_path(row.plans.back().path, judge, recheck_step);
      row.contacts.push_back(found.contacts);
      row.tested += found.configurations;
    }
  }
  return study;
}

ProblemComparison compare(const ProblemRow& row, const ProblemRow& meshes) {
  ProblemComparison result;
  std::vector<double> ratios;
  double ours = 0.0;
  double theirs = 0.0;
  for (std::size_t i = 0; i < row.plans.size(); ++i) {
    const Plan& plan = row.plans[i];
    const Plan& mesh = meshes.plans[i];
    if (plan.is_solved() && mesh.is_solved()) {
      ratios.push_back(mesh.seconds / std::max(plan.seconds, kTick));
      ours += plan.seconds;
      theirs += mesh.seconds;
    } else if (mesh.is_solved()) {
      ++result.mesh_only;
      result.refused += plan.end == PlanEnd::kEndsRefused ? 1 : 0;
    } else if (plan.is_solved()) {
      ++result.sphere_only;
    }
  }
  result.both = ratios.size();
  result.median_ratio = median(ratios);
  result.total_ratio = theirs / std::max(ours, kTick);
  return result;
}

double median_milliseconds(const ProblemRow& row) {
  std::vector<double> times;
  for (const Plan& plan : row.plans) {
    if (plan.is_solved()) times.push_back(1e3 * plan.seconds);
  }
  return median(std::move(times));
}

PathCheck check_path(const std::vector<Configuration>& path, const ContactTest& in_contact,
                     double step) {
  PathCheck result;
  const auto test = [&](const Configuration& at) {
    ++result.configurations;
    result.contacts += in_contact(at) ? 1 : 0;
  };
  if (!path.empty()) test(path.front());
  Configuration at;
  for (std::size_t i = 1; i < path.size(); ++i) {
    double most = 0.0;
    for (std::size_t k = 0; k < path[i].size(); ++k) {
      most = std::max(most, std::abs(path[i][k] - path[i - 1][k]));
    }
    const auto steps = std::max(1, static_cast<int>(std::ceil(most / step)));
    at.resize(path[i].size());
    for (int s = 1; s <= steps; ++s) {
      const double t = static_cast<double>(s) / steps;
      for (std::size_t k = 0; k < at.size(); ++k) {
        at[k] = (1.0 - t) * path[i - 1][k] + t * path[i][k];
      }
      test(at);
    }
  }
  return result;
}

}  // namespace spherule
