// SPDX-License-Identifier: BSD-3-Clause

// Moves and configurations of a Panda in seven scenes of primitives and among fifty, in a cloud of
// points and about a solid mesh, self-collision included: moves proved by RobotChecker, with its
// spheres and confirmed on the meshes, and sampled as planners do it, by FCL on the meshes, by
// Bullet on their hulls and triangles, and by RobotChecker. Prints what each misses, and the ratios
// of their times; and what self-collision and more spheres cost.
//   SPHERULE_MODELS=DIR spherule_robot_edges [EDGES [RADIUS | SPHERIZED.urdf]...]

#include "bench/robot_edges/arm.h"
#include "bench/robot_edges/peer_arms.h"
#include "bench/studies/measure.h"
#include "bench/studies/refined_cover.h"
#include "collide/sweep.h"
#include "robot/check/robot_checker.h"
#include "robot/check/robot_scene.h"
#include "robot/pairs/allowed_collisions.h"
#include "tests/support/program.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// How long every edge took, in nanoseconds: the least of several times.
class Times {
 public:
  void add(double ns) { each_.push_back(ns); }
  // Of an edge that is known, or the next one.
  void take(std::size_t edge, double ns);
  void add(const Times& other);

  double total() const;
  double mean_us() const;
  double median_us() const;
  // How many times as long they took as others, for the same edges: in all, and the median.
  double over(const Times& others) const { return total() / others.total(); }
  double median_over(const Times& others) const;

 private:
  std::vector<double> each_;
};

// What one method says of configurations, and how long each round took.
struct ConfigurationRow {
  std::vector<std::uint8_t> free;
  std::vector<double> rounds_ns{};

  void take(double ns) { rounds_ns.push_back(ns); }
  double median_ns() const;
};

struct ConfigurationTimes {
  explicit ConfigurationTimes(std::size_t count)
      : single{std::vector<std::uint8_t>(count)}, batch(single), confirmed(single), truth(count) {}

  // Of another library.
  struct Peer {
    std::string name;
    ConfigurationRow row;
  };

  ConfigurationRow single, batch, confirmed;
  std::vector<Peer> peers{};
  std::vector<std::uint8_t> truth;  // 1: free, by FCL and by points in solids

  // A row of the table: ns a configuration, times as long as single calls, and verdicts.
  void print(const char* name) const;
  void print_head() const;
};

// What was found at usual steps.
struct Met {
  bool spheres = false;
  std::vector<std::uint8_t> peers;  // by each of them: 1 or 0
};

// How another library's check at usual steps compares with fine ones of FCL.
struct PeerCounts {
  std::string name;
  std::size_t missed = 0;  // no contact at usual steps, but at fine ones
  std::size_t extra = 0;   // the reverse: what it checks is another geometry
  Times times{};
};

// What was said of edges, and how long it took.
struct Counts {
  std::size_t edges = 0;
  std::size_t contact = 0;    // at fine steps
  std::size_t proved = 0;     // free
  std::size_t collision = 0;  // of the spheres
  std::size_t unknown = 0;    // neither
  std::size_t missed = 0;     // proved free, in contact at fine steps
  std::size_t extra = 0;      // not proved free, no contact at fine steps
  // Of the proofs that are confirmed on the meshes.
  std::size_t confirmed_proved = 0;
  std::size_t confirmed_unknown = 0;
  std::size_t confirmed_missed = 0;
  std::size_t confirmed_extra = 0;
  std::size_t own_missed = 0;   // spheres that meet, but not at usual steps
  std::size_t evaluations = 0;  // configurations that the proofs examined
  Times proof, confirmed, own;
  std::vector<PeerCounts> peers{};

  // Of one more edge.
  void judge(const EdgeResult& result, const EdgeResult& of_meshes, const Met& sampled,
             bool in_contact);
  void add(const Counts& other);

  // A row of the table of verdicts, and of the one of times, and what stands above them.
  void print_verdicts_head() const;
  void print_times_head() const;
  void print_verdicts(const char* name) const;
  void print_times(const char* name) const;
};

// The queries in one scene.
class Course {
 public:
  // Keeps referring to both.
  Course(const Arm& arm, const AllowedCollisions& allowed, const ArmScene& scene);

  // Whose ends are free to both.
  std::vector<Edge> draw(std::size_t count, RandomNumbers& random);

  // The methods take turns at runs of edges; each sees an edge as often as there are rounds.
  Counts measure(std::span<const Edge> edges);

  // So many configurations, anywhere within the limits or on a path, by each method in turns.
  ConfigurationTimes measure_configurations(std::size_t count, bool is_path, RandomNumbers& random);

