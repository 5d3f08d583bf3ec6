// SPDX-License-Identifier: BSD-3-Clause

// Moves of a Panda in seven scenes of primitives, self-collision included: proved by RobotChecker,
// and sampled as planners do it, by FCL on the meshes and by RobotChecker. Prints what each misses,
// and the ratios of their times.
//   SPHERULE_MODELS=DIR spherule_robot_edges [EDGES [RADIUS | SPHERIZED.urdf]]

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
#include <filesystem>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
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

// The numbers from 1 to `steps`, the last one first and then halves of what is left, as planners
// take them (OMPL's DiscreteMotionValidator), so as to meet a contact early.
std::vector<int> spread_out(int steps) {
  std::vector<int> order = {steps};
  std::vector<std::pair<int, int>> ranges = {{1, steps - 1}};
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const auto [first, last] = ranges[i];
    if (first > last) continue;
    const int middle = (first + last) / 2;
    order.push_back(middle);
    ranges.emplace_back(first, middle - 1);
    ranges.emplace_back(middle + 1, last);
  }
  return order;
}

// All but the start, which is known to be free, in this order.
std::vector<Configuration> samples(const Edge& edge, double step) {
  double largest = 0.0;
  for (std::size_t i = 0; i < edge.from.size(); ++i) {
    largest = std::max(largest, std::abs(edge.to[i] - edge.from[i]));
  }
  const int steps = std::max(1, static_cast<int>(std::ceil(largest / step)));
  std::vector<Configuration> result;
  for (const int k : spread_out(steps)) {
    const double t = static_cast<double>(k) / steps;
    Configuration& at = result.emplace_back(edge.from.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
      at[i] = (1.0 - t) * edge.from[i] + t * edge.to[i];
    }
  }
  return result;
}

// How long every edge took, in nanoseconds: the least of several times.
class Times {
 public:
  void add(double ns) { each_.push_back(ns); }
  void take(std::size_t edge, double ns) {
    if (edge == each_.size()) each_.push_back(ns);
    each_[edge] = std::min(each_[edge], ns);
  }
  void add(const Times& other) {
    each_.insert(each_.end(), other.each_.begin(), other.each_.end());
  }
  double total() const { return std::accumulate(each_.begin(), each_.end(), 0.0); }
  double mean_us() const { return 1e-3 * total() / static_cast<double>(each_.size()); }
  double median_us() const { return 1e-3 * median_of(each_); }
  // How many times as long they took as others, for the same edges: in all, and the median.
  double over(const Times& others) const { return total() / others.total(); }
  double median_over(const Times& others) const {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < each_.size(); ++i) ratios.push_back(each_[i] / others.each_[i]);
    return median_of(std::move(ratios));
  }

 private:
  static double median_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return quantile(values, 0.5);
  }

  std::vector<double> each_;
};

// What was found at usual steps.
struct Met {
  bool spheres = false;
  bool meshes = false;  // by FCL
};

struct Counts {
  std::size_t edges = 0;
  std::size_t contact = 0;     // at fine steps
  std::size_t proved = 0;      // free
  std::size_t collision = 0;   // of the spheres
  std::size_t unknown = 0;     // neither
  std::size_t missed = 0;      // proved free, in contact at fine steps
  std::size_t extra = 0;       // not proved free, no contact at fine steps
  std::size_t fcl_missed = 0;  // no contact at usual steps, but at fine ones
  std::size_t own_missed = 0;  // spheres that meet, but not at usual steps
  std::size_t looks = 0;       // configurations that the proofs looked at
  Times proof, own, obbrss, obb;

  void judge(const EdgeResult& result, const Met& sampled, bool in_contact) {
    const bool is_free = result.verdict == Verdict::kFree;
    const bool collides = result.verdict == Verdict::kCollision;
    ++edges;
    contact += in_contact ? 1 : 0;
    proved += is_free ? 1 : 0;
    collision += collides ? 1 : 0;
    unknown += is_free || collides ? 0 : 1;
    missed += is_free && in_contact ? 1 : 0;
    extra += !is_free && !in_contact ? 1 : 0;
    fcl_missed += in_contact && !sampled.meshes ? 1 : 0;
    own_missed += collides && !sampled.spheres ? 1 : 0;
    looks += result.configurations;
  }
  void add(const Counts& other) {
    edges += other.edges;
    contact += other.contact;
    proved += other.proved;
    collision += other.collision;
    unknown += other.unknown;
    missed += other.missed;
    extra += other.extra;
    fcl_missed += other.fcl_missed;
    own_missed += other.own_missed;
    looks += other.looks;
    proof.add(other.proof);
    own.add(other.own);
    obbrss.add(other.obbrss);
    obb.add(other.obb);
  }
  void print_verdicts(const char* name) const {
    std::printf("| %-7s | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu | %5zu |\n", name,
                edges, contact, proved, collision, unknown, missed, extra, fcl_missed, own_missed);
  }
  void print_times(const char* name) const {
    std::printf(
        "| %-7s | %4.1f | %6.2f %6.2f | %6.1f %6.1f | %6.1f %6.1f | %6.1f %6.1f | %5.1f %5.1f | "
        "%5.1f %5.1f | %5.1f %5.1f |\n",
        name, static_cast<double>(looks) / static_cast<double>(edges), proof.mean_us(),
        proof.median_us(), own.mean_us(), own.median_us(), obbrss.mean_us(), obbrss.median_us(),
        obb.mean_us(), obb.median_us(), own.over(proof), own.median_over(proof), obbrss.over(proof),
        obbrss.median_over(proof), obb.over(proof), obb.median_over(proof));
  }
};

