// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/mesh_deviation.h"

#include "base/error.h"
#include "tests/support/exact/shapes.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

void expect_holds(const Bounds& bounds, double exact, double tolerance) {
  EXPECT_LE(bounds.lower, exact + 1e-12);
  EXPECT_GE(bounds.upper, exact - 1e-12);
  EXPECT_LE(bounds.upper - bounds.lower, tolerance + 1e-12);
}

TEST(MeshDeviation, AMeshDoesNotDeviateFromItself) {
  for (const TriangleMesh& mesh : {cube_mesh(), torus(1.0, 0.3, 16, 8), open_box()}) {
    const MeshDeviation d = measure_deviation(mesh, mesh);
    expect_holds(d.loss, 0.0, 1e-3 * 4.0);
    expect_holds(d.excess, 0.0, 1e-3 * 4.0);
  }
}

TEST(MeshDeviation, BoxesWithKnownDistances) {
  const TriangleMesh small = box_mesh({0, 0, 0}, {1, 1, 1});
  const TriangleMesh large = box_mesh({-1, -2, -2}, {1, 1, 1});
  const double tolerance = 1e-3 * large.vertices.front().norm() * 4.0;
  const MeshDeviation d = measure_deviation(small, large);
  expect_holds(d.loss, 0.0, tolerance);
  expect_holds(d.excess, 3.0, tolerance);  // from (-1, -2, -2) to the origin
  const MeshDeviation back = measure_deviation(large, small);
  expect_holds(back.loss, 3.0, tolerance);
  expect_holds(back.excess, 0.0, tolerance);
}

// The farthest point stands inside a triangle, at no vertex.
TEST(MeshDeviation, AFarthestPointInsideATriangleIsFound) {
  // Two boxes at the ends of a longer one: its middle is farthest from both.
  const TriangleMesh bar = box_mesh({0, 0, 0}, {10, 1, 1});
  const TriangleMesh ends = joined(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({9, 0, 0}, {10, 1, 1}));
  const MeshDeviation d = measure_deviation(bar, ends);
  expect_holds(d.loss, 4.0, 1e-3 * 11.0);
  expect_holds(d.excess, 0.0, 1e-3 * 11.0);
}

// An open original has no inside to hide in.
TEST(MeshDeviation, OnlyClosedMeshesHaveAnInside) {
  const TriangleMesh inner = box_mesh({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6});
  expect_holds(measure_deviation(inner, cube_mesh()).loss, 0.0, 1e-3 * 2.0);
  const MeshDeviation d = measure_deviation(inner, open_box());
  EXPECT_GT(d.loss.lower, 0.05);
}

TEST(MeshDeviation, NoSampleIsFartherThanTheBound) {
  Random random(81);
  const TriangleMesh mesh = torus(1.0, 0.4, 14, 9);
  const TriangleMesh other =
      moved(icosphere(1), Eigen::Isometry3d(Eigen::Translation3d(0.7, 0, 0)));
  const MeshDeviation d = measure_deviation(mesh, other);
  EXPECT_LE(d.loss.upper - d.loss.lower, 1e-3 * 5.0);
  double farthest = 0.0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3i& t = mesh.triangles[random.index(mesh.triangles.size())];
    double u = random.unit(), v = random.unit();
    if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
    const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    const Vector3d p = corner(0) + u * (corner(1) - corner(0)) + v * (corner(2) - corner(0));
    if ((p - Vector3d(0.7, 0, 0)).norm() < 1.0) continue;  // inside, or less than 0.1 away
    farthest = std::max(farthest, static_cast<double>(exact_mesh_distance(p, other)));
  }
  EXPECT_LE(farthest, d.loss.upper + 1e-12);
  EXPECT_GE(farthest, 0.8 * d.loss.lower);  // the samples are not far from the truth
}

TEST(MeshDeviation, ALimitOfPiecesLeavesHonestBounds) {
  const TriangleMesh bar = box_mesh({0, 0, 0}, {10, 1, 1});
  const TriangleMesh ends = joined(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({9, 0, 0}, {10, 1, 1}));
  const MeshDeviation d = measure_deviation(bar, ends, {.tolerance = 1e-5, .most_pieces = 40});
  EXPECT_LE(d.loss.lower, 4.0);
  EXPECT_GE(d.loss.upper, 4.0);
  EXPECT_GT(d.loss.upper - d.loss.lower, 1e-3);
}

TEST(MeshDeviation, BadInputIsRefused) {
  EXPECT_THROW(measure_deviation(TriangleMesh{}, cube_mesh()), Error);
  EXPECT_THROW(measure_deviation(cube_mesh(), TriangleMesh{}), Error);
  EXPECT_THROW(measure_deviation(cube_mesh(), cube_mesh(), {.tolerance = 0.0}), Error);
  EXPECT_THROW(measure_deviation(cube_mesh(), cube_mesh(), {.tolerance = std::nan("")}), Error);
}

}  // namespace
}  // namespace spherule::test