 private:
  bool is_free(const Configuration& at) { return checker_.check_config(at, scratch_); }

  RobotChecker checker_;
  RobotChecker::Scratch scratch_;
  RobotChecker confirmed_;
  RobotChecker::Scratch confirmed_scratch_;
  FclArm obbrss_;
  FclArm obb_;
  std::vector<std::unique_ptr<ArmChecker>> bullet_{};
  std::vector<ArmChecker*> peers_;  // all of these
};

void Times::take(std::size_t edge, double ns) {
  if (edge == each_.size()) each_.push_back(ns);
  each_[edge] = std::min(each_[edge], ns);
}

void Times::add(const Times& other) {
  each_.insert(each_.end(), other.each_.begin(), other.each_.end());
}

double Times::total() const {
  return std::accumulate(each_.begin(), each_.end(), 0.0);
}

double Times::mean_us() const {
  return 1e-3 * total() / static_cast<double>(each_.size());
}

double Times::median_us() const {
  return 1e-3 * median(each_);
}

double Times::median_over(const Times& others) const {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < each_.size(); ++i) ratios.push_back(each_[i] / others.each_[i]);
  return median(std::move(ratios));
}

// The largest step of a joint between configurations that a planner examines (MoveIt: 0.05), and
// that the truth is taken at, in radians.
constexpr double kUsualStep = 0.05;
constexpr double kFineStep = 0.002;

// Edges that a method sees one after another, and how often.
constexpr std::size_t kRun = 64;
constexpr int kRounds = 3;

bool intersects(ArmChecker& arm, const std::vector<Configuration>& all) {
  return std::any_of(all.begin(), all.end(),
                     [&](const Configuration& at) { return arm.collides(at); });
}

Course::Course(const Arm& arm, const AllowedCollisions& allowed, const ArmScene& scene)
    : checker_(robot_scene(arm, allowed, scene).snapshot()),
      scratch_(checker_),
      confirmed_(robot_scene(arm, allowed, scene).snapshot({.meshes = arm.covers})),
      confirmed_scratch_(confirmed_),
      obbrss_(arm, allowed, scene, FclVolume::kObbRss),
      obb_(arm, allowed, scene, FclVolume::kObb),
      peers_{&obbrss_, &obb_} {
  for (const BulletLinks links : {BulletLinks::kHulls, BulletLinks::kGImpact}) {
    bullet_.push_back(std::make_unique<BulletArm>(arm, allowed, scene, links));
    peers_.push_back(bullet_.back().get());
  }
}

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
  for (const ArmChecker* peer : peers_) counts.peers.push_back({.name = peer->name()});
  for (std::size_t first = 0; first < edges.size(); first += kRun) {
    const std::size_t last = std::min(edges.size(), first + kRun);
    std::vector<std::vector<Configuration>> usual;
    for (std::size_t i = first; i < last; ++i) usual.push_back(samples(edges[i], kUsualStep));
    std::vector<EdgeResult> results(last - first);
    std::vector<EdgeResult> confirmed(last - first);
    std::vector<Met> met(last - first, {.peers = std::vector<std::uint8_t>(peers_.size())});
    const auto time_all = [&](Times& times, auto query) {
      for (std::size_t i = first; i < last; ++i) {
        const auto start = Clock::now();
        query(i - first);
        times.take(i, nanoseconds(Clock::now() - start));
      }
    };
    for (int round = 0; round < kRounds; ++round) {
      time_all(counts.proof, [&](std::size_t i) {
        const Edge& edge = edges[first + i];
        results[i] = checker_.check_edge(edge.from, edge.to, scratch_, {.resolution = 1e-3});
      });
      time_all(counts.confirmed, [&](std::size_t i) {
        const Edge& edge = edges[first + i];
        confirmed[i] =
            confirmed_.check_edge(edge.from, edge.to, confirmed_scratch_, {.resolution = 1e-3});
      });
      time_all(counts.own, [&](std::size_t i) {
        met[i].spheres = !std::all_of(usual[i].begin(), usual[i].end(),
                                      [&](const Configuration& at) { return is_free(at); });
      });
      for (std::size_t k = 0; k < peers_.size(); ++k) {
        time_all(counts.peers[k].times, [&](std::size_t i) {
          met[i].peers[k] = intersects(*peers_[k], usual[i]) ? 1 : 0;
        });
      }
    }
    for (std::size_t i = first; i < last; ++i) {
      const Met& sampled = met[i - first];
      const bool in_contact =
          sampled.peers[0] != 0 || intersects(obb_, samples(edges[i], kFineStep));
      counts.judge(results[i - first], confirmed[i - first], sampled, in_contact);
    }
  }
  return counts;
}

