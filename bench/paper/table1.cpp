// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/baseline/mesh_methods.h"
#include "bench/baseline/sphere_methods.h"
#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/checkers/sphere_checkers.h"
#include "bench/checkers/workload.h"
#include "bench/paper/paper.h"
#include "bench/studies/measure.h"
#include "simplifier/simplify.h"
#include "spheretree/sphere_tree.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <span>
#include <utility>

namespace spherule {
namespace {

// The narrowest way into the workpiece is its bore of 34 mm.
constexpr double kNothingNarrower = 0.010;
// Of the decomposition's parts: a tenth of a pipe.
constexpr double kConcavity = 0.004;

std::size_t workpiece_index(const Workload& workload) {
  const auto found =
      std::find_if(workload.obstacles.begin(), workload.obstacles.end(),
                   [](const Obstacle& obstacle) { return obstacle.part.name == "workpiece"; });
  if (found == workload.obstacles.end()) throw Error(workload.name, "has no workpiece");
  return static_cast<std::size_t>(found - workload.obstacles.begin());
}

std::string count_of(std::size_t number, const char* what) {
  return std::to_string(number) + ' ' + what;
}

std::vector<Sphere> by_papers_loop(const Part& part) {
  const Simplification result =
      simplify(part.mesh, {.max_error = part.max_error,
                           .min_external_diameter = part.min_external_diameter,
                           .method = CoverMethod::kPaper,
                           .external = ExternalPlacement::kRandom});
  if (!result.certificate.covered) throw Error(part.name, broken_promises(result));
  return result.cover.spheres;
}

class Rows {
 public:
  explicit Rows(const Workload& workload)
      : workload_(workload),
        index_(workpiece_index(workload)),
        part_(workload.obstacles[index_].part) {}

  const Part& part() const { return part_; }

  void add(Representation row) {
    std::printf("  %s: %s\n", row.method.c_str(), row.complexity.c_str());
    std::fflush(stdout);
    rows_.push_back(std::move(row));
  }

  // The workpiece as another mesh, as convex parts, or as spheres.
  void add_mesh(std::string method, const TriangleMesh& mesh, bool is_conservative,
                std::optional<PaperRow> paper) {
    Workload changed = workload_;
    changed.obstacles[index_].part.mesh = mesh;
    add({std::move(method), count_of(mesh.triangles.size(), "triangles"), is_conservative,
         make_fcl_mesh_checker(changed, {}), std::move(paper)});
  }
  void add_convex(std::string method, const std::vector<TriangleMesh>& parts,
                  bool is_conservative) {
    add({std::move(method), count_of(parts.size(), parts.size() == 1 ? "hull" : "hulls"),
         is_conservative, make_fcl_convex_checker(workload_, index_, parts)});
  }
  void add_spheres(std::string method, std::span<const Sphere> spheres, bool is_conservative,
                   std::optional<PaperRow> paper = {}) {
    Workload changed = workload_;
    changed.obstacles[index_].part.tree = std::make_shared<const SphereTree>(build_tree(spheres));
    add({std::move(method), count_of(spheres.size(), "spheres"), is_conservative,
         make_tree_checker(changed, TreeMode::kMeshes), std::move(paper)});
  }

  std::vector<Representation> take() { return std::move(rows_); }

