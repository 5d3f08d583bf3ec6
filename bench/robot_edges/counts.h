// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/robot_edges/times.h"
#include "collide/sweep.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace spherule {

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

}  // namespace spherule