ConfigurationTimes Course::measure_configurations(std::size_t count, bool is_path,
                                                  RandomNumbers& random) {
  const RobotModel& robot = checker_.robot();
  const auto variables = static_cast<std::size_t>(robot.variable_count());
  std::vector<double> all;
  while (all.size() < count * variables) {
    const Edge edge = random_edge(robot, random);
    // On a path in steps of some hundredths of a radian.
    const std::size_t steps = is_path ? 64 : 1;
    for (std::size_t k = 0; k < steps && all.size() < count * variables; ++k) {
      const double t = static_cast<double>(k) / 64.0;
      for (std::size_t v = 0; v < variables; ++v) {
        all.push_back((1.0 - t) * edge.from[v] + t * edge.to[v]);
      }
    }
  }
  ConfigurationTimes times(count);
  for (const ArmChecker* peer : peers_) times.peers.push_back({peer->name(), times.single});
  const auto at = [&](std::size_t i) { return std::span(all).subspan(i * variables, variables); };
  const auto time_each = [&](ConfigurationRow& row, auto is_free_at) {
    const auto start = Clock::now();
    for (std::size_t i = 0; i < count; ++i) row.free[i] = is_free_at(at(i)) ? 1 : 0;
    row.take(nanoseconds(Clock::now() - start));
  };
  constexpr int kConfigurationRounds = 5;
  for (int round = 0; round < kConfigurationRounds; ++round) {
    time_each(times.single, [&](auto q) { return checker_.check_config(q, scratch_); });
    const auto start = Clock::now();
    checker_.check_configs(all, scratch_, times.batch.free);
    times.batch.take(nanoseconds(Clock::now() - start));
    time_each(times.confirmed,
              [&](auto q) { return confirmed_.check_config(q, confirmed_scratch_); });
    for (std::size_t k = 0; k < peers_.size(); ++k) {
      time_each(times.peers[k].row, [&](auto q) { return !peers_[k]->collides(q); });
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    times.truth[i] = times.peers[0].row.free[i] != 0 && !obbrss_.holds_an_obstacle(at(i)) ? 1 : 0;
  }
  return times;
}

double ConfigurationRow::median_ns() const {
  return median(rounds_ns);
}

void ConfigurationTimes::print_head() const {
  std::printf(
      "\none configuration: ns in single calls; times as long as that: in batches, confirmed, "
      "other libraries; of all configurations in contact by FCL or with an obstacle inside "
      "of a link, missed / extra\n"
      "| scene, order | ns | many | confirmed |");
  for (const Peer& peer : peers) std::printf(" %s |", peer.name.c_str());
  std::printf(" contact | missed / extra | confirmed |");
  for (const Peer& peer : peers) std::printf(" %s |", peer.name.c_str());
  std::printf("\n|---|---|---|---|---|---|---|");
  for (std::size_t i = 0; i < 2 * peers.size(); ++i) std::printf("---|");
  std::printf("\n");
}

void ConfigurationTimes::print(const char* name) const {
  const auto count = static_cast<double>(single.free.size());
  const double own = single.median_ns();
  const auto print_time = [&](const ConfigurationRow& row) {
    std::printf(" %5.2f |", row.median_ns() / own);
  };
  const auto print_verdicts = [&](const ConfigurationRow& row) {
    std::size_t missed = 0, extra = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      missed += truth[i] == 0 && row.free[i] != 0 ? 1 : 0;
      extra += truth[i] != 0 && row.free[i] == 0 ? 1 : 0;
    }
    std::printf(" %zu / %zu |", missed, extra);
  };
  std::printf("| %-16s | %6.0f |", name, own / count);
  for (const ConfigurationRow* row : {&batch, &confirmed}) print_time(*row);
  for (const Peer& peer : peers) print_time(peer.row);
  std::printf(" %5zu |", static_cast<std::size_t>(std::count(truth.begin(), truth.end(), 0)));
  for (const ConfigurationRow* row : {&single, &confirmed}) print_verdicts(*row);
  for (const Peer& peer : peers) print_verdicts(peer.row);
  std::printf("\n");
}

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

constexpr std::size_t kEdges = 2000;
constexpr std::size_t kSteps = 16;  // of an edge, as a path
constexpr int kCostRounds = 9;

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
  for (int round = 0; round < kCostRounds; ++round) {
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

// What the tests of links against each other cost among fifty primitives: with them and without, in
// turns. Prints a table.
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

// What more spheres cost: the same questions of each arm in turns, in a scene of primitives. Prints
// a table of times the first arm's.
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
