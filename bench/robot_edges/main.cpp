// SPDX-License-Identifier: BSD-3-Clause

// Moves and configurations of a Panda in seven scenes of primitives and among fifty, in a cloud of
// points and about a solid mesh, self-collision included: moves proved by RobotChecker, with its
// spheres and confirmed on the meshes, and sampled as planners do it, by FCL on the meshes, by
// Bullet on their hulls and triangles, and by RobotChecker. Prints what each misses, and the ratios
// of their times; and what self-collision and more spheres cost.
//   SPHERULE_MODELS=DIR spherule_robot_edges [EDGES [RADIUS | SPHERIZED.urdf]...]

#include "bench/robot_edges/arm.h"
#include "bench/robot_edges/course.h"
#include "bench/robot_edges/peer_arms.h"
#include "bench/studies/measure.h"
#include "bench/studies/refined_cover.h"
#include "robot/check/robot_scene.h"
#include "tests/support/program.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace spherule {
namespace {

// One configuration, of the arm against itself alone.
void measure_itself(const Arm& arm, const AllowedCollisions& allowed, RandomNumbers& random) {
  RobotScene scene(arm.model);
  scene.set_allowed_collisions(allowed);
  scene.set_link_pairs(arm.pairs);
  const RobotChecker checker = scene.snapshot();
  RobotChecker::Scratch scratch(checker);
  FclArm fcl(arm, allowed, {}, FclVolume::kObbRss);
  Times ours;
  Times theirs;
  int found = 0;
  int met = 0;
  for (int i = 0; i < 5000; ++i) {
    const Configuration at = random_configuration(arm.model, random);
    const auto start = Clock::now();
    found += checker.check_config(at, scratch) ? 0 : 1;
    const auto between = Clock::now();
    met += fcl.collides(at) ? 1 : 0;
    ours.add(nanoseconds(between - start));
    theirs.add(nanoseconds(Clock::now() - between));
  }
  std::printf("against itself: %.2f us a configuration (%d of 5000 collide), FCL %.2f us (%d)\n\n",
              ours.mean_us(), found, theirs.mean_us(), met);
}

void measure_edges(const Arm& arm, const AllowedCollisions& allowed,
                   const std::vector<ArmScene>& scenes, std::size_t edges, RandomNumbers& random) {
  std::vector<Counts> each;
  Counts all;
  for (const ArmScene& scene : scenes) {
    Course course(arm, allowed, scene);
    each.push_back(course.measure(course.draw(edges / scenes.size(), random)));
    all.add(each.back());
  }
  all.print_verdicts_head();
  for (std::size_t i = 0; i < each.size(); ++i) each[i].print_verdicts(scenes[i].name.c_str());
  all.print_verdicts("all");
  all.print_times_head();
  for (std::size_t i = 0; i < each.size(); ++i) each[i].print_times(scenes[i].name.c_str());
  all.print_times("all");
}

void measure_configurations(const Arm& arm, const AllowedCollisions& allowed,
                            const std::vector<ArmScene>& scenes, RandomNumbers& random) {
  for (const ArmScene& scene : scenes) {
    Course course(arm, allowed, scene);
    for (const bool is_path : {true, false}) {
      const ConfigurationTimes times = course.measure_configurations(2000, is_path, random);
      if (&scene == &scenes.front() && is_path) times.print_head();
      times.print((scene.name + (is_path ? ", path" : ", random")).c_str());
    }
  }
}

void measure(std::span<const Arm> arms, std::size_t edges) {
  const Arm& arm = arms.front();
  const AllowedCollisions allowed = allowed_contacts(arm);
  std::printf("%zu triangles, %zu spheres\n", arm.triangles, arm.spheres);
  RandomNumbers random(7);
  measure_itself(arm, allowed, random);
  measure_edges(arm, allowed, primitive_scenes(), edges, random);
  const std::vector<ArmScene> larger = larger_scenes();
  std::printf("\n");
  measure_edges(arm, allowed, larger, edges / 10, random);
  std::vector<ArmScene> scenes = primitive_scenes();
  scenes.insert(scenes.end(), larger.begin(), larger.end());
  measure_configurations(arm, allowed, scenes, random);
  measure_self_share(arm, allowed);
  if (arms.size() > 1) measure_sizes(arms, allowed);
}

int run(int argc, char** argv) {
  const std::filesystem::path models = needed_models_folder();
  const std::int64_t edges =
      argc > 1 ? count_argument("EDGES", argv[1], 30, 1'000'000'000) : 10'000;
  std::vector<std::string> covers(argv + std::min(argc, 2), argv + argc);
  if (covers.empty()) covers = {"0.02"};
  std::vector<Arm> arms;
  for (const std::string& cover : covers) arms.push_back(make_panda(models, cover));
  measure(arms, static_cast<std::size_t>(edges));
  return 0;
}

}  // namespace
}  // namespace spherule

int main(int argc, char** argv) {
  return spherule::run_program("spherule_robot_edges", [&] { return spherule::run(argc, argv); });
}
