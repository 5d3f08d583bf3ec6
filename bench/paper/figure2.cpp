// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/figure2.h"

#include "base/error.h"
#include "bench/baseline/sphere_packing.h"
#include "bench/fit_parts.h"
#include "simplifier/simplify.h"
#include "tests/support/solids.h"

#include <cstdio>
#include <utility>

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

}  // namespace spherule
