// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/figures.h"

#include "base/error.h"
#include "bench/baseline/sphere_methods.h"
#include "bench/studies/fit_parts.h"
#include "simplifier/simplify.h"
#include "tests/support/shapes.h"
#include "tests/support/solids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <utility>
#include <vector>

namespace spherule {
namespace {

constexpr double kError = 0.012;
constexpr double kExternal = 0.030;

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
  SpherePacking packing = pack_spheres(part, {.max_error = kError});
  const Certificate proof =
      certify(part, packing.inflated, {.external = &packing.solid, .volume = false});
  if (!proof.covered || *proof.protrusion_over_simplified_max > kError) {
    throw Error("figure 2", "the packing does not cover within the error");
  }
  return {"packing", std::move(packing.inflated), *proof.protrusion_over_simplified_max};
}

Figure2::Fit bounding(const TriangleMesh& part, const char* name, CoverMethod method) {
  Simplification result =
      simplify(part, {.max_error = kError, .min_external_diameter = kExternal, .method = method});
  check_promises(result, "figure 2");
  return {name, std::move(result.cover.spheres),
          *result.certificate.protrusion_over_simplified_max};
}

}  // namespace

Figure2 figure_2() {
  Figure2 figure{slotted_block(), kError, kExternal, {}};
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
    row.reachable = uncovered_share(place_external_spheres(pipe, options), kCellsAlong);
    options.placement = ExternalPlacement::kRandom;
    row.random = uncovered_share(place_external_spheres(pipe, options), kCellsAlong);
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

}  // namespace spherule
