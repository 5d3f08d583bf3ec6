// SPDX-License-Identifier: BSD-3-Clause
#include "bench/paper/paper.h"

#include "base/error.h"
#include "bench/checkers/fcl_mesh_checker.h"
#include "tests/support/effort.h"
#include "tests/support/mesh_facts.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

// The paper's comparisons: what they count, and that conservative rows miss nothing.

namespace spherule {
namespace {

ExternalSpheres in_box(const Eigen::Vector3d& size, std::vector<Sphere> spheres) {
  ExternalSpheres external;
  external.box = {Eigen::Vector3d::Zero(), size};
  external.spheres = std::move(spheres);
  return external;
}

TEST(SpaceShare, IsTheVolumeThatNoSphereCovers) {
  const Eigen::Vector3d size(2.0, 3.0, 4.0);
  EXPECT_EQ(uncovered_share(in_box(size, {}), 100), 1.0);
  EXPECT_EQ(uncovered_share(in_box(size, {{{1.0, 1.5, 2.0}, 3.0}}), 100), 0.0);
  const double sphere = 4.0 / 3.0 * std::numbers::pi;
  EXPECT_NEAR(uncovered_share(in_box(size, {{{1.0, 1.5, 2.0}, 1.0}}), 200), 1.0 - sphere / 24,
              1e-3);
  // An eighth of one in a corner, counted once although it is there twice; one beside the box.
  EXPECT_NEAR(
      uncovered_share(in_box(size, {{{0, 0, 0}, 1.0}, {{0, 0, 0}, 1.0}, {{9, 9, 9}, 2.0}}), 200),
      1.0 - sphere / 8 / 24, 1e-3);
}

TEST(PaperPipe, ItsBoreIs145PercentOfItsMetal) {
  const double metal = signed_volume(make_paper_pipe());
  const double bore = std::numbers::pi * 0.25 * kPaperBore * kPaperBore *
                      bounding_box(make_paper_pipe()).sizes().maxCoeff();
  EXPECT_NEAR(bore / metal, 1.45, 0.04);
}

// A pipe's bore is open to spheres well below its diameter (by the slack of the flood's grid) and
// closed to those above it.
TEST(Figure3, TheStepIsAtTheBore) {
  const TriangleMesh pipe = make_paper_pipe();
  const auto share = [&](double diameter) {
    return uncovered_share(
        place_external_spheres(pipe, {.min_external_diameter = diameter, .max_error = 0.002}), 160);
  };
  EXPECT_GT(share(0.041) - share(0.034), 0.3);
}

Workload boxes_for(const TriangleMesh& mesh) {
  Workload cell = make_paper_cell();
  for (Obstacle& obstacle : cell.obstacles) {
    if (obstacle.part.name == "workpiece") obstacle.part.mesh = mesh;
  }
  return cell;
}

std::vector<std::uint8_t> verdicts(Checker& checker, const std::vector<ArmPositions>& sample) {
  std::vector<std::uint8_t> result(sample.size());
  checker.check(sample, result);
  return result;
}

// Two boxes, as convex parts and as one mesh: the same surfaces, and the same answers but where
// something is wholly within, which meshes do not see.
TEST(FclConvexChecker, AnswersAsMeshesOfTheSameParts) {
  TriangleMesh left = make_box({0.1, 0.1, 0.08});
  TriangleMesh right = make_box({0.08, 0.2, 0.1});
  for (Eigen::Vector3d& vertex : left.vertices) vertex.x() -= 0.1;
  for (Eigen::Vector3d& vertex : right.vertices) vertex.x() += 0.1;
  TriangleMesh both = left;
  const int first = static_cast<int>(both.vertices.size());
  both.vertices.insert(both.vertices.end(), right.vertices.begin(), right.vertices.end());
  for (const Eigen::Vector3i& triangle : right.triangles) {
    both.triangles.emplace_back(triangle.array() + first);
  }
  const Workload cell = boxes_for(both);
  std::vector<ArmPositions> sample;
  for (std::size_t i = 0; i < cell.program.size(); i += 97) sample.push_back(cell.program[i]);
  const auto meshes = verdicts(*make_fcl_mesh_checker(cell, {}), sample);
  const auto parts = verdicts(*make_fcl_convex_checker(cell, 0, {left, right}), sample);
  std::size_t hits = 0;
  std::size_t within = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    EXPECT_GE(parts[i], meshes[i]) << i;
    hits += meshes[i];
    within += parts[i] > meshes[i] ? 1U : 0U;
  }
  EXPECT_GT(hits, 10U);
  EXPECT_LT(hits, sample.size() - 10);
  EXPECT_LT(within, hits);
  EXPECT_THROW(make_fcl_convex_checker(cell, 0, {}), Error);
}

// A bar, whose inside is found in less time than that of a cube. As many spheres about its middle
// as the reciprocal of the error, with the radius of the one around it, and the error and `more`
// beyond that. The one around it protrudes by kThroughCorners, beside the middle of a long side.
const Eigen::Vector3d kBarSize(1.0, 0.02, 0.02);
const double kHalfDiagonal = 0.5 * kBarSize.norm();
const double kThroughCorners = kHalfDiagonal - 0.01;
SphereMethod concentric(double more) {
  return {"concentric", [more](const TriangleMesh&, double error) {
            return std::vector<Sphere>(static_cast<std::size_t>(std::ceil(1.0 / error)),
                                       {Eigen::Vector3d::Zero(), kHalfDiagonal + more + error});
          }};
}

TEST(FewestSpheres, AreThoseOfAnErrorThatNearlyReachesTheLimit) {
  const double limit = kThroughCorners + 0.15;
  const CountEntry found = fewest_spheres(make_box(kBarSize), concentric(0.0), limit);
  EXPECT_EQ(found.method, "concentric");
  EXPECT_EQ(found.inflation, 0.0);
  EXPECT_LE(found.protrusion, limit);
  EXPECT_LE(found.setting, 0.15);
  EXPECT_GE(found.setting, 0.1);
  EXPECT_EQ(found.spheres, static_cast<std::size_t>(std::ceil(1.0 / found.setting)));
}

TEST(FewestSpheres, GrowUntilTheyCover) {
  if (test::kSanitized) GTEST_SKIP() << "takes a minute under sanitizers";
  const double limit = kThroughCorners + 0.1;
  const CountEntry found = fewest_spheres(make_box(kBarSize), concentric(-0.7), limit);
  EXPECT_GT(found.spheres, 0U);
  EXPECT_LE(found.protrusion, limit);
  EXPECT_LT(found.setting, 0.7);
  EXPECT_GE(found.inflation, 0.7 - found.setting);
}

TEST(FewestSpheres, AreNoneWhereNoSettingKeepsToTheLimit) {
  if (test::kSanitized) GTEST_SKIP() << "takes a minute under sanitizers";
  const CountEntry found = fewest_spheres(make_box(kBarSize), concentric(1.0), 0.1);
  EXPECT_EQ(found.spheres, 0U);
  EXPECT_GT(found.protrusion, 0.9);
}

TEST(SphereMethods, MakeMoreSpheresForASmallerError) {
  if (test::kSanitized) GTEST_SKIP() << "takes a minute under sanitizers";
  std::vector<std::string> names;
  const TriangleMesh cube = make_cube(1.0);
  for (const SphereMethod& method : sphere_methods()) {
    names.push_back(method.name);
    const std::size_t few = method.make(cube, 0.3).size();
    EXPECT_GT(few, 0U) << method.name;
    EXPECT_GT(method.make(cube, 0.12).size(), few) << method.name;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"packing", "openvdb", "voxels", "octree", "hubbard",
                                             "medial-axis", "paper", "cover-as-is", "cover"}));
}

TEST(Figure2, BoundingSpheresAreFewerThanPackedOnes) {
  if (test::kSanitized) GTEST_SKIP() << "takes a minute under sanitizers";
  const Figure2 figure = figure_2();
  ASSERT_EQ(figure.fits.size(), 3U);
  EXPECT_LT(figure.fits[1].spheres.size(), figure.fits[0].spheres.size());
  EXPECT_LT(figure.fits[2].spheres.size(), figure.fits[1].spheres.size());
  for (const Figure2::Fit& fit : figure.fits) {
    EXPECT_LE(fit.protrusion, figure.max_error * (1.0 + 1e-9)) << fit.method;
  }
}

}  // namespace
}  // namespace spherule
