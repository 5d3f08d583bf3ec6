// SPDX-License-Identifier: BSD-3-Clause
// How fast is a collision check of the paper's work cell, engine by engine, and is the answer
// right? See bench/README.md for the protocol.
#include "base/error.h"
#include "base/files.h"
#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/checkers/sphere_checkers.h"
#include "bench/checkers/workload.h"
#include "bench/studies/measure.h"
#include "tests/support/program.h"
#ifdef SPHERULE_BENCH_STUDIES
#include "bench/studies/study.h"
#endif

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

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

// Every so manieth configuration of a program, in its order and in a random one: what an engine
// remembers of a path must not cost more than it saves.
struct StepMeasurement {
  std::size_t step = 1;
  std::vector<Measurement> methods;  // of kPathMethods
};
constexpr std::array<TreeMode, 2> kPathMethods{TreeMode::kSingle, TreeMode::kBatch};

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
  std::vector<StepMeasurement> steps = {};
  // The rows of the studies by name (studies/study.h).
  nlohmann::ordered_json studies = {};
};

// Names in results.json.
constexpr const char* kUsualFcl = "fcl-mesh-obbrss";
constexpr const char* kFastestFcl = "fcl-mesh-fastest";

using Json = nlohmann::ordered_json;

double time_of(const WorkloadResult& result, const std::string& name) {
  for (const MethodResult& method : result.methods) {
    if (method.name == name) return method.measurement.ns_per_query;
  }
  return 0.0;
}

double percent_of_oracle(const WorkloadResult& result, std::size_t count) {
  return 100.0 * static_cast<double>(count) /
         static_cast<double>(std::max<std::size_t>(1, result.oracle_collisions));
}

Json to_json(const WorkloadResult& result, const MethodResult& method) {
  const Measurement& m = method.measurement;
  Json json{{"name", method.name},
            {"ns_per_query", m.ns_per_query},
            {"shuffled_ns_per_query", m.shuffled_ns_per_query},
            {"p50_ns", m.p50_ns},
            {"p99_ns", m.p99_ns},
            {"percentiles_ns", m.percentiles_ns},
            {"collisions", method.count.collisions},
            {"missed", method.count.missed},
            {"extra", method.count.extra},
            {"spheres_or_triangles", method.primitives}};
  json["counters"] = {
      {"setting", method.setting},
      {"timed_queries", m.timed_queries},
      {"times_fcl_mesh_obbrss", time_of(result, kUsualFcl) / m.ns_per_query},
      {"times_fcl_mesh_fastest", time_of(result, kFastestFcl) / m.ns_per_query},
      {"extra_percent_of_collisions", percent_of_oracle(result, method.count.extra)}};
  return json;
}

Json to_json(const WorkloadResult& result) {
  Json json{{"name", result.name},
            {"queries", result.queries},
            {"oracle_collisions", result.oracle_collisions}};
  for (const auto& [body, count] : result.oracle_by_body) {
    json["oracle_collisions_by_body"][body] = count;
  }
  for (const FitRecord& fit : result.fits) {
    json["parts"].push_back({{"name", fit.part},
                             {"triangles", fit.triangles},
                             {"spheres", fit.spheres},
                             {"max_error_m", fit.max_error},
                             {"min_external_diameter_m", fit.min_external_diameter},
                             {"seconds", fit.seconds},
                             {"covered", fit.covered}});
  }
  for (const MethodResult& method : result.methods) {
    json["methods"].push_back(to_json(result, method));
  }
  const EdgeMeasurement& edges = result.edges;
  json["edges"] = {{"free", edges.free},           {"collision", edges.collision},
                   {"unknown", edges.unknown},     {"unknown_but_free", edges.unknown_but_free},
                   {"median_ns", edges.median_ns}, {"p95_ns", edges.p95_ns},
                   {"p99_ns", edges.p99_ns}};
  for (const StepMeasurement& row : result.steps) {
    json["steps"].push_back({{"step", row.step},
                             {"single_ns", row.methods[0].ns_per_query},
                             {"single_shuffled_ns", row.methods[0].shuffled_ns_per_query},
                             {"batch_ns", row.methods[1].ns_per_query},
                             {"batch_shuffled_ns", row.methods[1].shuffled_ns_per_query}});
  }
  json["studies"] = result.studies;
  return json;
}

