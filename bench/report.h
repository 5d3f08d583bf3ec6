// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/checkers/workload.h"
#include "bench/studies/measure.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace spherule {

// The moves from each configuration of a program to the next, as straight motions in joint space.
struct EdgeMeasurement {
  std::size_t free = 0;       // proved
  std::size_t collision = 0;  // a configuration in contact was found
  std::size_t unknown = 0;
  std::size_t unknown_but_free = 0;  // of these: no contact at 10,000 configurations on it
  double median_ns = 0.0;            // of single calls, the clock's own cost taken off
  double p95_ns = 0.0;
  double p99_ns = 0.0;
};

EdgeMeasurement measure_edges(const Workload& workload);

// One line of the table.
struct MethodResult {
  std::string name;
  std::string setting;
  Measurement measurement;
  std::size_t primitives = 0;
  VerdictCount count = {};  // against the oracle
};

struct WorkloadResult {
  std::string name;
  std::size_t queries = 0;
  std::size_t oracle_collisions = 0;
  std::vector<std::pair<std::string, std::size_t>> oracle_by_body;
  std::vector<FitRecord> fits;
  std::vector<MethodResult> methods;
  EdgeMeasurement edges = {};
  // The rows of the studies by name (studies/study.h).
  nlohmann::ordered_json studies = {};
};

// Compares with the oracle and picks fcl-mesh-fastest.
WorkloadResult evaluate(const Workload& workload, std::vector<FitRecord> fits,
                        const std::vector<Method>& methods, std::vector<Measurement> measurements,
                        const std::vector<std::uint32_t>& touching_bodies);

void print_table(const WorkloadResult& result);

// results.json, of which bench/plot draws. Throws Error.
void write_results(const std::vector<WorkloadResult>& results, const std::filesystem::path& folder);

// The engines of the comparison, in the order of the table; the workload must be fitted and outlive
// them. FCL's mesh engine appears in every setting under a name of its own; results.json names the
// best of them fcl-mesh-fastest.
std::vector<Method> make_methods(const Workload& workload);

// Names in results.json.
inline constexpr const char* kUsualFcl = "fcl-mesh-obbrss";
inline constexpr const char* kFastestFcl = "fcl-mesh-fastest";

// The same cell with the published visual meshes of the ABB IRB 4400L and a real torch, from a
// folder that holds robots/abb_irb4400l and torch/torch.stl. Throws Error if they are not there.
Workload make_real_cell(const std::filesystem::path& models);

}  // namespace spherule
