// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/claims.h"

#include "bench/fit_parts.h"
#include "bench/studies/study.h"
#include "simplifier/simplify.h"
#include "spheretree/build.h"
#include "tests/support/shapes.h"

#include <cstdio>
#include <memory>
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

}  // namespace spherule
