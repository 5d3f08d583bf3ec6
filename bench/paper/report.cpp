// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/report.h"

#include "base/files.h"
#include "bench/studies/fit_parts.h"
#include "bench/studies/study.h"
#include "simplifier/simplify.h"
#include "spheretree/build.h"
#include "tests/support/shapes.h"

#include <Eigen/Core>
#include <fcl/config.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <utility>

namespace spherule {
namespace {

constexpr double kError = 0.003;
constexpr double kExternal = 4.0 * kError;  // the default of `fit`
// Holes are wider than the small D by half their own and narrower than the large one by as much.
constexpr double kHole = 0.006;
constexpr double kSmall = 0.003;
constexpr int kSidesOfHole = 12;
constexpr int kEffort = 3;

// How far the rod is when it is timed, of the two bodies' size.
constexpr double kRelativeDistance = 0.01;

Part fit(const std::string& shape, const TriangleMesh& mesh, double diameter) {
  const Simplification fit =
      simplify(mesh, {.max_error = kError, .min_external_diameter = diameter, .effort = kEffort});
  check_promises(fit, shape);
  return {shape, mesh, kError, diameter,
          std::make_shared<const SphereTree>(build_tree(fit.cover.spheres))};
}

ClaimRow row(const std::string& shape, int holes, const TriangleMesh& mesh, const Part& rod) {
  const Part with = fit(shape, mesh, kExternal);
  const Part without = fit(shape, mesh, kSmall);
  ClaimRow row{shape,
               holes,
               mesh.triangles.size(),
               kError,
               kExternal,
               with.tree->spheres().size(),
               without.tree->spheres().size()};
  for (const DistanceRow& at : study_distances(rod, with, {.rounds = 3})) {
    if (at.relative == kRelativeDistance) row.ratio = at.fcl_collide_ns / at.collides_same_poses_ns;
  }
  return row;
}

}  // namespace

std::vector<ClaimRow> study_claims() {
  const Eigen::Vector3d plate(0.24, 0.12, 0.01);
  const Part rod = fit("rod", make_cylinder(0.01, 0.15, 32), kExternal);
  std::vector<ClaimRow> rows;
  rows.push_back(row("plate, 10 mm", 0, make_box(plate), rod));
  for (const auto& [across, along] : {std::pair(5, 2), {10, 5}, {20, 5}, {20, 10}}) {
    rows.push_back(row("plate, 10 mm", across * along,
                       make_plate_with_holes(plate, across, along, kHole, kSidesOfHole), rod));
  }
  for (const double thickness : {0.005, 0.002}) {
    char name[32];
    std::snprintf(name, sizeof name, "plate, %.0f mm", 1e3 * thickness);
    rows.push_back(row(name, 0, make_box({plate.x(), plate.y(), thickness}), rod));
  }
  rows.push_back(row("cube, 60 mm", 0, make_cube(0.06), rod));
  return rows;
}

void print_claims(const std::vector<ClaimRow>& rows) {
  std::printf("\nspheres with and without stage 1 (E %.0f mm, D %.0f mm)\n", 1e3 * kError,
              1e3 * kExternal);
  std::printf("%-14s %6s %10s %8s %8s %6s %12s\n", "shape", "holes", "triangles", "with", "without",
              "share", "FCL / ours");
  for (const ClaimRow& row : rows) {
    std::printf("%-14s %6d %10zu %8zu %8zu %6.2f %12.1f\n", row.shape.c_str(), row.holes,
                row.triangles, row.with_stage1, row.without_stage1,
                static_cast<double>(row.with_stage1) / static_cast<double>(row.without_stage1),
                row.ratio);
  }
}

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
