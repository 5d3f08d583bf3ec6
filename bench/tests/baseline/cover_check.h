// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/mesh_distance.h"
#include "geometry/triangle_mesh.h"
#include "simplifier/simplify.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace spherule::test {

// The mesh a sixteenth as thick. certify() finds what is inside by a flood whose cells are a share
// of the diagonal: quick where the box is long and thin, and no less telling.
inline TriangleMesh slender(TriangleMesh mesh) {
  for (Eigen::Vector3d& v : mesh.vertices) v = v.cwiseProduct(Eigen::Vector3d(1.0, 0.0625, 0.0625));
  return mesh;
}

inline TriangleMesh moved_far(const TriangleMesh& mesh, double offset) {
  return moved(mesh, Eigen::Isometry3d(Eigen::Translation3d(offset, -offset / 3.0, 0.0)));
}

// Of points on the surface and, if the mesh is closed, inside, none is outside of the spheres.
inline void expect_samples_covered(const TriangleMesh& mesh, std::span<const Sphere> spheres,
                                   Random& random) {
  const MeshDistance distance(mesh);
  std::vector<Eigen::Vector3d> points =
      points_on_surface(mesh, static_cast<std::size_t>(effort(2000, 200)), random);
  const bool closed = mesh_report(mesh, {.self_intersections = false}).closed;
  for (int i = 0; closed && i < effort(1000, 100); ++i) {
    const Eigen::Vector3d p = random.in_box(distance.box());
    if (std::abs(distance.winding_number(p)) > 0.5) points.push_back(p);
  }
  EXPECT_EQ(judge_cover(points, spheres).uncovered, 0U);
}

// Points as far from the surface as it was grown by, all but, are in the spheres.
inline void expect_inflated_covered(const TriangleMesh& mesh, double inflation, std::size_t count,
                                    std::span<const Sphere> spheres, std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& p : points_on_surface(mesh, count, random)) {
    points.push_back(p + inflation * random.direction());
  }
  EXPECT_EQ(judge_cover(points, spheres).uncovered, 0U);
}

// What a certificate can say of spheres around cubes, of which none protrudes by more than the
// error.
inline void expect_certified(const TriangleMesh& mesh, std::span<const Sphere> spheres,
                             double max_error) {
  const Certificate certificate =
      certify(mesh, spheres, {.resolution = 1.0 / 512.0, .volume = false});
  // A surface through the corners of cubes lies in no sphere with room to spare.
  EXPECT_LE(certificate.uncovered_depth.upper, 0.1 * max_error);
  EXPECT_EQ(certificate.uncovered_depth.lower, 0.0);
  EXPECT_LE(certificate.protrusion_over_mesh->lower, max_error);
}

}  // namespace spherule::test
