// SPDX-License-Identifier: BSD-3-Clause
// How fast is a collision check of the paper's work cell, engine by engine, and is the answer
// right? See bench/README.md for the protocol.
#include "bench/checkers/workload.h"
#include "bench/report.h"
#include "bench/studies/measure.h"
#include "tests/support/program.h"
#ifdef SPHERULE_BENCH_STUDIES
#include "bench/studies/study.h"
#endif
#include "base/error.h"

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace spherule {
namespace {

struct Arguments {
  std::filesystem::path out = "bench/out";
  bool quick = false;
};

Arguments parse(int count, char** values) {
  Arguments arguments;
  for (int i = 1; i < count; ++i) {
    const std::string option = values[i];
    if (option == "--quick") {
      arguments.quick = true;
    } else if (option == "--out" && i + 1 < count) {
      arguments.out = values[++i];
    } else {
      throw Error(option, "unknown option, or its value is lacking (see bench/run --help)");
    }
  }
  return arguments;
}

// Says what is being done, since some of it takes a minute.
void announce(const Workload& workload, const char* work) {
  std::printf("%s: %s\n", workload.name.c_str(), work);
  std::fflush(stdout);
}

void check_nothing_missed(const WorkloadResult& result) {
  for (const MethodResult& method : result.methods) {
    if (method.name.starts_with("spherule") && method.count.missed > 0) {
      throw Error(result.name, method.name + " missed collisions");
    }
  }
}

// Fits, checks and prints the table; the studies follow where they are built.
WorkloadResult run(Workload workload, const Arguments& arguments) {
  announce(workload, "fitting spheres");
  std::vector<FitRecord> fits = fit_parts(workload, &print_fit);
  announce(workload, "querying the oracle");
  const auto touching = Oracle(workload).touching_bodies(workload.program);
  const std::vector<Method> methods = make_methods(workload);
  announce(workload, "measuring");
  const MeasureOptions options = arguments.quick
                                     ? MeasureOptions{.rounds = 3, .stride = 4, .slow_stride = 512}
                                     : MeasureOptions{};
  auto measurements = measure(methods, workload.program, options);
  WorkloadResult result =
      evaluate(workload, std::move(fits), methods, std::move(measurements), touching);
  result.edges = measure_edges(workload);
  print_table(result);
  check_nothing_missed(result);
#ifdef SPHERULE_BENCH_STUDIES
  write_scene(workload, workload.program[kShownConfiguration], arguments.out / workload.name);
  announce(workload, "measuring more spheres, few obstacles, two bodies at a distance");
  result.studies =
      run_studies(workload, touching, {.rounds = options.rounds, .stride = options.stride});
#endif
  return result;
}

int bench(const Arguments& arguments) {
  std::filesystem::create_directories(arguments.out);
  std::vector<WorkloadResult> results;
  results.push_back(run(make_paper_cell(), arguments));
#ifdef SPHERULE_BENCH_STUDIES
  if (const auto models = models_folder()) {
    results.push_back(run(make_real_cell(*models), arguments));
  }
#endif
  write_results(results, arguments.out);
  return 0;
}

}  // namespace
}  // namespace spherule

int main(int count, char** values) {
  return spherule::run_program("spherule_bench",
                               [&] { return spherule::bench(spherule::parse(count, values)); });
}
