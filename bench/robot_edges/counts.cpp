// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/arm.h"
#include "bench/robot_edges/arm_scenes.h"
#include "bench/robot_edges/course.h"
#include "bench/studies/measure.h"
#include "bench/studies/refined_cover.h"

#include <algorithm>
#include <cstdio>
#include <vector>

namespace spherule {

void Counts::judge(const EdgeResult& result, const EdgeResult& of_meshes, const Met& sampled,
                   bool in_contact) {
  const bool is_free = result.verdict == Verdict::kFree;
  const bool collides = result.verdict == Verdict::kCollision;
  ++edges;
  contact += in_contact ? 1 : 0;
  proved += is_free ? 1 : 0;
  collision += collides ? 1 : 0;
  unknown += is_free || collides ? 0 : 1;
  missed += is_free && in_contact ? 1 : 0;
  extra += !is_free && !in_contact ? 1 : 0;
  own_missed += collides && !sampled.spheres ? 1 : 0;
  evaluations += result.configurations;
  for (std::size_t i = 0; i < peers.size(); ++i) {
    const bool met = sampled.peers[i] != 0;
    peers[i].missed += in_contact && !met ? 1 : 0;
    peers[i].extra += !in_contact && met ? 1 : 0;
  }
  const bool is_confirmed_free = of_meshes.verdict == Verdict::kFree;
  confirmed_proved += is_confirmed_free ? 1 : 0;
  confirmed_unknown += of_meshes.verdict == Verdict::kUnknown ? 1 : 0;
  confirmed_missed += is_confirmed_free && in_contact ? 1 : 0;
  confirmed_extra += !is_confirmed_free && !in_contact ? 1 : 0;
}

void Counts::add(const Counts& other) {
  edges += other.edges;
  contact += other.contact;
  proved += other.proved;
  collision += other.collision;
  unknown += other.unknown;
  missed += other.missed;
  extra += other.extra;
  own_missed += other.own_missed;
  evaluations += other.evaluations;
  confirmed_proved += other.confirmed_proved;
  confirmed_unknown += other.confirmed_unknown;
  confirmed_missed += other.confirmed_missed;
  confirmed_extra += other.confirmed_extra;
  proof.add(other.proof);
  confirmed.add(other.confirmed);
  own.add(other.own);
  for (const PeerCounts& peer : other.peers) {
    const auto same = [&](const PeerCounts& mine) { return mine.name == peer.name; };
    auto mine = std::find_if(peers.begin(), peers.end(), same);
    if (mine == peers.end()) mine = peers.insert(mine, PeerCounts{.name = peer.name});
    mine->missed += peer.missed;
    mine->extra += peer.extra;
    mine->times.add(peer.times);
  }
}

void Counts::print_verdicts_head() const {
  std::printf(
      "| scene | edges | in contact | proved free | collision | unknown | missed | extra | "
      "confirmed: proved | unknown | missed | extra | own missed |");
  for (const PeerCounts& peer : peers) std::printf(" %s missed / extra |", peer.name.c_str());
  std::printf("\n|---|---|---|---|---|---|---|---|---|---|---|---|---|");
  for (std::size_t i = 0; i < peers.size(); ++i) std::printf("---|");
  std::printf("\n");
}

void Counts::print_verdicts(const char* name) const {
  std::printf("| %-7s |", name);
  for (const std::size_t count :
       {edges, contact, proved, collision, unknown, missed, extra, confirmed_proved,
        confirmed_unknown, confirmed_missed, confirmed_extra, own_missed}) {
    std::printf(" %5zu |", count);
  }
  for (const PeerCounts& peer : peers) std::printf(" %zu / %zu |", peer.missed, peer.extra);
  std::printf("\n");
}

void Counts::print_times_head() const {
  std::printf(
      "\nproof: us an edge, mean and median; times as long as that, in all and median\n"
      "| scene   | evaluations | proof | confirmed | own sampled |");
  for (const PeerCounts& peer : peers) std::printf(" %s |", peer.name.c_str());
  std::printf("\n|---|---|---|---|---|");
  for (std::size_t i = 0; i < peers.size(); ++i) std::printf("---|");
  std::printf("\n");
}

void Counts::print_times(const char* name) const {
  std::printf("| %-7s | %4.1f | %6.2f %6.2f |", name,
              static_cast<double>(evaluations) / static_cast<double>(edges), proof.mean_us(),
              proof.median_us());
  const auto print = [&](const Times& times) {
    std::printf(" %5.1f %5.1f |", times.over(proof), times.median_over(proof));
  };
  print(confirmed);
  print(own);
  for (const PeerCounts& peer : peers) print(peer.times);
  std::printf("\n");
}

namespace {

constexpr std::size_t kEdges = 2000;
constexpr std::size_t kSteps = 16;  // of an edge, as a path
constexpr int kRounds = 9;

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
    costs.push_back({median(path[i]), median(anywhere[i]), median(edges[i])});
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
