// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/course.h"

#include "bench/robot_edges/arm_scenes.h"
#include "bench/studies/measure.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace spherule {

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

namespace {

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

}  // namespace

Course::Course(const Arm& arm, const AllowedCollisions& allowed, const ArmScene& scene)
    : checker_(robot_scene(arm, allowed, scene).snapshot()),
      scratch_(checker_),
      confirmed_(robot_scene(arm, allowed, scene).snapshot({.meshes = arm.covers})),
      confirmed_scratch_(confirmed_),
      flat_(arm, allowed, scene),
      has_mesh_(!scene.mesh.triangles.empty()),
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
    if (!has_mesh_) time_each(times.flat, [&](auto q) { return !flat_.collides(q); });
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
      "\none configuration: ns in single calls; times as long as that: in batches, confirmed, the "
      "flat\n"
      "scan, other libraries; of all configurations in contact by FCL or with an obstacle inside "
      "of a link, missed / extra\n"
      "| scene, order | ns | many | confirmed | flat |");
  for (const Peer& peer : peers) std::printf(" %s |", peer.name.c_str());
  std::printf(" contact | missed / extra | confirmed |");
  for (const Peer& peer : peers) std::printf(" %s |", peer.name.c_str());
  std::printf("\n|---|---|---|---|---|---|---|---|");
  for (std::size_t i = 0; i < 2 * peers.size(); ++i) std::printf("---|");
  std::printf("\n");
}

void ConfigurationTimes::print(const char* name) const {
  const auto count = static_cast<double>(single.free.size());
  const double own = single.median_ns();
  const auto print_time = [&](const ConfigurationRow& row) {
    if (row.is_asked()) {
      std::printf(" %5.2f |", row.median_ns() / own);
    } else {
      std::printf(" - |");
    }
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
  for (const ConfigurationRow* row : {&batch, &confirmed, &flat}) print_time(*row);
  for (const Peer& peer : peers) print_time(peer.row);
  std::printf(" %5zu |", static_cast<std::size_t>(std::count(truth.begin(), truth.end(), 0)));
  for (const ConfigurationRow* row : {&single, &confirmed}) print_verdicts(*row);
  for (const Peer& peer : peers) print_verdicts(peer.row);
  std::printf("\n");
}

}  // namespace spherule
