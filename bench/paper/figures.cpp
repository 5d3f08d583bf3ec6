// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/baseline/sphere_methods.h"
#include "bench/checkers/workload.h"
#include "bench/paper/paper.h"
#include "bench/studies/measure.h"
#include "bench/studies/refined_cover.h"
#include "collide/collide.h"
#include "simplifier/simplify.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/shapes.h"
#include "tests/support/solids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

namespace spherule {
namespace {

constexpr double kFigure2Error = 0.012;
constexpr double kFigure2External = 0.030;

// A comb of three slots, 12 mm wide, in a block of 120 x 60 x 30 mm.
TriangleMesh slotted_block() {
  constexpr double kWidth = 0.120, kHeight = 0.060, kDepth = 0.030;
  constexpr double kSlot = 0.012, kFloor = 0.015;
  Loop outline = {{0.0, 0.0}, {kWidth, 0.0}, {kWidth, kHeight}};
  for (const double middle : {0.090, 0.060, 0.030}) {
    outline.insert(outline.end(), {{middle + 0.5 * kSlot, kHeight},
                                   {middle + 0.5 * kSlot, kFloor},
                                   {middle - 0.5 * kSlot, kFloor},
                                   {middle - 0.5 * kSlot, kHeight}});
  }
  outline.push_back({0.0, kHeight});
  return placed(extrude(outline, {}, 0.0, kDepth), profile_xz(), Eigen::Vector3d::Zero());
}

Figure2::Fit packed(const TriangleMesh& part) {
  SpherePacking packing = pack_spheres(part, {.max_error = kFigure2Error});
  const Certificate proof =
      certify(part, packing.inflated, {.external = &packing.solid, .volume = false});
  if (!proof.covered || *proof.protrusion_over_simplified_max > kFigure2Error) {
    throw Error("figure 2", "the packing does not cover within the error");
  }
  return {"packing", std::move(packing.inflated), *proof.protrusion_over_simplified_max};
}

Figure2::Fit bounding(const TriangleMesh& part, const char* name, CoverMethod method) {
  Simplification result = simplify(
      part,
      {.max_error = kFigure2Error, .min_external_diameter = kFigure2External, .method = method});
  check_promises(result, "figure 2");
  return {name, std::move(result.cover.spheres),
          *result.certificate.protrusion_over_simplified_max};
}

}  // namespace

Figure2 figure_2() {
  Figure2 figure{slotted_block(), kFigure2Error, kFigure2External, {}};
  figure.fits.push_back(packed(figure.part));
  figure.fits.push_back(bounding(figure.part, "bounding-paper", CoverMethod::kPaper));
  figure.fits.push_back(bounding(figure.part, "bounding-cover", CoverMethod::kCover));
  return figure;
}

void print_figure_2(const Figure2& figure) {
  std::printf("\nfigure 2: a block with slots (E %.0f mm, D %.0f mm)\n", 1e3 * figure.max_error,
              1e3 * figure.min_external_diameter);
  for (const Figure2::Fit& fit : figure.fits) {
    std::printf("  %-16s %4zu spheres, protrusion %.2f mm\n", fit.method.c_str(),
                fit.spheres.size(), 1e3 * fit.protrusion);
  }
}

namespace {

// Cells whose centres lie within `reach` of `center`: the first and the one behind the last.
struct Cells {
  int begin;
  int end;

