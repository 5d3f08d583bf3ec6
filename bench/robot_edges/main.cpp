// SPDX-License-Identifier: BSD-3-Clause

// Moves of a Panda in seven scenes of primitives, self-collision included: proved by RobotChecker,
// and sampled by FCL as planners do it. Prints what each misses, and the ratio of their times.
//   SPHERULE_MODELS=DIR spherule_robot_edges [EDGES [RADIUS]]

#include "bench/clock.h"
#include "bench/robot_edges/arm.h"
#include "bench/robot_edges/fcl_arm.h"
#include "bench/robot_edges/primitive_scenes.h"
#include "bench/studies/random_numbers.h"
#include "collide/robot/robot_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <span>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// The largest step of a joint between configurations that a planner looks at (MoveIt: 0.05), and
// that the truth is taken at, in radians.
constexpr double kUsualStep = 0.05;
constexpr double kFineStep = 0.002;

using Configuration = std::vector<double>;

struct Edge {
  Configuration from;
  Configuration to;
};

Configuration random_configuration(const RobotModel& robot, RandomNumbers& random) {
  Configuration result;
  for (const int joint : robot.variable_joints()) {
    const Joint& moved = robot.joints()[static_cast<std::size_t>(joint)];
    result.push_back(random.between(moved.lower, moved.upper));
  }
  return result;
}

// In the direction of another configuration, by up to 1.5 radians of the joint that turns most.
Edge random_edge(const RobotModel& robot, RandomNumbers& random) {
  Edge edge{random_configuration(robot, random), random_configuration(robot, random)};
  double largest = 0.0;
  for (std::size_t i = 0; i < edge.from.size(); ++i) {
    largest = std::max(largest, std::abs(edge.to[i] - edge.from[i]));
  }
  const double part = std::min(1.0, random.between(0.1, 1.5) / largest);
  for (std::size_t i = 0; i < edge.from.size(); ++i) {
    edge.to[i] = edge.from[i] + part * (edge.to[i] - edge.from[i]);
  }
  return edge;
}

bool meets_sampled(FclArm& fcl, const Edge& edge, double step) {
  double largest = 0.0;
  for (std::size_t i = 0; i < edge.from.size(); ++i) {
    largest = std::max(largest, std::abs(edge.to[i] - edge.from[i]));
  }
  const int steps = std::max(1, static_cast<int>(std::ceil(largest / step)));
  Configuration at(edge.from.size());
  for (int k = 0; k <= steps; ++k) {
    const double t = static_cast<double>(k) / steps;
    for (std::size_t i = 0; i < at.size(); ++i) {
      at[i] = (1.0 - t) * edge.from[i] + t * edge.to[i];
    }
    if (fcl.collides(at)) return true;
  }
  return false;
}

struct Counts {
  std::size_t edges = 0;
  std::size_t contact = 0;         // at fine steps
  std::size_t proved = 0;          // free
  std::size_t unknown = 0;         // neither proved nor a contact found
  std::size_t missed = 0;          // proved free, in contact at fine steps
  std::size_t extra = 0;           // not proved free, no contact at fine steps
  std::size_t sampled_missed = 0;  // no contact at usual steps, but at fine ones
  double proved_ns = 0.0;
  double sampled_ns = 0.0;

  void add(const Counts& other) {
    edges += other.edges;
    contact += other.contact;
    proved += other.proved;
    unknown += other.unknown;
    missed += other.missed;
    extra += other.extra;
    sampled_missed += other.sampled_missed;
    proved_ns += other.proved_ns;
    sampled_ns += other.sampled_ns;
  }
  void print(const char* name) const {
    const double count = static_cast<double>(edges);
    std::printf("%-8s %6zu %7zu %7zu %7zu %7zu %6zu %7zu %9.1f %9.1f %7.2f\n", name, edges, contact,
                proved, unknown, missed, extra, sampled_missed, 1e-3 * proved_ns / count,
                1e-3 * sampled_ns / count, sampled_ns / proved_ns);
  }
};

template <class Ask>
auto timed(double& total, Ask ask) {
  const auto start = Clock::now();
  const auto answer = ask();
  total += nanoseconds(Clock::now() - start);
  return answer;
}

