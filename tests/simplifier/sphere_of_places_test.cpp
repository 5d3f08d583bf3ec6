// SPDX-License-Identifier: BSD-3-Clause
// Large spheres that stand for the finest cells beside flat and convex surfaces.
#include "simplifier/stage1/flood_refinement.h"
#include "simplifier/simplify.h"
#include "tests/simplifier/judge.h"
#include "tests/simplifier/sphere_hash.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace spherule::test::sphere_of_places_test {
namespace {

using Eigen::Vector3d;
using internal::PlaceCell;

Vector3d corner_of_unit(int k) {
  return {(k & 1) != 0 ? 1.0 : -1.0, (k & 2) != 0 ? 1.0 : -1.0, (k & 4) != 0 ? 1.0 : -1.0};
}

// Points of a cell: its corners, and random ones.
std::vector<Vector3d> points_of(const PlaceCell& cell, Random& random) {
  std::vector<Vector3d> points;
  const auto& [center, half] = cell.box;
  for (int k = 0; k < 8; ++k) points.push_back(center + half[0] * corner_of_unit(k));
  const Eigen::AlignedBox3d box(center - half, center + half);
  for (int n = 0; n < 40; ++n) {
    points.push_back(random.in_box(box));
  }
  return points;
}

// The sphere is free of the padded mesh, and holds every place of its cell.
TEST(SphereOfPlaces, HoldsEveryPlaceOfTheCellAndIsFree) {
  Random random(81);
  std::size_t found = 0;
  std::size_t places = 0;
  for (const NamedMesh& named : zoo_to_fit()) {
    SCOPED_TRACE(named.name);
    const MeshDistance distance(named.mesh);
    for (int n = 0; n < effort(400, 100); ++n) {
      const double rho = random.between(0.02, 0.2);
      const double padding = n % 2 == 0 ? 0.0 : random.between(0.0, 0.5) * rho;
      const double half_edge = random.between(0.1, 0.5) * rho;
      const Vector3d start = named.mesh.vertices[random.index(named.mesh.vertices.size())] +
                             random.between(0.0, 0.5) * random.direction();
      const SurfaceDistance nearest = distance(start);
      const Vector3d away = (start - nearest.closest).normalized();
      if (!away.allFinite()) continue;
      const Vector3d center = nearest.closest + random.between(0.4, 1.6) * rho * away;
      const PlaceCell cell{.box = {center, Vector3d::Constant(half_edge)},
                           .rho = rho,
                           .step = 2.0 * half_edge / (n % 3 == 0 ? 4.0 : 2.0),
                           .surface_at_most = distance(center).upper};
      const auto wanted = internal::wanted_sphere(distance, padding, cell);
      if (!wanted) continue;
      const std::optional<Sphere> sphere =
          internal::sphere_of_places(distance, padding, cell, *wanted);
      if (!sphere) continue;
      ++found;
      ASSERT_GE(sphere->radius, rho);
      ASSERT_LE(static_cast<Real>(sphere->radius) + padding,
                judged_mesh_distance(sphere->center, named.mesh) * (1.0L + 1e-15L));
      for (const Vector3d& point : points_of(cell, random)) {
        if (judged_mesh_distance(point, named.mesh) < static_cast<Real>(rho) + padding) continue;
        ++places;
        ASSERT_LE(judged_distance(point, sphere->center),
                  static_cast<Real>(sphere->radius) * (1.0L + 1e-15L));
      }
    }
  }
  EXPECT_GT(found, effort(100U, 20U));
  EXPECT_GT(places, effort(2000U, 400U));
}

// Small triangles at the origin and where the surface is sampled beside it, and nothing between: in
// a cell of half edge rho the corners are places, and below the sphere.
TEST(SphereOfPlaces, ACellWithPlacesBelowTheSphereHasNone) {
  for (const double half_edge : {0.6, 1.0}) {
    TriangleMesh mesh;
    const double aside = std::sqrt(2.0) * half_edge;
    for (const Vector3d& at : {Vector3d(0, 0, 0), Vector3d(aside, 0, 0), Vector3d(-aside, 0, 0),
                               Vector3d(0, aside, 0), Vector3d(0, -aside, 0)}) {
      const int first = static_cast<int>(mesh.vertices.size());
      mesh.triangles.push_back({first, first + 1, first + 2});
      for (const Vector3d& corner :
           {Vector3d(-0.02, -0.02, 0), Vector3d(0.03, -0.02, 0), Vector3d(-0.02, 0.03, 0)}) {
        mesh.vertices.push_back(at + corner);
      }
    }
    const MeshDistance distance(mesh);
    const PlaceCell cell{.box = {{0, 0, half_edge}, Vector3d::Constant(half_edge)},
                         .rho = 1.0,
                         .step = half_edge / 2.0,
                         .surface_at_most = half_edge};
    const auto wanted = internal::wanted_sphere(distance, 0.0, cell);
    const bool is_held = half_edge < 0.7;
    ASSERT_EQ(wanted.has_value(), is_held);
    if (!is_held) continue;
    EXPECT_TRUE(internal::sphere_of_places(distance, 0.0, cell, *wanted));
  }
}

constexpr double kDiameter = 0.05;
constexpr double kMaxError = 0.0125;

ExternalSpheres placed(const TriangleMesh& mesh) {
  return place_external_spheres(mesh, {.min_external_diameter = kDiameter, .max_error = kMaxError});
}

// A turned cube of side 1, whose faces are none of its box.
Eigen::Isometry3d turn() {
  return Eigen::Isometry3d(Eigen::AngleAxisd(0.5, Vector3d(1, 2, 3).normalized()));
}
TriangleMesh turned_cube() {
  return moved(cube_mesh(), turn());
}

// As many cells as a uniform grid takes for three layers beside the cube, instead of some seven.
TEST(SphereOfPlaces, FewCellsAndSpheresAreNeededBesideFlatFaces) {
  const ExternalSpheres external = placed(turned_cube());
  const double one_layer = 6.0 / (external.grid_step * external.grid_step);
  EXPECT_LT(static_cast<double>(external.nodes_examined), 3.0 * one_layer);
  EXPECT_LT(static_cast<double>(external.spheres.size()), one_layer);
}

// Near a face, S ends where it does with the finest cells.
TEST(SphereOfPlaces, TheyLeaveNoHigherScallops) {
  Random random(82);
  const ExternalSpheres external = placed(turned_cube());
  const Vector3d normal = turn().linear() * Vector3d::UnitZ();
  double highest = 0.0;
  for (int n = 0; n < effort(400, 50); ++n) {
    const Vector3d on_face(random.between(0.1, 0.9), random.between(0.1, 0.9), 1.0);
    const Vector3d foot = turn() * on_face;
    double height = 0.0;
    while (is_in_solid(foot + height * normal, external)) height += 0.002 * kMaxError;
    highest = std::max(highest, height);
  }
  EXPECT_LT(highest, 0.032 * kMaxError);
}

// The mesh that is its own box: nothing is taken from it, and nothing has to be kept for it.
TEST(SphereOfPlaces, ABoxNeedsNoExternalSpheres) {
  for (const Vector3d& at : {Vector3d(0, 0, 0), Vector3d(0.1, 1e3, -1e3)}) {
    const ExternalSpheres external = placed(box_mesh(at, at + Vector3d(1.0, 0.7, 0.3)));
    EXPECT_TRUE(external.spheres.empty());
    EXPECT_LE(external.closing_slack, 0.03 * kDiameter * (1.0 + 1e-12));
  }
}

// A ball that is closed takes fewer cells than with a way in.
TEST(SphereOfPlaces, TheInsideOfAClosedPartIsNotHalved) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const TriangleMesh closed = icosphere(2);
  TriangleMesh open = closed;
  open.triangles.pop_back();
  const auto examined = [](const TriangleMesh& mesh) {
    const ExternalOptions options{.min_external_diameter = 0.1, .max_error = 0.025};
    return static_cast<double>(place_external_spheres(mesh, options).nodes_examined);
  };
  EXPECT_LT(examined(closed), 0.8 * examined(open));
}

