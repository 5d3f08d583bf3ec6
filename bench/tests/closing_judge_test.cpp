// SPDX-License-Identifier: BSD-3-Clause
// The judge of closings on shapes whose closing is known, and what it says of stage 1's spheres.
#include "bench/closing/closed_solid.h"
#include "bench/closing/protrusion_judge.h"
#include "simplifier/simplify.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace spherule::test {
namespace {

using closing::JudgedProtrusion;
using closing::JudgeOptions;
using Eigen::Vector3d;

// Small grids.
JudgeOptions quick(double step) {
  return {.step = step,
          .most_nodes = 400'000,
          .rounds = 2,
          .most_nodes_examined = 200'000,
          .tolerance = 0.0};
}

TEST(ClosingJudge, TransformsDistancesAsBruteForceDoes) {
  Random random(3);
  const closing::Grid grid{.origin = Vector3d::Zero(), .step = 1.0, .count = {9, 7, 8}};
  std::vector<float> heights(grid.size(), closing::kFar);
  for (int n = 0; n < 12; ++n) {
    heights[random.index(grid.size())] = static_cast<float>(-random.between(0.0, 9.0));
  }
  std::vector<float> transformed = heights;
  closing::transform_distances(grid, transformed);
  for (std::size_t z = 0; z < grid.size(); ++z) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t x = 0; x < grid.size(); ++x) {
      if (heights[x] >= closing::kFar) continue;
      least = std::min(least, (grid.point(z) - grid.point(x)).squaredNorm() + heights[x]);
    }
    ASSERT_NEAR(transformed[z], least, 1e-4);
  }
}

// Above the middle of a face a sphere stands out by as much as it is higher.
TEST(ClosingJudge, HoldsTheHeightAboveAFace) {
  const std::vector<Sphere> spheres{{Vector3d(0.5, 0.5, 0.9), 0.3}};
  const JudgedProtrusion judged =
      closing::judge_protrusion_from_closing(cube_mesh(), spheres, 0.5, quick(0.05));
  EXPECT_LE(judged.lower, 0.2);
  EXPECT_GE(judged.upper, 0.2);
  EXPECT_LT(judged.upper - judged.lower, 0.1);
}

// A slot between two blocks is a part of the solid exactly if it is narrower than D.
TEST(ClosingJudge, KnowsWhetherASlotIsClosed) {
  const double width = 0.4;
  const TriangleMesh mesh =
      joined(box_mesh(Vector3d(-1.0, -1.0, -1.0), Vector3d(0.0, 1.0, 1.0)),
             box_mesh(Vector3d(width, -1.0, -1.0), Vector3d(width + 1.0, 1.0, 1.0)));
  // From wall to wall.
  const std::vector<Sphere> spheres{{Vector3d(width / 2.0, 0.0, 0.0), width / 2.0}};
  const JudgedProtrusion closed =
      closing::judge_protrusion_from_closing(mesh, spheres, 1.15 * width, quick(0.015));
  EXPECT_LT(closed.upper, 0.06);
  const JudgedProtrusion open =
      closing::judge_protrusion_from_closing(mesh, spheres, 0.85 * width, quick(0.015));
  EXPECT_LE(open.lower, width / 2.0);
  EXPECT_GE(open.upper, width / 2.0);
  EXPECT_GT(open.lower, 0.14);
}

// Spheres of a fit are within E of the solid closed at D and the slack, and 3 % of D more.
TEST(ClosingJudge, AgreesWithWhatAFitPromises) {
  const TriangleMesh mesh = pipe(1.0, 0.7, 2.0, effort(24, 12));
  SimplifyOptions options;
  options.max_error = 0.2;
  options.min_external_diameter = 0.8;
  options.effort = 0;
  const Simplification fit = simplify(mesh, options);
  const double d = options.min_external_diameter;
  const JudgedProtrusion judged = closing::judge_protrusion_from_closing(
      mesh, fit.cover.spheres, d + fit.external.closing_slack, quick(0.04));
  EXPECT_LE(judged.lower, options.max_error + 0.03 * d);
  EXPECT_GT(judged.upper, 0.5 * options.max_error);
  EXPECT_LE(judged.lower, judged.upper);
}

}  // namespace
}  // namespace spherule::test
