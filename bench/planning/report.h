// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/planning/problem_study.h"
#include "bench/planning/process_study.h"
#include "bench/studies/fit_parts.h"

#include <filesystem>
#include <string>
#include <vector>

namespace spherule {

struct PlanningResult {
  std::string name;  // of the workload
  std::vector<FitRecord> fits = {};
  ProblemStudy problems = {};
  ProcessStudy process = {};
};

void print_table(const ProblemStudy& study);
void print_table(const ProcessStudy& study);

// FOLDER/planning.json. Throws Error.
void write_result(const PlanningResult& result, const std::filesystem::path& folder);

}  // namespace spherule
