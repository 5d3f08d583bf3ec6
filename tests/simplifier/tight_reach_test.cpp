// SPDX-License-Identifier: BSD-3-Clause
// What is wider than D by the closing slack is open: chambers behind ways whose width is known, and
// places among random blocks to which a finer flood of exact distances gets.
#include "base/error.h"
#include "simplifier/simplify.h"
#include "tests/simplifier/fine_flood.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace spherule::test::tight_reach_test {
namespace {

using Eigen::Vector3d;

constexpr double kDiameter = 1.0;

// A closed chamber of the inner half-widths 1.2, its walls 0.2 thick, with a square way in of the
// given width and length through the wall at x = 1.2: a sphere gets in exactly if it is no wider.
TriangleMesh chamber(double width, double length) {
  constexpr double kHalf = 1.2;
  constexpr double kOuter = kHalf + 0.2;
  const double half = width / 2.0;
  TriangleMesh mesh = box_mesh({-kOuter, -kOuter, -kOuter}, {-kHalf, kOuter, kOuter});
  const auto add = [&](const Vector3d& low, const Vector3d& high) {
    mesh = joined(mesh, box_mesh(low, high));
  };
  add({-kHalf, -kOuter, -kOuter}, {kHalf, -kHalf, kOuter});
  add({-kHalf, kHalf, -kOuter}, {kHalf, kOuter, kOuter});
  add({-kHalf, -kHalf, -kOuter}, {kHalf, kHalf, -kHalf});
  add({-kHalf, -kHalf, kHalf}, {kHalf, kHalf, kOuter});
  // Around the way.
  add({kHalf, -kOuter, -kOuter}, {kHalf + length, -half, kOuter});
  add({kHalf, half, -kOuter}, {kHalf + length, kOuter, kOuter});
  add({kHalf, -half, -kOuter}, {kHalf + length, half, -half});
  add({kHalf, -half, half}, {kHalf + length, half, kOuter});
  return mesh;
}

// Grids of other steps, and what is queried of them.
ExternalOptions options_for(double step, double tightness) {
  ExternalOptions options;
  options.min_external_diameter = kDiameter;
  options.grid_step = step;
  options.tightness = tightness;
  return options;
}

TEST(TightReach, AChamberIsOpenExactlyIfItsWayIsWideEnough) {
  Random random(71);
  for (int n = 0; n < effort(12, 2); ++n) {
    const double step = n % 3 == 0 ? 0.125 : n % 3 == 1 ? 0.1 : 0.07;
    const double tightness = n % 4 == 0 ? 0.01 : 0.03;
    const double length = n % 2 == 0 ? 0.02 : random.between(0.02, 1.5);
    const Eigen::Isometry3d pose = random_pose(random);
    const Vector3d inside = pose.translation();
    const ExternalOptions options = options_for(step, tightness);
    const auto placed = [&](double width) {
      return place_external_spheres(moved(chamber(width, length), pose), options);
    };
    const ExternalSpheres wide = placed(kDiameter * (1.0 + tightness) + 1e-9);
    EXPECT_LE(wide.closing_slack, tightness * kDiameter * (1.0 + 1e-12));
    EXPECT_FALSE(is_in_solid(inside, wide)) << n;
    EXPECT_TRUE(is_in_solid(inside, placed(kDiameter * (1.0 - 1e-9)))) << n;
  }
}

// The grid alone leaves such a chamber closed.
TEST(TightReach, TheGridAloneIsNotTight) {
  Random random(72);
  int closed = 0;
  for (int n = 0; n < effort(6, 2); ++n) {
    const Eigen::Isometry3d pose = random_pose(random);
    const ExternalSpheres external = place_external_spheres(
        moved(chamber(1.03, 0.5), pose), options_for(0.125, ExternalOptions::kNoTightness));
    EXPECT_NEAR(external.closing_slack, 2.7322 * 0.125, 1e-3);
    closed += is_in_solid(pose.translation(), external) ? 1 : 0;
  }
  EXPECT_GT(closed, 0);
}

// Every place lies in a sphere whose centre is within 2.6 steps, or of what its radius is above D
// / 2.
TEST(TightReach, NoPlaceAmongBlocksIsLost) {
  Random random(73);
  std::size_t narrow = 0;
  for (int n = 0; n < effort(2, 1); ++n) {
    const TriangleMesh mesh = random_blocks(random);
    const ExternalOptions options = options_for(0.12, 0.03);
    const ExternalSpheres external = place_external_spheres(mesh, options);
    ASSERT_LE(external.closing_slack, 0.03 * (1.0 + 1e-12));
    const double radius = 0.5 * (kDiameter + external.closing_slack);
    FineFlood(mesh, external.box, kSanitized ? 0.2 : 0.1, radius, [&](const Vector3d&) {
      return radius;
    }).for_each_reached([&](const Vector3d& place) {
      if (external.box.exteriorDistance(place) > 0.0) return;
      ++narrow;
      const bool is_near = std::ranges::any_of(external.spheres, [&](const Sphere& sphere) {
        const double distance = (sphere.center - place).norm();
        return distance < sphere.radius && distance <= 2.6 * std::max(0.12, sphere.radius - 0.5);
      });
      ASSERT_TRUE(is_near);
    });
  }
  EXPECT_GT(narrow, 30U);
}

TEST(TightReach, BadTightnessIsRefused) {
  for (const double tightness : {0.0, -1.0, 11.0, std::nan("")}) {
    EXPECT_THROW(place_external_spheres(cube_mesh(), options_for(0.1, tightness)), Error);
  }
}

}  // namespace
}  // namespace spherule::test::tight_reach_test
