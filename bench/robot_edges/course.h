// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/robot_edges/arm.h"
#include "bench/robot_edges/peer_arms.h"
#include "bench/studies/refined_cover.h"
#include "collide/sweep.h"
#include "robot/check/robot_checker.h"
#include "robot/pairs/allowed_collisions.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace spherule {

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
  bool is_asked() const { return !rounds_ns.empty(); }
};

struct ConfigurationTimes {
  explicit ConfigurationTimes(std::size_t count)
      : single{std::vector<std::uint8_t>(count)},
        batch(single),
        confirmed(single),
        flat(single),
        truth(count) {}

  // Of another library.
  struct Peer {
    std::string name;
    ConfigurationRow row;
  };

  ConfigurationRow single, batch, confirmed, flat;
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
  FlatArm flat_;
  bool has_mesh_;
  FclArm obbrss_;
  FclArm obb_;
  std::vector<std::unique_ptr<ArmChecker>> bullet_{};
  std::vector<ArmChecker*> peers_;  // all of these
};

// What the tests of links against each other cost among fifty primitives: with them and without, in
// turns. Prints a table.
void measure_self_share(const Arm& arm, const AllowedCollisions& allowed);

// What more spheres cost: the same questions of each arm in turns, in a scene of primitives. Prints
// a table of times the first arm's.
void measure_sizes(std::span<const Arm> arms, const AllowedCollisions& allowed);

}  // namespace spherule
