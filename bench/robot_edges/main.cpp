// SPDX-License-Identifier: BSD-3-Clause

// Moves of a Panda in seven scenes of primitives, self-collision included: proved by RobotChecker,
// and sampled as planners do it, by FCL on the meshes and by RobotChecker. Prints what each misses,
// and the ratios of their times.
//   SPHERULE_MODELS=DIR spherule_robot_edges [EDGES [RADIUS | SPHERIZED.urdf]]

#include "bench/clock.h"
#include "bench/robot_edges/arm.h"
#include "bench/robot_edges/counts.h"
#include "bench/robot_edges/course.h"
#include "bench/robot_edges/edges.h"
#include "bench/robot_edges/fcl_arm.h"
#include "bench/robot_edges/primitive_scenes.h"
#include "bench/robot_edges/times.h"
#include "bench/studies/random_numbers.h"
#include "collide/robot/robot_scene.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

namespace spherule {
namespace {

// One configuration, of the arm against itself alone.
void measure_itself(const Arm& arm, const AllowedCollisions& allowed, RandomNumbers& random) {
  RobotScene scene(arm.model);
  scene.set_allowed_collisions(allowed);
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

void run(const Arm& arm, std::size_t edges) {
  AllowedCollisions allowed(arm.model);
  // How far the hand is closed is not the arm's affair.
  allowed.allow("panda_leftfinger", "panda_rightfinger");
  allow_sampled(sample_collisions(arm.model, allowed, {.configurations = 2000}), allowed);
  std::printf("%zu triangles, %zu spheres\n", arm.triangles, arm.spheres);
  RandomNumbers random(7);
  measure_itself(arm, allowed, random);
  const std::vector<PrimitiveScene> scenes = primitive_scenes();
  std::vector<Counts> each;
  Counts all;
  for (const PrimitiveScene& scene : scenes) {
    Course course(arm, allowed, scene);
    each.push_back(course.measure(course.draw(edges / scenes.size(), random)));
    all.add(each.back());
  }
  std::printf(
      "| scene | edges | in contact | proved free | collision | unknown | missed | extra | "
      "FCL missed | own missed |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < each.size(); ++i) each[i].print_verdicts(scenes[i].name.c_str());
  all.print_verdicts("all");
  std::printf(
      "\nus an edge, mean and median; times as long as the proof, in all and median\n"
      "| scene   | looks | proof | own sampled | FCL OBBRSS | FCL OBB | own / proof | "
      "OBBRSS / proof | OBB / proof |\n|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < each.size(); ++i) each[i].print_times(scenes[i].name.c_str());
  all.print_times("all");
}

}  // namespace
}  // namespace spherule

int main(int argc, char** argv) {
  const char* const models = std::getenv("SPHERULE_MODELS");
  if (models == nullptr || *models == '\0') {
    std::fprintf(stderr, "SPHERULE_MODELS does not name a folder of models\n");
    return 2;
  }
  const double edges = argc > 1 ? std::atof(argv[1]) : 10000.0;
  const std::string spheres = argc > 2 ? argv[2] : "0.02";
  const double radius = std::atof(spheres.c_str());
  if (!(edges >= 7.0 && edges <= 1e9)) {
    std::fprintf(stderr, "usage: spherule_robot_edges [EDGES [RADIUS | SPHERIZED.urdf]]\n");
    return 2;
  }
  try {
    using namespace spherule;
    const Arm arm = radius > 0.0 ? make_panda(models, radius)
                                 : make_panda(models, std::filesystem::path(spheres));
    run(arm, static_cast<std::size_t>(edges));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
