// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/report.h"

#include "base/files.h"
#include "bench/paper/machine.h"

#include <nlohmann/json.hpp>

#include <sstream>
#include <string>

namespace spherule {
namespace {

using Json = nlohmann::ordered_json;

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

std::string counts_csv(const std::vector<CountRow>& rows) {
  std::ostringstream text;
  text << "part,triangles,max_protrusion,method,spheres,protrusion,growth,setting,seconds\n";
  for (const CountRow& row : rows) {
    for (const CountEntry& entry : row.entries) {
      text << '"' << row.part << "\"," << row.triangles << ',' << row.max_protrusion << ','
           << entry.method << ',' << entry.spheres << ',' << entry.protrusion << ','
           << entry.inflation << ',' << entry.setting << ',' << entry.seconds << '\n';
    }
  }
  return text.str();
}

std::string table1_csv(const std::vector<Table1Row>& rows) {
  std::ostringstream text;
  text << "method,complexity,section,queries,collisions,missed,extra,seconds,ratio\n";
  for (const Table1Row& row : rows) {
    for (const bool is_critical : {false, true}) {
      const Table1Cells& cells = is_critical ? row.critical : row.whole;
      text << row.method << ',' << row.complexity << ',' << (is_critical ? "critical" : "whole")
           << ',' << cells.queries << ',' << cells.count.collisions << ',' << cells.count.missed
           << ',' << cells.count.extra << ',' << cells.seconds << ',' << cells.ratio << '\n';
    }
  }
  return text.str();
}

// Blocks for gnuplot, one a method.
std::string courses_data(const std::vector<FitCourse>& courses) {
  std::ostringstream text;
  for (const FitCourse& course : courses) {
    if (&course != &courses.front()) text << "\n\n";
    text << '"' << course.method << "\"\n";
    for (const CoverHistoryEntry& entry : course.history) {
      text << entry.sphere_count << ' ' << 1e3 * entry.surface_error_before << ' '
           << 1e3 * entry.surface_error_after << ' ' << 100.0 * entry.coverage_before << ' '
           << 100.0 * entry.coverage_after << ' ' << 100.0 * entry.excess_before << ' '
           << 100.0 * entry.excess_after << '\n';
    }
  }
  return text.str();
}

std::string figure_3_data(const std::vector<Figure3Row>& rows) {
  std::ostringstream text;
  for (const Figure3Row& row : rows) {
    text << 1e3 * row.min_external_diameter << ' ' << 100.0 * row.reachable << ' '
         << 100.0 * row.random << '\n';
  }
  return text.str();
}

}  // namespace

void write_paper(const PaperResults& results, const std::filesystem::path& folder) {
  Json machine = Json::object();
  for (const auto& [name, value] : machine_facts(folder / "packages.txt")) machine[name] = value;
  using Entry = CoverHistoryEntry;
  const Json json = {
      {"machine", std::move(machine)},
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
  write_file_atomically(folder / "paper-table1.csv", table1_csv(results.table1));
  write_file_atomically(folder / "paper-counts.csv", counts_csv(results.counts));
  write_file_atomically(folder / "paper-figure3.dat", figure_3_data(results.figure_3));
  write_file_atomically(folder / "paper-courses.dat", courses_data(results.courses));
}

}  // namespace spherule
