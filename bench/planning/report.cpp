// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/report.h"

#include "base/files.h"

#include <nlohmann/json.hpp>

#include <cstdio>

namespace spherule {
namespace {

using Json = nlohmann::ordered_json;

struct Totals {
  double seconds = 0.0;
  std::size_t state_checks = 0;
  std::size_t motion_checks = 0;
};

Totals totals_of(const ProblemRow& row) {
  Totals totals;
  for (const Plan& plan : row.plans) {
    totals.seconds += plan.seconds;
    totals.state_checks += plan.state_checks;
    totals.motion_checks += plan.motion_checks;
  }
  return totals;
}

Json to_json(const ProblemRow& row, const ProblemRow& meshes) {
  const Totals totals = totals_of(row);
  Json json{{"name", name_of(row.validity)},
            {"solved", row.ended(PlanEnd::kSolved)},
            {"ends_refused", row.ended(PlanEnd::kEndsRefused)},
            {"out_of_iterations", row.ended(PlanEnd::kIterations)},
            {"out_of_seconds", row.ended(PlanEnd::kSeconds)},
            {"median_ms", median_milliseconds(row)},
            {"seconds", totals.seconds},
            {"state_checks", totals.state_checks},
            {"motion_checks", totals.motion_checks},
            {"paths_in_contact", row.paths_in_contact()},
            {"configurations_tested", row.tested}};
  const ProblemComparison with = compare(row, meshes);
  json["with_fcl"] = {{"both_solve", with.both},
                      {"only_fcl", with.mesh_only},
                      {"only_fcl_ends_refused", with.refused},
                      {"only_this", with.sphere_only},
                      {"median_ratio", with.median_ratio},
                      {"total_ratio", with.total_ratio}};
  return json;
}

Json to_json(const ProblemStudy& study) {
  Json json{{"problems", study.rows.back().plans.size()},
            {"step_rad", study.options.step},
            {"most_iterations", study.options.most_iterations},
            {"most_seconds", study.options.most_seconds},
            {"first_seed", study.options.seed},
            {"recheck_step_rad", study.recheck_step}};
  for (const ProblemRow& row : study.rows) json["rows"].push_back(to_json(row, study.rows.back()));
  return json;
}

Json to_json(const ProcessStudy& study) {
  Json json{{"points", study.points},
            {"angles", study.angles},
            {"postures", study.postures},
            {"configurations", study.configurations},
            {"free_configurations", study.free_configurations},
            {"free_points", study.free_points}};
  for (const ProcessRow& row : study.rows) {
    json["rows"].push_back({{"name", row.engine},
                            {"checks_a_second", row.checks_a_second},
                            {"collisions", row.count.collisions},
                            {"missed", row.count.missed},
                            {"extra", row.count.extra},
                            {"free_points", row.free_points},
                            {"lost_points", row.lost_points}});
  }
  return json;
}

}  // namespace

void print_table(const ProblemStudy& study) {
  std::printf(
      "\n%zu problems, RRTConnect; steps of sampled motions %g rad, of the second check %g\n",
      study.rows.back().plans.size(), study.options.step, study.recheck_step);
  std::printf("%-18s %6s %7s %6s %6s %9s %8s %10s %8s %9s\n", "states and motions", "solved",
              "refused", "iter.", "time", "median ms", "total s", "states", "motions", "contacts");
  for (const ProblemRow& row : study.rows) {
    const Totals totals = totals_of(row);
    std::printf("%-18s %6zu %7zu %6zu %6zu %9.3f %8.2f %10zu %8zu %9zu\n",
                name_of(row.validity).c_str(), row.ended(PlanEnd::kSolved),
                row.ended(PlanEnd::kEndsRefused), row.ended(PlanEnd::kIterations),
                row.ended(PlanEnd::kSeconds), median_milliseconds(row), totals.seconds,
                totals.state_checks, totals.motion_checks, row.paths_in_contact());
  }
  for (std::size_t i = 0; i + 1 < study.rows.size(); ++i) {
    const ProblemComparison with = compare(study.rows[i], study.rows.back());
    std::printf(
        "%s: %.1f times as fast as FCL (median of %zu problems that both solve; %.1f of the sums); "
        "FCL alone solves %zu, of which an end is refused in %zu; it alone %zu\n",
        name_of(study.rows[i].validity).c_str(), with.median_ratio, with.both, with.total_ratio,
        with.mesh_only, with.refused, with.sphere_only);
  }
}

void print_table(const ProcessStudy& study) {
  std::printf(
      "\n%zu process points, %zu turns of the torch, %zu postures, %zu of them within the limits; "
      "free: %zu, of %zu points\n",
      study.points, study.angles, study.postures, study.configurations, study.free_configurations,
      study.free_points);
  std::printf("%-28s %12s %7s %7s %12s %6s\n", "engine", "checks/s", "missed", "extra",
              "free points", "lost");
  for (const ProcessRow& row : study.rows) {
    std::printf("%-28s %12.0f %7zu %7zu %12zu %6zu\n", row.engine.c_str(), row.checks_a_second,
                row.count.missed, row.count.extra, row.free_points, row.lost_points);
  }
}

void write_result(const PlanningResult& result, const std::filesystem::path& folder) {
  Json json{{"name", result.name}};
  for (const FitRecord& fit : result.fits) {
    json["parts"].push_back({{"name", fit.part},
                             {"triangles", fit.triangles},
                             {"spheres", fit.spheres},
                             {"seconds", fit.seconds}});
  }
  json["problems"] = to_json(result.problems);
  json["process_points"] = to_json(result.process);
  write_file_atomically(folder / "planning.json", json.dump(1) + "\n");
}

}  // namespace spherule