// What is asked of one scene.
class Course {
 public:
  Course(const Arm& arm, const AllowedCollisions& allowed, const PrimitiveScene& primitives)
      : checker_(snapshot_of(arm, allowed, primitives)),
        scratch_(checker_),
        obbrss_(arm, allowed, primitives, FclVolume::kObbRss),
        obb_(arm, allowed, primitives, FclVolume::kObb) {}

  // Whose ends are free to both.
  std::vector<Edge> draw(std::size_t count, RandomNumbers& random) {
    std::vector<Edge> edges;
    while (edges.size() < count) {
      const Edge edge = random_edge(checker_.robot(), random);
      if (!is_free(edge.from) || !is_free(edge.to)) continue;
      if (obb_.collides(edge.from) || obb_.collides(edge.to)) {
        throw std::logic_error("FCL finds a contact that was missed");
      }
      edges.push_back(edge);
    }
    return edges;
  }

  // The methods take turns at runs of edges; each sees an edge as often as there are rounds.
  Counts measure(std::span<const Edge> edges) {
    Counts counts;
    for (std::size_t first = 0; first < edges.size(); first += kRun) {
      const std::size_t last = std::min(edges.size(), first + kRun);
      std::vector<std::vector<Configuration>> usual;
      for (std::size_t i = first; i < last; ++i) usual.push_back(samples(edges[i], kUsualStep));
      std::vector<EdgeResult> results(last - first);
      std::vector<Met> met(last - first);
      const auto time_all = [&](Times& times, auto ask) {
        for (std::size_t i = first; i < last; ++i) {
          const auto start = Clock::now();
          ask(i - first);
          times.take(i, nanoseconds(Clock::now() - start));
        }
      };
      for (int round = 0; round < kRounds; ++round) {
        time_all(counts.proof, [&](std::size_t i) {
          const Edge& edge = edges[first + i];
          results[i] = checker_.check_edge(edge.from, edge.to, scratch_, {.resolution = 1e-3});
        });
        time_all(counts.own, [&](std::size_t i) {
          met[i].spheres = !std::all_of(usual[i].begin(), usual[i].end(),
                                        [&](const Configuration& at) { return is_free(at); });
        });
        time_all(counts.obbrss, [&](std::size_t i) { met[i].meshes = meets(obbrss_, usual[i]); });
        time_all(counts.obb, [&](std::size_t i) { meets(obb_, usual[i]); });
      }
      for (std::size_t i = first; i < last; ++i) {
        const Met& sampled = met[i - first];
        const bool in_contact = sampled.meshes || meets(obb_, samples(edges[i], kFineStep));
        counts.judge(results[i - first], sampled, in_contact);
      }
    }
    return counts;
  }

 private:
  static constexpr std::size_t kRun = 64;
  static constexpr int kRounds = 3;

  static RobotChecker snapshot_of(const Arm& arm, const AllowedCollisions& allowed,
                                  const PrimitiveScene& primitives) {
    RobotScene scene(arm.model);
    scene.set_allowed_collisions(allowed);
    for (const PlacedPrimitive& obstacle : primitives.obstacles) {
      scene.add(obstacle.name, obstacle.primitive, obstacle.world_from_primitive);
      for (int link = 0; link < static_cast<int>(arm.model.links().size()); ++link) {
        if (link != 0 && allowed.reason(0, link) != AllowedReason::kRigid) continue;
        scene.allow_contact(arm.model.links()[static_cast<std::size_t>(link)].name, obstacle.name);
      }
    }
    return scene.snapshot();
  }

  bool is_free(const Configuration& at) { return checker_.check_config(at, scratch_); }
  static bool meets(FclArm& fcl, const std::vector<Configuration>& all) {
    return std::any_of(all.begin(), all.end(),
                       [&](const Configuration& at) { return fcl.collides(at); });
  }

  RobotChecker checker_;
  RobotChecker::Scratch scratch_;
  FclArm obbrss_;
  FclArm obb_;
};

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