  Cells(double center, double reach, int count)
      : begin(static_cast<int>(std::clamp(std::ceil(center - reach - 0.5), 0.0, double(count)))),
        end(static_cast<int>(
            std::clamp(std::floor(center + reach - 0.5) + 1.0, double(begin), double(count)))) {}
};

}  // namespace

double uncovered_share(const ExternalSpheres& external, int along) {
  const Eigen::Vector3d size = external.box.sizes();
  const double cell = size.maxCoeff() / along;
  std::array<int, 3> count{};
  for (int i = 0; i < 3; ++i) count[static_cast<std::size_t>(i)] = std::max(1, int(size[i] / cell));
  const auto [nx, ny, nz] = count;
  const Eigen::Vector3d scale(nx / size.x(), ny / size.y(), nz / size.z());
  const auto width = static_cast<std::size_t>(nx) + 1;
  // Of each row of cells: how many more spheres cover a cell than the one before it.
  std::vector<int> change(width * static_cast<std::size_t>(ny) * static_cast<std::size_t>(nz));
  for (const Sphere& sphere : external.spheres) {
    const Eigen::Vector3d center = (sphere.center - external.box.min()).cwiseProduct(scale);
    const Cells z(center.z(), sphere.radius * scale.z(), nz);
    for (int k = z.begin; k < z.end; ++k) {
      const double dz = (k + 0.5 - center.z()) / scale.z();
      const double in_layer = std::sqrt(std::max(0.0, sphere.radius * sphere.radius - dz * dz));
      const Cells y(center.y(), in_layer * scale.y(), ny);
      for (int j = y.begin; j < y.end; ++j) {
        const double dy = (j + 0.5 - center.y()) / scale.y();
        const double in_row = std::sqrt(std::max(0.0, in_layer * in_layer - dy * dy));
        const Cells x(center.x(), in_row * scale.x(), nx);
        int* const row = change.data() + width * static_cast<std::size_t>(k * ny + j);
        ++row[x.begin];
        --row[x.end];
      }
    }
  }
  std::size_t uncovered = 0;
  for (std::size_t row = 0; row < change.size(); row += width) {
    int covering = 0;
    for (std::size_t i = 0; i + 1 < width; ++i) {
      covering += change[row + i];
      if (covering == 0) ++uncovered;
    }
  }
  return static_cast<double>(uncovered) /
         (static_cast<double>(nx) * static_cast<double>(ny) * static_cast<double>(nz));
}

namespace {

constexpr double kWall = 0.0059;
constexpr double kLength = 0.2;
constexpr int kSides = 96;
constexpr double kFigureError = 0.001;
constexpr double kFigureExternal = 0.1;
constexpr int kCellsAlong = 320;

}  // namespace

TriangleMesh make_paper_pipe() {
  return make_pipe(kPaperBore + 2.0 * kWall, kPaperBore, kLength, kSides);
}

std::vector<Figure3Row> figure_3() {
  const TriangleMesh pipe = make_paper_pipe();
  std::vector<Figure3Row> rows;
  for (int millimetres = 14; millimetres <= 60; millimetres += 2) {
    Figure3Row row{.min_external_diameter = 1e-3 * millimetres};
    ExternalOptions options{.min_external_diameter = row.min_external_diameter,
                            .max_error = kFigureError};
    row.uncovered_reachable = uncovered_share(place_external_spheres(pipe, options), kCellsAlong);
    options.placement = ExternalPlacement::kRandom;
    row.uncovered_random = uncovered_share(place_external_spheres(pipe, options), kCellsAlong);
    rows.push_back(row);
  }
  return rows;
}

FitCourse bounding_course() {
  const TriangleMesh pipe = make_paper_pipe();
  const ExternalSpheres external = place_external_spheres(
      pipe, {.min_external_diameter = kFigureExternal, .max_error = kFigureError});
  const CoverOptions options{
      .method = CoverMethod::kPaper, .max_error = kFigureError, .history = true};
  SphereCover result = cover(pipe, external, options);
  return {"bounding", std::move(result.history), std::move(result.spheres)};
}

FitCourse packing_course() {
  // Nothing of the pipe is narrower than a quarter of its bore.
  SpherePacking result =
      pack_spheres(make_paper_pipe(),
                   {.max_error = kFigureError, .closed_below = 0.25 * kPaperBore, .history = true});
  return {"packing", std::move(result.history), std::move(result.inflated)};
}

namespace {

constexpr double kTreeError = 0.004;  // of octree and rod
constexpr double kRodDiameter = 0.02;
constexpr double kRodLength = 0.15;
constexpr double kAround = 0.02;  // how far from the pipe's box the rod's middle may be
constexpr std::size_t kPoses = 4000;
constexpr int kRounds = 5;
constexpr std::uint64_t kPoseSeed = 3;

std::vector<Pose> poses_near(const SphereTree& tree) {
  RandomNumbers random(kPoseSeed);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < kPoses; ++i) {
    Eigen::Vector3d middle = tree.box().center;
    for (int axis = 0; axis < 3; ++axis) {
      const double reach = tree.box().half_size[axis] + kAround;
      middle[axis] += random.between(-reach, reach);
    }
    poses.emplace_back(random.rotation(), middle);
  }
  return poses;
}

// Rounds alternate between the two trees.
void measure(const SphereTree& rod, const std::vector<Pose>& poses, const SphereTree& own,
             const SphereTree& ours, TreeRow& row) {
  const std::pair<const SphereTree*, TreeCost*> trees[] = {{&own, &row.own}, {&ours, &row.ours}};
  std::vector<bool> hits[2];
  for (int i = 0; i < 2; ++i) {
    const auto& [tree, cost] = trees[i];
    std::uint64_t tests = 0;
    for (const Pose& pose : poses) {
      const CollisionResult result = collide(rod, pose, *tree, Pose(), {.max_pairs = 1});
      tests += result.cost.node_tests;
      hits[i].push_back(!result.pairs.empty());
    }
    cost->nodes = tree->node_count();
    cost->depth = tree->depth();
    cost->node_tests = static_cast<double>(tests) / static_cast<double>(poses.size());
  }
  if (hits[0] != hits[1])
    throw Error(row.method, "two trees over the same spheres answer otherwise");
  row.collision_percent = 100.0 *
                          static_cast<double>(std::count(hits[0].begin(), hits[0].end(), true)) /
                          static_cast<double>(poses.size());
  std::vector<double> times[2];
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < 2; ++i) {
      const auto start = Clock::now();
      for (const Pose& pose : poses) collide(rod, pose, *trees[i].first, Pose(), {.max_pairs = 1});
      times[i].push_back(nanoseconds(Clock::now() - start) / static_cast<double>(poses.size()));
    }
  }
  for (int i = 0; i < 2; ++i) trees[i].second->ns = median(times[i]);
}

}  // namespace