// Edges whose ends are free to both.
Counts measure(const Arm& arm, const AllowedCollisions& allowed, const PrimitiveScene& primitives,
               std::size_t edges, RandomNumbers& random) {
  RobotScene scene(arm.model);
  scene.set_allowed_collisions(allowed);
  for (const PlacedPrimitive& obstacle : primitives.obstacles) {
    scene.add(obstacle.name, obstacle.primitive, obstacle.world_from_primitive);
    for (int link = 0; link < static_cast<int>(arm.model.links().size()); ++link) {
      if (link != 0 && allowed.reason(0, link) != AllowedReason::kRigid) continue;
      scene.allow_contact(arm.model.links()[static_cast<std::size_t>(link)].name, obstacle.name);
    }
  }
  const RobotChecker checker = scene.snapshot();
  RobotChecker::Scratch scratch(checker);
  FclArm fcl(arm, allowed, primitives);
  Counts counts;
  while (counts.edges < edges) {
    const Edge edge = random_edge(arm.model, random);
    if (!checker.check_config(edge.from, scratch) || !checker.check_config(edge.to, scratch)) {
      continue;
    }
    if (fcl.collides(edge.from) || fcl.collides(edge.to)) {
      std::printf("%s: FCL finds a contact that was missed\n", primitives.name.c_str());
      std::exit(1);
    }
    ++counts.edges;
    const EdgeResult result = timed(counts.proved_ns, [&] {
      return checker.check_edge(edge.from, edge.to, scratch, {.resolution = 1e-3});
    });
    const bool sampled =
        timed(counts.sampled_ns, [&] { return meets_sampled(fcl, edge, kUsualStep); });
    const bool meets = sampled || meets_sampled(fcl, edge, kFineStep);
    const bool is_free = result.verdict == Verdict::kFree;
    counts.contact += meets ? 1 : 0;
    counts.proved += is_free ? 1 : 0;
    counts.unknown += result.verdict == Verdict::kUnknown ? 1 : 0;
    counts.missed += is_free && meets ? 1 : 0;
    counts.extra += !is_free && !meets ? 1 : 0;
    counts.sampled_missed += meets && !sampled ? 1 : 0;
  }
  return counts;
}

// One configuration, of the arm against itself alone.
void measure_itself(const Arm& arm, const AllowedCollisions& allowed, RandomNumbers& random) {
  RobotScene scene(arm.model);
  scene.set_allowed_collisions(allowed);
  const RobotChecker checker = scene.snapshot();
  RobotChecker::Scratch scratch(checker);
  FclArm fcl(arm, allowed, {});
  std::vector<Configuration> all(5000);
  for (Configuration& one : all) one = random_configuration(arm.model, random);
  double ours = 0.0;
  double theirs = 0.0;
  const auto hits = [&](auto collides) { return std::count_if(all.begin(), all.end(), collides); };
  const auto found = timed(ours, [&] {
    return hits([&](const Configuration& q) { return !checker.check_config(q, scratch); });
  });
  const auto met =
      timed(theirs, [&] { return hits([&](const Configuration& q) { return fcl.collides(q); }); });
  const double count = static_cast<double>(all.size());
  std::printf("against itself: %.2f us a configuration (%td of %zu collide), FCL %.2f us (%td)\n\n",
              1e-3 * ours / count, found, all.size(), 1e-3 * theirs / count, met);
}

void run(const char* models, std::size_t edges, double radius) {
  const Arm arm = make_panda(models, radius);
  AllowedCollisions allowed(arm.model);
  allow_sampled(sample_collisions(arm.model, allowed, {.configurations = 2000}), allowed);
  std::printf("%zu triangles, %zu spheres of up to %.0f mm\n", arm.triangles, arm.spheres,
              1e3 * radius);
  RandomNumbers random(7);
  measure_itself(arm, allowed, random);
  std::printf("%-8s %6s %7s %7s %7s %7s %6s %7s %9s %9s %7s\n", "scene", "edges", "contact",
              "proved", "unknown", "missed", "extra", "sampled", "proved", "sampled", "times");
  std::printf("%-8s %6s %7s %7s %7s %7s %6s %7s %9s %9s %7s\n", "", "", "", "free", "", "", "",
              "missed", "us", "us", "faster");
  const std::vector<PrimitiveScene> scenes = primitive_scenes();
  Counts all;
  for (const PrimitiveScene& scene : scenes) {
    const Counts counts = measure(arm, allowed, scene, edges / scenes.size(), random);
    counts.print(scene.name.c_str());
    all.add(counts);
  }
  all.print("all");
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
  const double radius = argc > 2 ? std::atof(argv[2]) : 0.02;
  if (!(edges >= 7.0 && edges <= 1e9 && radius > 0.0)) {
    std::fprintf(stderr, "usage: spherule_robot_edges [EDGES [RADIUS]]\n");
    return 2;
  }
  try {
    spherule::run(models, static_cast<std::size_t>(edges), radius);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
