// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/course.h"

#include "bench/clock.h"
#include "collide/robot/robot_scene.h"

#include <algorithm>
#include <stdexcept>

namespace spherule {
namespace {

// The largest step of a joint between configurations that a planner looks at (MoveIt: 0.05), and
// that the truth is taken at, in radians.
constexpr double kUsualStep = 0.05;
constexpr double kFineStep = 0.002;

// Edges that a method sees one after another, and how often.
constexpr std::size_t kRun = 64;
constexpr int kRounds = 3;

RobotChecker snapshot_of(const Arm& arm, const AllowedCollisions& allowed,
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

bool meets(FclArm& fcl, const std::vector<Configuration>& all) {
  return std::any_of(all.begin(), all.end(),
                     [&](const Configuration& at) { return fcl.collides(at); });
}

}  // namespace

Course::Course(const Arm& arm, const AllowedCollisions& allowed, const PrimitiveScene& primitives)
    : checker_(snapshot_of(arm, allowed, primitives)),
      scratch_(checker_),
      obbrss_(arm, allowed, primitives, FclVolume::kObbRss),
      obb_(arm, allowed, primitives, FclVolume::kObb) {}

std::vector<Edge> Course::draw(std::size_t count, RandomNumbers& random) {
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

Counts Course::measure(std::span<const Edge> edges) {
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

}  // namespace spherule
