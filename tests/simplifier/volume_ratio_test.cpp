// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/proof/protrusion.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

constexpr double kSphere = 4.0 / 3.0 * std::numbers::pi;

double ratio(const TriangleMesh& mesh, const std::vector<Sphere>& spheres) {
  return internal::estimate_volume_ratio(mesh, spheres).value();
}

TEST(VolumeRatio, WhatSeveralSpheresHoldCountsOnce) {
  const TriangleMesh cube = cube_mesh();
  const Sphere sphere{Vector3d::Constant(0.5), 1.0};
  EXPECT_NEAR(ratio(cube, {sphere}), kSphere, 0.01 * kSphere);
  EXPECT_NEAR(ratio(cube, {sphere, sphere}), kSphere, 0.01 * kSphere);
  // Two unit spheres whose centres are 1 apart share a lens of 5 pi / 12.
  const double both = 2.0 * kSphere - 5.0 * std::numbers::pi / 12.0;
  EXPECT_NEAR(ratio(cube, {sphere, {sphere.center + Vector3d::UnitX(), 1.0}}), both, 0.01 * both);
}

TEST(VolumeRatio, OverlapsOfTheMeshCountOnceAndHollowsNot) {
  const std::vector<Sphere> sphere{{Vector3d::Zero(), 1.0}};
  const TriangleMesh cube = cube_mesh();
  const TriangleMesh overlapping =
      joined(cube, box_mesh(Vector3d(0.5, 0.0, 0.0), Vector3d(1.5, 1.0, 1.0)));
  EXPECT_NEAR(kSphere / ratio(overlapping, sphere), 1.5, 0.015);
  EXPECT_NEAR(kSphere / ratio(inverted(cube), sphere), 1.0, 0.01);
  const TriangleMesh hollow =
      joined(cube, inverted(box_mesh(Vector3d::Constant(0.25), Vector3d::Constant(0.75))));
  EXPECT_NEAR(kSphere / ratio(hollow, sphere), 0.875, 0.009);
}

TEST(VolumeRatio, ThinPlatesAndPipesInAnyDirection) {
  const std::vector<Sphere> sphere{{Vector3d::Zero(), 1.0}};
  for (int axis = 0; axis < 3; ++axis) {
    Vector3d size(4.0, 3.0, 2.0);
    size[axis] = 0.01;
    const TriangleMesh plate = box_mesh(Vector3d::Zero(), size);
    EXPECT_NEAR(kSphere / ratio(plate, sphere), size.prod(), 0.01 * size.prod()) << axis;
  }
  const double ring = 60.0 * std::sin(2.0 * std::numbers::pi / 60.0) / 2.0 * (1.0 - 0.9 * 0.9);
  EXPECT_NEAR(kSphere / ratio(pipe(1.0, 0.9, 10.0, 60), sphere), 10.0 * ring, 0.02 * 10.0 * ring);
}

// Two grains 100 apart, between which the lines pass, and a sheet of two faces.
TEST(VolumeRatio, IsAbsentWhereNothingIsMet) {
  const TriangleMesh grain = box_mesh(Vector3d::Zero(), Vector3d::Constant(0.001));
  const TriangleMesh grains =
      joined(grain, box_mesh(Vector3d(100.0, 0.0, 0.0), Vector3d(100.001, 0.001, 0.001)));
  const std::vector<Sphere> around{{Vector3d(50.0, 0.0, 0.0), 51.0}};
  EXPECT_EQ(internal::estimate_volume_ratio(grains, around), std::nullopt);
  const std::vector<Sphere> far_apart{{Vector3d::Zero(), 0.001},
                                      {Vector3d::Constant(100.0), 0.001}};
  EXPECT_EQ(internal::estimate_volume_ratio(cube_mesh(), far_apart), std::nullopt);
  const TriangleMesh sheet{.vertices = {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()},
                           .triangles = {{0, 1, 2}, {0, 2, 1}}};
  EXPECT_EQ(internal::estimate_volume_ratio(sheet, around), std::nullopt);
}

// Without external spheres S is the box.
TEST(FilledVolume, IsWhatTheSolidHasMoreThanTheMesh) {
  const TriangleMesh cube = cube_mesh();
  ExternalSpheres external;
  external.box = {Vector3d::Constant(-1.0), Vector3d::Constant(2.0)};
  const auto filled = [&](const TriangleMesh& mesh) {
    return internal::estimate_filled_volume(mesh, external);
  };
  EXPECT_NEAR(filled(cube).volume, 26.0, 0.1);
  EXPECT_LT(std::abs(filled(cube).volume - 26.0), 4.0 * filled(cube).error + 1e-9);
  EXPECT_NEAR(filled(inverted(cube)).volume, 26.0, 0.1);
  // A sphere that touches the cube, cut by the box on one side, and twice the same.
  external.spheres = {{Vector3d(1.75, 0.5, 0.5), 0.75}, {Vector3d(1.75, 0.5, 0.5), 0.75}};
  const double height = 0.5;  // of the cap that is cut off
  const double cut = std::numbers::pi * height * height * (3.0 * 0.75 - height) / 3.0;
  const double sphere = kSphere * 0.75 * 0.75 * 0.75 - cut;
  EXPECT_NEAR(filled(cube).volume, 26.0 - sphere, 0.1);
}

}  // namespace
}  // namespace spherule::test
