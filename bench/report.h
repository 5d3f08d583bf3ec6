// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/edges.h"
#include "bench/fit_parts.h"
#include "bench/measure.h"
#include "bench/workload.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace spherule {

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

}  // namespace spherule