// Compares with the oracle and picks fcl-mesh-fastest.
WorkloadResult evaluate(const Workload& workload, std::vector<FitRecord> fits,
                        const std::vector<Method>& methods, std::vector<Measurement> measurements,
                        const std::vector<std::uint32_t>& touching_bodies) {
  WorkloadResult result{.name = workload.name,
                        .queries = workload.program.size(),
                        .oracle_collisions = 0,
                        .oracle_by_body = {},
                        .fits = std::move(fits),
                        .methods = {},
                        .edges = {},
                        .steps = {},
                        .studies = {}};
  std::vector<std::uint8_t> truth;
  for (const std::uint32_t bits : touching_bodies) truth.push_back(bits != 0 ? 1 : 0);
  result.oracle_collisions = static_cast<std::size_t>(std::count(truth.begin(), truth.end(), 1));
  for (std::size_t body = 0; body < workload.bodies.size(); ++body) {
    const auto hits = std::count_if(touching_bodies.begin(), touching_bodies.end(),
                                    [&](std::uint32_t bits) { return (bits >> body & 1U) != 0; });
    result.oracle_by_body.emplace_back(workload.bodies[body].part.name,
                                       static_cast<std::size_t>(hits));
  }
  std::size_t fastest = methods.size();
  for (std::size_t m = 0; m < methods.size(); ++m) {
    MethodResult line{.name = methods[m].name,
                      .setting = methods[m].setting,
                      .measurement = std::move(measurements[m]),
                      .primitives = methods[m].primitives};
    line.count = count(line.measurement.verdicts, truth);
    const bool is_fcl_mesh = line.name.starts_with("fcl-mesh");
    result.methods.push_back(std::move(line));
    if (is_fcl_mesh &&
        (fastest == methods.size() || result.methods[m].measurement.ns_per_query <
                                          result.methods[fastest].measurement.ns_per_query)) {
      fastest = m;
    }
  }
  MethodResult best = result.methods[fastest];
  best.name = kFastestFcl;
  // Settings without a name of their own stand in results.json as the fastest one only.
  std::erase_if(result.methods,
                [](const MethodResult& line) { return line.name.starts_with("fcl-mesh "); });
  const auto place = std::find_if(result.methods.begin(), result.methods.end(),
                                  [](const auto& line) { return line.name == "fcl-spheres"; });
  result.methods.insert(place, std::move(best));
  return result;
}

