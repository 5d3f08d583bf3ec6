// SPDX-License-Identifier: BSD-3-Clause
// The table and the figures of the paper, made again. See bench/README.md.
#include "base/error.h"
#include "base/files.h"
#include "bench/paper/paper.h"
#include "bench/studies/measure.h"
#include "bench/studies/study.h"
#include "simplifier/simplify.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/program.h"
#include "tests/support/shapes.h"

#include <Eigen/Core>
#include <fcl/config.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace spherule {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Figure3Row, min_external_diameter, uncovered_reachable,
                                   uncovered_random)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TreeCost, nodes, depth, node_tests, ns)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TreeRow, method, leaves, collision_percent, own, ours)

namespace {

// What the paper says without a figure: a shape in spheres at equal E, with stage 1 and with a D so
// small that nothing of the shape vanishes. Lengths in metres.
struct ClaimRow {
  std::string shape;
  int holes = 0;
  std::size_t triangles = 0;
  double max_error = 0.0;
  double min_external_diameter = 0.0;  // with stage 1
  std::size_t spheres_with_stage1 = 0;
  std::size_t spheres_without_stage1 = 0;
  // A rod 20 mm across at a hundredth of the size from it: time of the fastest FCL setting on the
  // meshes over ours on the spheres with stage 1.
  double fcl_over_spheres = 0.0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ClaimRow, shape, holes, triangles, max_error,
                                   min_external_diameter, spheres_with_stage1,
                                   spheres_without_stage1, fcl_over_spheres)

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
    if (at.relative == kRelativeDistance) {
      row.fcl_over_spheres = at.fcl_collide_ns / at.collides_same_poses_ns;
    }
  }
  return row;
}

// "The performance increases are most dramatic on CAD models that contain many small features":
// a plate with 0 to 200 holes. "Sphere packing is not suited to models which are long, wide and
// narrow such as a thin plate": thinner ones, of few triangles. "At its worst case performs no
// differently than sphere packing": a cube, of which stage 1 changes nothing. Throws Error if a fit
// is not proved.
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
                row.triangles, row.spheres_with_stage1, row.spheres_without_stage1,
                static_cast<double>(row.spheres_with_stage1) /
                    static_cast<double>(row.spheres_without_stage1),
                row.fcl_over_spheres);
  }
}

// All that `bench/run --paper` computes.
struct PaperResults {
  std::vector<Table1Row> table1;
  Figure2 figure_2;
  std::vector<Figure3Row> figure_3;
  std::vector<FitCourse> courses;  // figures 6 to 8
  std::vector<ClaimRow> claims;
  std::vector<CountRow> counts;
  std::vector<TreeRow> trees;
};

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

template <class Row>
Json list(const std::vector<Row>& rows) {
  Json json = Json::array();
  for (const Row& row : rows) json.push_back(to_json(row));
  return json;
}

// FOLDER/paper.json, of which bench/plots/plot.py makes the page. Throws Error.
void write_paper(const PaperResults& results, const std::filesystem::path& folder) {
  using Entry = CoverHistoryEntry;
  const Json json = {
      {"machine", machine_facts(folder / "packages.txt")},
      {"table1", list(results.table1)},
      {"figures",
       {{"2", to_json(results.figure_2)},
        {"3", nlohmann::json(results.figure_3)},
        {"6", figure(results.courses, &Entry::surface_error_before, &Entry::surface_error_after)},
        {"7", figure(results.courses, &Entry::coverage_before, &Entry::coverage_after)},
        {"8", figure(results.courses, &Entry::excess_before, &Entry::excess_after)}}},
      {"claims", nlohmann::json(results.claims)},
      {"counts", list(results.counts)},
      {"trees", nlohmann::json(results.trees)}};
  write_file_atomically(folder / "paper.json", json.dump(1) + "\n");
}

// Our own and, where SPHERULE_MODELS says where they are, real ones.
std::vector<NamedMesh> all_parts() {
  std::vector<NamedMesh> parts = own_parts();
  if (const auto models = models_folder()) {
    for (NamedMesh& part : real_parts(*models)) parts.push_back(std::move(part));
  }
  return parts;
}

std::vector<CountRow> count_all(const std::vector<NamedMesh>& parts) {
  std::vector<CountRow> rows;
  for (const NamedMesh& part : parts) {
    std::printf("  %s, %zu triangles\n", part.name.c_str(), part.mesh.triangles.size());
    rows.push_back(compare_counts(part, &print_count));
  }
  return rows;
}

std::filesystem::path parse(int count, char** values) {
  std::filesystem::path out = "bench/out";
  for (int i = 1; i < count; ++i) {
    const std::string option = values[i];
    if (option != "--out" || i + 1 == count) {
      throw Error(option, "unknown option, or its value is lacking (see bench/run --help)");
    }
    out = values[++i];
  }
  return out;
}

void say(const char* what) {
  std::printf("paper: %s\n", what);
  std::fflush(stdout);
}

int run(const std::filesystem::path& out) {
  std::filesystem::create_directories(out);
  // First of all, since some may be unreadable.
  const std::vector<NamedMesh> parts = all_parts();
  PaperResults results;
  say("figure 2");
  results.figure_2 = figure_2();
  print_figure_2(results.figure_2);
  say("figure 3");
  results.figure_3 = figure_3();
  say("figures 6 to 8");
  results.courses.push_back(bounding_course());
  results.courses.push_back(packing_course());
  say("holes, thin plates, a cube");
  results.claims = study_claims();
  print_claims(results.claims);
  say("trees");
  results.trees = study_trees();
  print_trees(results.trees);
  say("spheres at equal protrusion");
  results.counts = count_all(parts);
  print_counts(results.counts);
  say("fitting the work cell");
  Workload workload = make_paper_cell();
  fit_parts(workload, &print_fit);
  write_pictures(workload, results.figure_2, results.courses, out);
  say("table I");
  results.table1 = make_table1(workload, make_representations(workload), {});
  print_table1(results.table1);
  write_paper(results, out);
  for (const Table1Row& row : results.table1) {
    if (row.is_conservative && row.whole.count.missed > 0) {
      throw Error(row.method, std::to_string(row.whole.count.missed) + " collisions missed");
    }
  }
  return 0;
}

}  // namespace
}  // namespace spherule

int main(int count, char** values) {
  return spherule::run_program("spherule_paper",
                               [&] { return spherule::run(spherule::parse(count, values)); });
}
