// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Fits of a workload, and what an engine takes for its queries.

#include "bench/checkers/workload.h"
#include "simplifier/simplify.h"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace spherule {

struct FitRecord {
  std::string part;
  std::size_t triangles = 0;
  std::size_t spheres = 0;
  double max_error = 0.0;
  double min_external_diameter = 0.0;
  double seconds = 0.0;
  bool covered = false;
};

// A line on standard output.
void print_fit(const FitRecord& fit);

// Throws Error naming the part and its broken_promises(), if there are any: nothing measured on
// such a set is worth having.
void check_promises(const Simplification& fit, const std::string& part);

// Rounds of the search: fewer than by default, since the workpiece is large for its E.
inline constexpr int kFitEffort = 30;

// simplify() and build_tree() for every part of the workload; `done` is told of each. Throws Error
// as check_promises() does.
std::vector<FitRecord> fit_parts(Workload& workload,
                                 const std::function<void(const FitRecord&)>& done,
                                 int effort = kFitEffort);

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