 private:
  const Workload& workload_;
  std::size_t index_;
  const Part& part_;
  std::vector<Representation> rows_;
};

}  // namespace

std::vector<Representation> make_representations(const Workload& workload) {
  Rows rows(workload);
  const Part& part = rows.part();
  const TriangleMesh& mesh = part.mesh;
  rows.add_mesh("original", mesh, true, PaperRow{"1942 triangles", 2032, 1798.0});
  rows.add_mesh("decimated",
                decimate(mesh, {.target_triangles = mesh.triangles.size() / 2, .measure = {}}).mesh,
                false, PaperRow{"996 triangles", 1801, 894.0});
  rows.add_convex("hull", {convex_hull(mesh).mesh}, true);
  rows.add_convex("decomposition",
                  decompose(mesh, {.max_concavity = kConcavity, .measure = {}}).parts, false);
  const SpherePacking packing =
      pack_spheres(mesh, {.max_error = part.max_error, .closed_below = kNothingNarrower});
  rows.add_spheres("packing", packing.spheres, false, PaperRow{"4752 spheres", 2134, 258.0});
  rows.add_spheres("packing-inflated", packing.inflated, true);
  rows.add_spheres("voxels",
                   voxelise(mesh, {.step = kPaperVoxel, .sphere = VoxelSphere::kInscribed}).spheres,
                   false, PaperRow{"2675 spheres", 2865, 170.0});
  rows.add_spheres("voxels-covering", voxelise(mesh, {.step = kPaperVoxel}).spheres, true);
  rows.add_spheres("bounding-paper", by_papers_loop(part), true,
                   PaperRow{"283 spheres", 2222, 102.0});
  rows.add_spheres("bounding-cover", part.tree->spheres(), true);
  rows.add({"all-simplified", count_of(sphere_count(workload), "spheres"), true,
            make_tree_checker(workload, TreeMode::kSingle), PaperRow{"-", 2289, 7.0}});
  return rows.take();
}

namespace {

// Of the chosen queries.
Table1Cells cells(const std::vector<std::uint8_t>& verdicts, const std::vector<std::uint8_t>& truth,
                  double ns_per_query) {
  return {.queries = truth.size(),
          .count = count(verdicts, truth),
          .seconds = 1e-9 * ns_per_query * static_cast<double>(truth.size())};
}

}  // namespace

std::vector<Table1Row> make_table1(const Workload& workload,
                                   std::vector<Representation> representations,
                                   const MeasureOptions& options) {
  const auto touching = Oracle(workload).touching_bodies(workload.program);
  std::vector<std::uint8_t> truth;
  for (const std::uint32_t bodies : touching) truth.push_back(bodies != 0 ? 1 : 0);
  std::vector<ArmPositions> critical;
  std::vector<std::uint8_t> critical_truth;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (workload.is_critical[i] == 0) continue;
    critical.push_back(workload.program[i]);
    critical_truth.push_back(truth[i]);
  }
  std::vector<Table1Row> rows;
  std::vector<Method> methods;
  for (Representation& of : representations) {
    rows.push_back({of.method, of.complexity, of.is_conservative, {}, {}, of.paper});
    methods.push_back({of.method, of.complexity, std::move(of.checker), 0, false});
  }
  const std::vector<Measurement> whole = measure(methods, workload.program, options);
  const std::vector<Measurement> of_critical = measure(methods, critical, options);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].whole = cells(whole[i].verdicts, truth, whole[i].ns_per_query);
    rows[i].critical = cells(of_critical[i].verdicts, critical_truth, of_critical[i].ns_per_query);
    rows[i].whole.ratio = rows.front().whole.seconds / rows[i].whole.seconds;
    rows[i].critical.ratio = rows.front().critical.seconds / rows[i].critical.seconds;
  }
  return rows;
}

void print_table1(const std::vector<Table1Row>& rows) {
  std::printf("\nTable I (in brackets: the critical section; at the right: the paper's row)\n");
  std::printf("%-16s %-16s %16s %14s %14s %20s %18s | %-16s %6s %8s %6s\n", "method", "complexity",
              "collisions", "missed", "extra", "ms", "ratio", "paper", "coll.", "s", "ratio");
  for (const Table1Row& row : rows) {
    std::printf("%-16s %-16s %7zu (%6zu) %5zu (%5zu) %5zu (%5zu) %9.3f (%8.3f) %8.1f (%6.1f) |",
                row.method.c_str(), row.complexity.c_str(), row.whole.count.collisions,
                row.critical.count.collisions, row.whole.count.missed, row.critical.count.missed,
                row.whole.count.extra, row.critical.count.extra, 1e3 * row.whole.seconds,
                1e3 * row.critical.seconds, row.whole.ratio, row.critical.ratio);
    if (row.paper) {
      std::printf(" %-16s %6zu %8.0f %6.1f", row.paper->complexity.c_str(), row.paper->collisions,
                  row.paper->seconds, rows.front().paper->seconds / row.paper->seconds);
    }
    std::printf("\n");
  }
}

}  // namespace spherule
