// SPDX-License-Identifier: BSD-3-Clause
// How fast is a collision check of the paper's work cell, engine by engine, and is the answer
// right? See bench/README.md for the protocol.
#include "base/error.h"
#include "bench/fit_parts.h"
#include "bench/measure.h"
#include "bench/methods.h"
#include "bench/oracle.h"
#include "bench/placed_cell.h"
#include "bench/program.h"
#include "bench/real_models.h"
#include "bench/report.h"
#include "bench/scene_files.h"
#include "bench/studies/study.h"

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

const Part& part_named(const std::string& name, const Workload& workload) {
  for (const Body& body : workload.bodies) {
    if (body.part.name == name) return body.part;
  }
  for (const Obstacle& obstacle : workload.obstacles) {
    if (obstacle.part.name == name) return obstacle.part;
  }
  throw Error(workload.name, "has no part " + name);
}

WorkloadResult run(Workload workload, const Arguments& arguments) {
  std::printf("%s: fitting\n", workload.name.c_str());
  std::fflush(stdout);
  std::vector<FitRecord> fits = fit_parts(workload, &print_fit);
  write_scene(workload, workload.program[kShownConfiguration], arguments.out / workload.name);
  std::printf("%s: asking the oracle\n", workload.name.c_str());
  std::fflush(stdout);
  const auto touching = Oracle(workload).touching_bodies(workload.program);
  const std::vector<Method> methods = make_methods(workload);
  std::printf("%s: timing\n", workload.name.c_str());
  std::fflush(stdout);
  const MeasureOptions options = arguments.quick
                                     ? MeasureOptions{.rounds = 3, .stride = 4, .slow_stride = 512}
                                     : MeasureOptions{};
  auto measurements = measure(methods, workload.program, options);
  WorkloadResult result =
      evaluate(workload, std::move(fits), methods, std::move(measurements), touching);
  result.edges = measure_edges(workload);
  const StudyOptions studies{.rounds = options.rounds, .stride = options.stride};
  result.studies.sizes = study_sizes(workload, touching, studies);
  result.studies.small_environments = study_small_environments(workload, studies);
  result.studies.distances =
      study_distances(part_named("torch", workload), part_named("workpiece", workload), studies);
  print_table(result);
  return result;
}

int bench(const Arguments& arguments) {
  std::filesystem::create_directories(arguments.out);
  std::vector<WorkloadResult> results;
  results.push_back(run(make_paper_cell(), arguments));
  if (const auto models = models_folder()) {
    results.push_back(run(make_real_cell(*models), arguments));
  }
  write_results(results, arguments.out);
  for (const WorkloadResult& result : results) {
    for (const MethodResult& method : result.methods) {
      if (method.name.starts_with("spherule") && method.count.missed > 0) {
        throw Error(result.name, method.name + " missed collisions");
      }
    }
    for (const SmallRow& row : result.studies.small_environments) {
      if (row.missed > 0) {
        throw Error(result.name, std::to_string(row.obstacles) + " obstacles: collisions missed");
      }
    }
    for (const SizeRow& row : result.studies.sizes) {
      if (row.missed > 0) {
        throw Error(result.name, std::to_string(row.spheres) + " spheres missed collisions");
      }
    }
  }
  return 0;
}

}  // namespace
}  // namespace spherule

int main(int count, char** values) {
  return spherule::run_program("spherule_bench",
                               [&] { return spherule::bench(spherule::parse(count, values)); });
}
