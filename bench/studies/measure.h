// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace spherule {

using Clock = std::chrono::steady_clock;

double nanoseconds(Clock::duration duration);

double quantile(const std::vector<double>& sorted, double share);
double median(std::vector<double> values);  // 0 of none

// What two readings of the clock with nothing between them say, in nanoseconds.
double clock_cost();

// An engine under test.
struct Method {
  std::string name;
  std::string setting;  // in words
  std::unique_ptr<Checker> checker;
  std::size_t primitives = 0;  // triangles or spheres, all parts together
  bool slow = false;           // timed on a sample of the program
};

struct MeasureOptions {
  int rounds = 5;
  std::size_t stride = 1;         // time every so manieth configuration
  std::size_t slow_stride = 128;  // the same for slow methods
};

struct Measurement {
  double ns_per_query = 0.0;           // medians over the rounds
  double shuffled_ns_per_query = 0.0;  // the same in random order; 0 for slow methods
  double p50_ns = 0.0;                 // over single queries, the clock's own cost taken off
  double p99_ns = 0.0;
  std::array<double, 101> percentiles_ns{};
  std::size_t timed_queries = 0;
  std::vector<std::uint8_t> verdicts;  // of the whole program
};

// Against the truth: what touches and what is said to.
struct VerdictCount {
  std::size_t collisions = 0;  // said
  std::size_t missed = 0;      // the truth says collision, the verdict free
  std::size_t extra = 0;       // the reverse
};
VerdictCount count(const std::vector<std::uint8_t>& verdicts,
                   const std::vector<std::uint8_t>& truth);

// Times the methods in alternating rounds, so that a slow moment of the machine affects all of
// them, in path order and, but for slow ones, in a random order, then single queries, and collects
// all verdicts.
std::vector<Measurement> measure(const std::vector<Method>& methods,
                                 const std::vector<ArmPositions>& program,
                                 const MeasureOptions& options);

}  // namespace spherule
