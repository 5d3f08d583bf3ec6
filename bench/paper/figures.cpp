// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/figures.h"

#include "bench/baseline/sphere_packing.h"
#include "bench/paper/space_share.h"
#include "tests/support/shapes.h"

#include <utility>

namespace spherule {
namespace {

constexpr double kWall = 0.0059;
constexpr double kLength = 0.2;
constexpr int kSides = 96;
constexpr double kError = 0.001;
constexpr double kExternal = 0.1;
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
                            .max_error = kError};
    row.reachable = uncovered_share(place_external_spheres(pipe, options), kCellsAlong);
    options.placement = ExternalPlacement::kRandom;
    row.random = uncovered_share(place_external_spheres(pipe, options), kCellsAlong);
    rows.push_back(row);
  }
  return rows;
}

FitCourse bounding_course() {
  const TriangleMesh pipe = make_paper_pipe();
  const ExternalSpheres external =
      place_external_spheres(pipe, {.min_external_diameter = kExternal, .max_error = kError});
  const CoverOptions options{.method = CoverMethod::kPaper, .max_error = kError, .history = true};
  SphereCover result = cover(pipe, external, options);
  return {"bounding", std::move(result.history), std::move(result.spheres)};
}

FitCourse packing_course() {
  // Nothing of the pipe is narrower than a quarter of its bore.
  SpherePacking result = pack_spheres(
      make_paper_pipe(), {.max_error = kError, .closed_below = 0.25 * kPaperBore, .history = true});
  return {"packing", std::move(result.history), std::move(result.inflated)};
}

}  // namespace spherule
