// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/report.h"

#include "base/files.h"

#include <Eigen/Core>
#include <fcl/config.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <string>
#include <thread>
#include <utility>

namespace spherule {
namespace {

using Json = nlohmann::ordered_json;

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string compiler() {
#ifdef __clang__
  return __VERSION__;
#else
  return std::string("GCC ") + __VERSION__;
#endif
}

// What a result depends on beside the code: processor, compiler, the versions of FCL and Eigen, and
// those of the Debian packages that the file names, "NAME VERSION" a line, if it is there.
Json machine_facts(const std::filesystem::path& packages) {
  Json facts = {
      {"processor", processor()},
      {"cores", std::to_string(std::thread::hardware_concurrency())},
      {"compiler", compiler()},
      {"FCL", FCL_VERSION},
      {"Eigen", std::to_string(EIGEN_WORLD_VERSION) + '.' + std::to_string(EIGEN_MAJOR_VERSION) +
                    '.' + std::to_string(EIGEN_MINOR_VERSION)}};
  std::ifstream file(packages);
  for (std::string name, version; file >> name >> version;) facts[name] = version;
  return facts;
}

Json to_json(const Table1Cells& cells) {
  return {{"queries", cells.queries},     {"collisions", cells.count.collisions},
          {"missed", cells.count.missed}, {"extra", cells.count.extra},
          {"seconds", cells.seconds},     {"ratio", cells.ratio}};
}

Json to_json(const Table1Row& row) {
  Json json = {{"method", row.method}, {"complexity", row.complexity}};
  json.update(to_json(row.whole));
  json["conservative"] = row.is_conservative;
  json["critical_section"] = to_json(row.critical);
  if (row.paper) {
    json["paper"] = {{"complexity", row.paper->complexity},
                     {"collisions", row.paper->collisions},
                     {"seconds", row.paper->seconds}};
  }
  return json;
}

// One number of each step, before and after inflation, by method.
Json figure(const std::vector<FitCourse>& courses, double CoverHistoryEntry::*before,
            double CoverHistoryEntry::*after) {
  Json json = Json::object();
  for (const FitCourse& course : courses) {
    Json steps = Json::array();
    for (const CoverHistoryEntry& entry : course.history) {
      steps.push_back({{"spheres", entry.sphere_count},
                       {"before_inflation", entry.*before},
                       {"after_inflation", entry.*after}});
    }
    json[course.method] = std::move(steps);
  }
  return json;
}

Json to_json(const ClaimRow& row) {
  return {{"shape", row.shape},
          {"holes", row.holes},
          {"triangles", row.triangles},
          {"max_error", row.max_error},
          {"min_external_diameter", row.min_external_diameter},
          {"spheres_with_stage1", row.with_stage1},
          {"spheres_without_stage1", row.without_stage1},
          {"fcl_over_spheres", row.ratio}};
}

Json to_json(const Figure3Row& row) {
  return {{"min_external_diameter", row.min_external_diameter},
          {"uncovered_reachable", row.reachable},
          {"uncovered_random", row.random}};
}

Json to_json(const Figure2& figure) {
  Json json = {{"max_error", figure.max_error},
               {"min_external_diameter", figure.min_external_diameter},
               {"methods", Json::array()}};
  for (const Figure2::Fit& fit : figure.fits) {
    json["methods"].push_back(
        {{"method", fit.method}, {"spheres", fit.spheres.size()}, {"protrusion", fit.protrusion}});
  }
  return json;
}

Json to_json(const CountRow& row) {
  Json json = {{"part", row.part},
               {"triangles", row.triangles},
               {"diagonal", row.diagonal},
               {"max_protrusion", row.max_protrusion},
               {"methods", Json::array()}};
  for (const CountEntry& entry : row.entries) {
    json["methods"].push_back({{"method", entry.method},
                               {"spheres", entry.spheres > 0 ? Json(entry.spheres) : Json(nullptr)},
                               {"protrusion", entry.protrusion},
                               {"growth", entry.inflation},
                               {"setting", entry.setting},
                               {"seconds", entry.seconds}});
  }
  return json;
}

Json to_json(const TreeCost& cost) {
  return {{"nodes", cost.nodes},
          {"depth", cost.depth},
          {"node_tests", cost.node_tests},
          {"ns", cost.ns}};
}

Json to_json(const TreeRow& row) {
  return {{"method", row.method},
          {"leaves", row.leaves},
          {"collision_percent", row.collision_percent},
          {"own", to_json(row.own)},
          {"ours", to_json(row.ours)}};
}

template <class Row>
Json list(const std::vector<Row>& rows) {
  Json json = Json::array();
  for (const Row& row : rows) json.push_back(to_json(row));
  return json;
}

}  // namespace

void write_paper(const PaperResults& results, const std::filesystem::path& folder) {
  using Entry = CoverHistoryEntry;
  const Json json = {
      {"machine", machine_facts(folder / "packages.txt")},
      {"table1", list(results.table1)},
      {"figures",
       {{"2", to_json(results.figure_2)},
        {"3", list(results.figure_3)},
        {"6", figure(results.courses, &Entry::surface_error_before, &Entry::surface_error_after)},
        {"7", figure(results.courses, &Entry::coverage_before, &Entry::coverage_after)},
        {"8", figure(results.courses, &Entry::excess_before, &Entry::excess_after)}}},
      {"claims", list(results.claims)},
      {"counts", list(results.counts)},
      {"trees", list(results.trees)}};
  write_file_atomically(folder / "paper.json", json.dump(1) + "\n");
}

}  // namespace spherule