void print_table(const WorkloadResult& result) {
  std::printf(
      "\n%s: %zu configurations, %zu in collision (%.2f %%); by body:", result.name.c_str(),
      result.queries, result.oracle_collisions,
      100.0 * static_cast<double>(result.oracle_collisions) / static_cast<double>(result.queries));
  for (const auto& [body, count] : result.oracle_by_body) {
    if (count > 0) std::printf(" %s %zu", body.c_str(), count);
  }
  std::printf("\n\n%-12s %9s %8s %8s %8s %9s\n", "part", "triangles", "spheres", "E mm", "D mm",
              "fit s");
  for (const FitRecord& fit : result.fits) {
    std::printf("%-12s %9zu %8zu %8.1f %8.1f %9.2f\n", fit.part.c_str(), fit.triangles, fit.spheres,
                1e3 * fit.max_error, 1e3 * fit.min_external_diameter, fit.seconds);
  }
  std::printf("\n%-20s %11s %11s %10s %10s %8s %8s %7s %7s %8s %8s\n", "method", "ns/query",
              "shuffled", "p50", "p99", "x obbrss", "x fastest", "hits", "missed", "extra",
              "extra %");
  for (const MethodResult& method : result.methods) {
    const Measurement& m = method.measurement;
    std::printf("%-20s %11.1f %11.1f %10.0f %10.0f %8.2f %8.2f %7zu %7zu %8zu %8.1f\n",
                method.name.c_str(), m.ns_per_query, m.shuffled_ns_per_query, m.p50_ns, m.p99_ns,
                time_of(result, kUsualFcl) / m.ns_per_query,
                time_of(result, kFastestFcl) / m.ns_per_query, method.count.collisions,
                method.count.missed, method.count.extra,
                percent_of_oracle(result, method.count.extra));
    if (method.name == kFastestFcl) std::printf("  (%s)\n", method.setting.c_str());
  }
  const EdgeMeasurement& edges = result.edges;
  const double single = time_of(result, "spherule-single");
  std::printf(
      "\nmoves between them: %zu proved free, %zu in collision, %zu unknown (%zu of them free at "
      "10,000 steps)\n  ns: median %.0f, p95 %.0f, p99 %.0f; in single checks: %.1f, %.1f, %.1f\n",
      edges.free, edges.collision, edges.unknown, edges.unknown_but_free, edges.median_ns,
      edges.p95_ns, edges.p99_ns, edges.median_ns / single, edges.p95_ns / single,
      edges.p99_ns / single);
  std::printf("\nlonger steps, ns/query %10s %9s %6s %10s %9s %6s\n", "single", "shuffled", "ratio",
              "batch", "shuffled", "ratio");
  for (const StepMeasurement& row : result.steps) {
    std::printf("%20zu x", row.step);
    for (const Measurement& m : row.methods) {
      std::printf(" %10.1f %9.1f %6.2f", m.ns_per_query, m.shuffled_ns_per_query,
                  m.ns_per_query / m.shuffled_ns_per_query);
    }
    std::printf("\n");
  }
  std::fflush(stdout);
}

// results.json, of which bench/plots/plot.py draws. Throws Error.
void write_results(const std::vector<WorkloadResult>& results,
                   const std::filesystem::path& folder) {
  Json json{{"workloads", Json::array()}};
  for (const WorkloadResult& result : results) {
    json["workloads"].push_back(to_json(result));
  }
  write_file_atomically(folder / "results.json", json.dump(1) + "\n");
}

// The engines of the comparison, in the order of the table; the workload must be fitted and outlive
// them. FCL's mesh engine appears in every setting under a name of its own; results.json names the
// best of them fcl-mesh-fastest.
std::vector<Method> make_methods(const Workload& workload) {
  const std::size_t triangles = triangle_count(workload);
  const std::size_t spheres = sphere_count(workload);
  std::size_t triangles_and_spheres = 0;
  for (const Body& body : workload.bodies) triangles_and_spheres += body.part.mesh.triangles.size();
  for (const Obstacle& obstacle : workload.obstacles) {
    triangles_and_spheres += obstacle.part.tree->spheres().size();
  }
  std::vector<Method> methods;
  using Setting = FclMeshSetting;
  const auto is_plain = [](const Setting& setting) {
    return setting.precision == Setting::Precision::kDouble &&
           setting.front == Setting::Front::kBoxes;
  };
  for (const Setting& setting : all_fcl_mesh_settings()) {
    const bool rss = setting.volume == Setting::Volume::kObbRss;
    const std::string words = to_string(setting);
    const std::string name =
        is_plain(setting) ? (rss ? kUsualFcl : "fcl-mesh-obb") : "fcl-mesh " + words;
    methods.push_back({name, words, make_fcl_mesh_checker(workload, setting), triangles, false});
  }
  methods.push_back({"fcl-spheres", "Sphere shapes, manager against manager",
                     make_fcl_sphere_checker(workload), spheres, true});
  methods.push_back({"bullet-pair-test", "compounds of spheres, contactPairTest for each pair",
                     make_bullet_sphere_checker(workload, BulletQuery::kContactPairTest), spheres,
                     false});
  methods.push_back({"bullet-trees", "their dynamic AABB trees walked to the first contact",
                     make_bullet_sphere_checker(workload, BulletQuery::kTrees), spheres, false});
  methods.push_back({"brute-force-spheres", "all pairs, single precision, widest vectors",
                     make_flat_scan_checker(workload, FlatScan::kAllPairs), spheres, true});
  methods.push_back({"flat-scan-spheres", "the same behind a sphere around each body",
                     make_flat_scan_checker(workload, FlatScan::kSpheresInFront), spheres, false});
  methods.push_back({"spherule-single", "sphere trees, one configuration a call",
                     make_tree_checker(workload, TreeMode::kSingle), spheres, false});
  methods.push_back({"spherule-batch", "sphere trees, many configurations a call",
                     make_tree_checker(workload, TreeMode::kBatch), spheres, false});
  methods.push_back({"spherule-confirmed", "the first, contacts confirmed on the triangles",
                     make_tree_checker(workload, TreeMode::kConfirmed), spheres, false});
  methods.push_back({"spherule-mesh", "meshes of robot and torch, spheres of the rest",
                     make_tree_checker(workload, TreeMode::kMeshes), triangles_and_spheres, false});
  if (best_instruction_set() == InstructionSet::kAvx512) {
    methods.push_back({"spherule-batch-avx2", "many configurations a call, without AVX-512",
                       make_tree_checker(workload, TreeMode::kBatch, InstructionSet::kAvx2),
                       spheres, false});
  }
  return methods;
}