std::vector<TreeRow> study_trees() {
  const TriangleMesh pipe = make_paper_pipe();
  const Simplification rod_fit =
      simplify(make_cylinder(0.5 * kRodDiameter, kRodLength, 32), {.max_error = kTreeError});
  const SphereTree rod = build_tree(rod_fit.cover.spheres);
  const SphereLevels hubbard = hubbard_spheres(pipe);
  const SphereLevels medial = medial_axis_tree(pipe);
  const std::pair<const char*, SphereTree> trees[] = {
      {"octree", octree_spheres(pipe, {.max_error = kTreeError}).tree},
      {"hubbard", enclosing_tree(hubbard, hubbard.levels.back()).tree},
      {"medial-axis", enclosing_tree(medial, medial.levels.back()).tree}};
  std::vector<TreeRow> rows;
  for (const auto& [method, tree] : trees) {
    TreeRow row{.method = method, .leaves = tree.spheres().size()};
    measure(rod, poses_near(tree), tree, build_tree(tree.spheres()), row);
    rows.push_back(row);
  }
  return rows;
}

void print_trees(const std::vector<TreeRow>& rows) {
  std::printf(
      "\ntrees over the pipe, a rod nearby: as the method has them | ours, the same leaves\n");
  std::printf("%-12s %7s %6s %7s %6s %11s %8s | %7s %6s %11s %8s\n", "method", "leaves", "hit %",
              "nodes", "depth", "node tests", "ns", "nodes", "depth", "node tests", "ns");
  for (const TreeRow& row : rows) {
    std::printf("%-12s %7zu %6.1f %7zu %6d %11.1f %8.0f | %7zu %6d %11.1f %8.0f\n",
                row.method.c_str(), row.leaves, row.collision_percent, row.own.nodes, row.own.depth,
                row.own.node_tests, row.own.ns, row.ours.nodes, row.ours.depth, row.ours.node_tests,
                row.ours.ns);
  }
}

}  // namespace spherule