// With own spheres in it too, where no finer cells are requested.
TEST(SphereOfPlaces, TheSlackOfTheGridAsItIsIsProved) {
  ExternalOptions options{.min_external_diameter = kDiameter, .max_error = kMaxError};
  options.tightness = ExternalOptions::kNoTightness;
  const ExternalSpheres external = place_external_spheres(turned_cube(), options);
  EXPECT_LT(external.closing_slack, 2.7322 * external.grid_step * (1.0 + 1e-9));
  EXPECT_LT(static_cast<double>(external.spheres.size()),
            6.0 / (external.grid_step * external.grid_step));
}

// The large sphere in front of a zone needs more room on its way than in the zone.
TEST(SphereOfPlaces, AZoneThatNothingReachesEndsTheSearch) {
  ExternalOptions options{.min_external_diameter = 1.0, .max_error = 0.1};
  options.zones = {{.shape = Sphere{{3.03, 3.01, 1.02}, 0.46}, .min_external_diameter = 0.25}};
  const ExternalSpheres external = place_external_spheres(box_mesh({0, 0, 0}, {6, 6, 1}), options);
  EXPECT_LE(external.closing_slack, 0.03 * (1.0 + 1e-12));
}

// Equal bits on every machine and any number of threads (G7). The corners are exact.
TEST(SphereOfPlaces, AreEqualEverywhere) {
  const TriangleMesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                 {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
  ExternalOptions options{.min_external_diameter = kDiameter, .max_error = kMaxError};
  for (const int threads : {1, 4}) {
    options.threads = threads;
    const std::uint64_t hash = hash_of(place_external_spheres(tetrahedron, options).spheres);
    EXPECT_EQ(hash, 0x01bca525a8fe7f5dU) << "0x" << std::hex << hash;
  }
}

}  // namespace
}  // namespace spherule::test::sphere_of_places_test