bool is_free_at_many(const RobotChecker& checker, RobotChecker::Scratch& scratch,
                     const ArmPositions& from, const ArmPositions& to) {
  constexpr int kSteps = 10000;
  for (int step = 0; step <= kSteps; ++step) {
    const double t = static_cast<double>(step) / kSteps;
    ArmPositions at;
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = (1.0 - t) * from[i] + t * to[i];
    if (!checker.check_config(at, scratch)) return false;
  }
  return true;
}

EdgeMeasurement measure_edges(const Workload& workload) {
  const RobotChecker checker = make_robot_checker(workload);
  RobotChecker::Scratch scratch(checker);
  const std::vector<ArmPositions>& program = workload.program;
  checker.check_edge(program[0], program[1], scratch);  // warms the scratch up
  const double cost = clock_cost();
  EdgeMeasurement result;
  std::vector<double> times;
  for (std::size_t i = 0; i + 1 < program.size(); ++i) {
    const auto start = Clock::now();
    const EdgeResult edge = checker.check_edge(program[i], program[i + 1], scratch);
    times.push_back(std::max(0.0, nanoseconds(Clock::now() - start) - cost));
    if (edge.verdict == Verdict::kFree) {
      ++result.free;
    } else if (edge.verdict == Verdict::kCollision) {
      ++result.collision;
    } else {
      ++result.unknown;
      if (is_free_at_many(checker, scratch, program[i], program[i + 1])) ++result.unknown_but_free;
    }
  }
  std::sort(times.begin(), times.end());
  result.median_ns = quantile(times, 0.5);
  result.p95_ns = quantile(times, 0.95);
  result.p99_ns = quantile(times, 0.99);
  return result;
}

std::vector<StepMeasurement> measure_steps(const Workload& workload, int rounds) {
  std::vector<Method> methods;
  for (const TreeMode mode : kPathMethods) {
    methods.push_back({.name = {}, .setting = {}, .checker = make_tree_checker(workload, mode)});
  }
  std::vector<StepMeasurement> rows;
  for (const std::size_t step : {1, 2, 4, 8, 16, 32}) {
    const MeasureOptions options{.rounds = rounds * static_cast<int>(step), .stride = step};
    rows.push_back({step, measure(methods, workload.program, options)});
  }
  return rows;
}

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
  result.steps = measure_steps(workload, options.rounds);
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
