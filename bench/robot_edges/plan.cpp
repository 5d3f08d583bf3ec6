// SPDX-License-Identifier: BSD-3-Clause

// Motions of a Panda planned in the scenes of spherule_robot_edges, by OMPL's RRTConnect: with
// motions that RobotChecker proves, that it samples, and that FCL samples on the meshes. Every path
// is examined again by FCL. Prints how many are solved, how fast, and how many paths are in
// contact.
//   SPHERULE_MODELS=DIR spherule_arm_planning [PROBLEMS [STEP [RADIUS | SPHERIZED.urdf]]]

#include "base/error.h"
#include "bench/robot_edges/arm.h"
#include "bench/robot_edges/peer_arms.h"
#include "bench/robot_edges/planning.h"
#include "tests/support/program.h"

#include <cstdio>
#include <ompl/util/Console.h>
#include <span>
#include <string>
#include <vector>

namespace spherule {
namespace {

constexpr double kRecheckStep = 0.002;  // radians

std::vector<ProblemRow> study_scene(const Arm& arm, const AllowedCollisions& allowed,
                                    const ArmScene& scene, std::size_t problems,
                                    const PlanOptions& options) {
  const RobotChecker checker = robot_scene(arm, allowed, scene).snapshot();
  FclArm judge(arm, allowed, scene, FclVolume::kObbRss);
  FclArm fastest(arm, allowed, scene, FclVolume::kObb);
  RandomNumbers random(13);
  return study_problems(
      {checker, [&](std::span<const double> at) { return fastest.collides(at); }},
      [&](std::span<const double> at) { return judge.collides(at); },
      make_arm_problems(checker, judge, problems, random), options, kRecheckStep);
}

void print_head(const PlanOptions& options) {
  std::printf(
      "RRTConnect; motions sampled every %g rad (length of the vector of joint positions), paths "
      "examined again every %g rad\n"
      "proved / sampled / by FCL; times as long as the proved ones: of problems that both solve, "
      "median and sums\n"
      "| scene | problems | solved | paths in contact | median ms | sampled, times | FCL, times "
      "|\n|---|---|---|---|---|---|---|\n",
      options.step, kRecheckStep);
}

void print_row(const char* name, const std::vector<ProblemRow>& rows) {
  const ProblemRow& proved = rows[0];
  const ProblemRow& sampled = rows[1];
  const ProblemRow& meshes = rows[2];
  const TimeRatios of_sampled = compare(proved, sampled);
  const TimeRatios of_meshes = compare(proved, meshes);
  std::printf(
      "| %-7s | %4zu | %zu / %zu / %zu | %zu / %zu / %zu | %.2f / %.2f / %.2f | %.1f %.1f | %.1f "
      "%.1f |\n",
      name, proved.plans.size(), proved.solved, sampled.solved, meshes.solved, proved.in_contact,
      sampled.in_contact, meshes.in_contact, proved.median_milliseconds(),
      sampled.median_milliseconds(), meshes.median_milliseconds(), of_sampled.median,
      of_sampled.of_sums, of_meshes.median, of_meshes.of_sums);
  std::fflush(stdout);
}

void study(const Arm& arm, std::size_t problems, const PlanOptions& options) {
  const AllowedCollisions allowed = allowed_contacts(arm);
  std::vector<ArmScene> scenes = primitive_scenes();
  for (ArmScene& scene : larger_scenes()) scenes.push_back(std::move(scene));
  std::printf("%zu triangles, %zu spheres\n", arm.triangles, arm.spheres);
  print_head(options);
  std::vector<ProblemRow> all;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    // The remainder goes to the first ones.
    const std::size_t count = problems / scenes.size() + (i < problems % scenes.size() ? 1 : 0);
    const auto rows = study_scene(arm, allowed, scenes[i], count, options);
    print_row(scenes[i].name.c_str(), rows);
    append(all, rows);
  }
  print_row("all", all);
  if (all.front().in_contact > 0) {
    throw Error("planning", "a path that was proved free is in contact");
  }
}

int run(int argc, char** argv) {
  if (argc > 4) throw Error("usage", "[PROBLEMS [STEP [RADIUS | SPHERIZED.urdf]]]");
  const std::filesystem::path models = needed_models_folder();
  const std::int64_t problems = argc > 1 ? count_argument("PROBLEMS", argv[1], 1, 1'000'000) : 200;
  PlanOptions options;
  if (argc > 2) options.step = number_argument("STEP", argv[2], 1e-6, 10.0);
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  study(make_panda(models, argc > 3 ? argv[3] : "0.01"), static_cast<std::size_t>(problems),
        options);
  return 0;
}

}  // namespace
}  // namespace spherule

int main(int argc, char** argv) {
  return spherule::run_program("spherule_arm_planning", [&] { return spherule::run(argc, argv); });
}
