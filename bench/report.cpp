// SPDX-License-Identifier: BSD-3-Clause
#include "bench/report.h"

#include "base/files.h"
#include "bench/methods.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace spherule {
namespace {

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
  json["studies"] = result.studies;
  return json;
}

}  // namespace

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
  std::fflush(stdout);
}

void write_results(const std::vector<WorkloadResult>& results,
                   const std::filesystem::path& folder) {
  Json json{{"workloads", Json::array()}};
  for (const WorkloadResult& result : results) {
    json["workloads"].push_back(to_json(result));
  }
  write_file_atomically(folder / "results.json", json.dump(1) + "\n");
}

}  // namespace spherule
