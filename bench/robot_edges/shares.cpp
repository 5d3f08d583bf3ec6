// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/shares.h"

#include "bench/clock.h"
#include "bench/robot_edges/arm_scenes.h"
#include "bench/robot_edges/edges.h"
#include "bench/robot_edges/robot_scenes.h"
#include "bench/studies/random_numbers.h"

#include <algorithm>
#include <cstdio>
#include <vector>

namespace spherule {
namespace {

constexpr std::size_t kEdges = 2000;
constexpr std::size_t kSteps = 16;  // of an edge, as a path
constexpr int kRounds = 9;

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return quantile(values, 0.5);
}

// The same questions for every checker: edges that all find free, configurations on them and
// anywhere.
struct Questions {
  std::vector<Edge> edges{};
  std::vector<Configuration> path{};
  std::vector<Configuration> anywhere{};
};

Questions draw_questions(const RobotModel& robot, std::span<const RobotChecker> checkers) {
  std::vector<RobotChecker::Scratch> scratches;
  for (const RobotChecker& checker : checkers) scratches.emplace_back(checker);
  RandomNumbers random(11);
  Questions questions;
  while (questions.edges.size() < kEdges) {
    const Edge edge = random_edge(robot, random);
    questions.anywhere.push_back(edge.from);
    bool is_free = true;
    for (std::size_t i = 0; i < checkers.size() && is_free; ++i) {
      is_free = checkers[i].check_edge(edge.from, edge.to, scratches[i]).verdict == Verdict::kFree;
    }
    if (!is_free) continue;
    questions.edges.push_back(edge);
    for (std::size_t k = 0; k < kSteps; ++k) {
      const double t = static_cast<double>(k) / kSteps;
      Configuration& at = questions.path.emplace_back(edge.from.size());
      for (std::size_t v = 0; v < at.size(); ++v) {
        at[v] = (1.0 - t) * edge.from[v] + t * edge.to[v];
      }
    }
  }
  return questions;
}

// Medians of ns a question.
struct Costs {
  double path, anywhere, edge;
};

std::vector<Costs> costs_of(std::span<const RobotChecker> checkers, const Questions& questions) {
  std::vector<RobotChecker::Scratch> scratches;
  for (const RobotChecker& checker : checkers) scratches.emplace_back(checker);
  std::vector<std::vector<double>> path(checkers.size()), anywhere(path), edges(path);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < checkers.size(); ++i) {
      const auto query = [&](std::vector<double>& times, const auto& all, auto one) {
        const auto start = Clock::now();
        for (const auto& question : all) one(question);
        times.push_back(nanoseconds(Clock::now() - start) / static_cast<double>(all.size()));
      };
      const auto check = [&](const Configuration& at) {
        return checkers[i].check_config(at, scratches[i]);
      };
      query(path[i], questions.path, check);
      query(anywhere[i], questions.anywhere, check);
      query(edges[i], questions.edges, [&](const Edge& edge) {
        return checkers[i].check_edge(edge.from, edge.to, scratches[i]);
      });
    }
  }
  std::vector<Costs> costs;
  for (std::size_t i = 0; i < checkers.size(); ++i) {
    costs.push_back({median_of(path[i]), median_of(anywhere[i]), median_of(edges[i])});
  }
  return costs;
}

}  // namespace

void measure_self_share(const Arm& arm, const AllowedCollisions& sampled) {
  const AllowedCollisions joined = joined_contacts(arm);
  AllowedCollisions all = joined;
  all.allow_all();
  const ArmScene among = scene_of_primitives(50);
  RobotScene by_spheres = robot_scene(arm, sampled, among);
  by_spheres.set_link_pairs(nullptr);
  const std::vector<RobotChecker> checkers = {robot_scene(arm, all, among).snapshot(),
                                              by_spheres.snapshot(),
                                              robot_scene(arm, joined, among).snapshot()};
  const std::vector<Costs> costs = costs_of(checkers, draw_questions(arm.model, checkers));
  const auto share = [](double with, double without) { return 100.0 * (1.0 - without / with); };
  std::printf(
      "\nself-collision among fifty primitives, per cent of a configuration on paths, of one "
      "anywhere, of a free edge\n"
      "| pairs | path | anywhere | edge | ns |\n|---|---|---|---|---|\n");
  constexpr const char* kNames[] = {"", "as a sample allows, by spheres",
                                    "all that are not joined, with proofs"};
  for (std::size_t i = 1; i < checkers.size(); ++i) {
    std::printf("| %s | %.0f | %.0f | %.0f | %.0f, %.0f, %.0f |\n", kNames[i],
                share(costs[i].path, costs[0].path), share(costs[i].anywhere, costs[0].anywhere),
                share(costs[i].edge, costs[0].edge), costs[i].path, costs[i].anywhere,
                costs[i].edge);
  }
}

void measure_sizes(std::span<const Arm> arms, const AllowedCollisions& allowed) {
  const ArmScene scene = primitive_scenes().front();
  std::vector<RobotChecker> checkers;
  for (const Arm& arm : arms) checkers.push_back(robot_scene(arm, allowed, scene).snapshot());
  const std::vector<Costs> costs = costs_of(checkers, draw_questions(arms.front().model, checkers));
  std::printf(
      "\nmore spheres, times the first: a configuration on paths, anywhere, a free edge\n"
      "| spheres | path | anywhere | edge |\n|---|---|---|---|\n");
  for (std::size_t i = 0; i < arms.size(); ++i) {
    std::printf("| %5zu | %4.2f | %4.2f | %4.2f |\n", arms[i].spheres,
                costs[i].path / costs[0].path, costs[i].anywhere / costs[0].anywhere,
                costs[i].edge / costs[0].edge);
  }
}

}  // namespace spherule
