// SPDX-License-Identifier: BSD-3-Clause
// What certify() says of sets whose leaks and protrusion are known, and what it refuses.
#include "geometry/mesh_distance.h"
#include "geometry/shells.h"
#include "geometry/weld.h"
#include "simplifier/proof/protrusion.h"
#include "simplifier/simplify.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/simplifier/octree_proof.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using Spheres = std::vector<Sphere>;

const double kRoot3 = std::numbers::sqrt3;
const Vector3d kMiddle = Vector3d::Constant(0.5);

// That the exact value is between the bounds, and each of them within `slack` of it.
void expect_bounds(const Bounds& bounds, double exact, double slack) {
  EXPECT_LE(bounds.lower, exact);
  EXPECT_GE(bounds.upper, exact);
  EXPECT_GE(bounds.lower, exact - slack);
  EXPECT_LE(bounds.upper, exact + slack);
}

// One sphere a cell of an n x n x n grid over the unit cube, of that share of the radius about the
// cell: a piece of surface that crosses from cell to cell has to fit into one of them.
Spheres grid_of_spheres(int n, double share = 1.01) {
  Spheres spheres;
  for (int i = 0; i < n * n * n; ++i) {
    const Vector3d cell(i % n, i / n % n, i / n / n);
    spheres.push_back({(cell + kMiddle) / n, kRoot3 / (2 * n) * share});
  }
  return spheres;
}

// The cells of the solid fit into the spheres; the piece of an inner triangle about the middle,
// where eight cells meet, fits into none however small it is.
TEST(Certificate, SurfaceThatCrossesWhereSpheresHardlyOverlapIsCoveredAsPartOfTheSolid) {
  TriangleMesh mesh = cube_mesh();
  const int first = static_cast<int>(mesh.vertices.size());
  const Vector3d a(0.1, 0.2, 0.3), b(0.9, 0.35, 0.6);
  mesh.vertices.insert(mesh.vertices.end(), {a, b, (kMiddle - 0.3 * a - 0.37 * b) / 0.33});
  mesh.triangles.push_back({first, first + 1, first + 2});
  const Spheres spheres = grid_of_spheres(4, 1 + 1e-9);
  ExternalSpheres external = box_of(mesh);
  EXPECT_TRUE(certify(mesh, spheres, {.external = &external}).covered);

  // Not if S does not hold the mesh: then nothing is proved of the rest of it.
  external.spheres.push_back({{0.5, 0.5, 0.5}, 0.3});
  const Certificate pierced = certify(mesh, spheres, {.external = &external});
  EXPECT_FALSE(pierced.covered);
  EXPECT_EQ(pierced.solid_depth.upper, 0.0);
  EXPECT_EQ(pierced.surface_depth.lower, 0.0);
  external.spheres.clear();
  external.box.max().x() = 0.75;
  EXPECT_FALSE(certify(mesh, spheres, {.external = &external}).covered);
}

TEST(Certificate, ACubeIsCoveredByItsCircumscribedSphereAndByNoSmallerOne) {
  const ExternalSpheres box = box_of(cube_mesh());
  // The flood without external spheres is fine, and slow under sanitizers.
  for (const ExternalSpheres* external :
       effort(std::vector<const ExternalSpheres*>{&box, nullptr}, 1)) {
    const auto certificate = [&](double radius) {
      return certify(cube_mesh(), Spheres{{kMiddle, radius}}, {.external = external});
    };
    EXPECT_TRUE(certificate(kRoot3 / 2 + 1e-9).covered);
    const Certificate leak = certificate(0.8);
    EXPECT_FALSE(leak.covered);
    expect_bounds(leak.surface_depth, kRoot3 / 2 - 0.8, 1e-9);
    EXPECT_EQ(leak.sphere_count, 1U);
    EXPECT_GT(leak.pieces, 0U);
    EXPECT_GT(leak.cells, 0U);
  }
}

// Without the sphere of one cell, the point of that cell that is furthest from the other spheres is
// known: the corner of the cube, or the middle of the cell, as far as its neighbours leave it.
TEST(Certificate, AMissingSphereIsALeakOfTheExactDepth) {
  const int n = 3;
  const ExternalSpheres box = box_of(cube_mesh());
  const auto of = [&](const Spheres& spheres) {
    return certify(cube_mesh(), spheres, {.external = &box});
  };
  const Spheres all = grid_of_spheres(n);
  const double radius = all.front().radius;
  EXPECT_TRUE(of(all).covered);

  // Spheres that only just meet: nothing is open, but that is not proved, and so not said.
  const Certificate unproved = of(grid_of_spheres(n, 1 + 1e-9));
  EXPECT_FALSE(unproved.covered);
  EXPECT_EQ(unproved.uncovered_depth.lower, 0.0);
  EXPECT_GT(unproved.uncovered_depth.upper, 0.0);

  Spheres hollow = all;
  hollow.erase(hollow.begin() + (n * n * n) / 2);
  const Certificate inner = of(hollow);
  EXPECT_FALSE(inner.covered);
  EXPECT_EQ(inner.surface_depth.upper, 0.0);
  // The middle of the middle cell, to the spheres of the cells beside it.
  expect_bounds(inner.solid_depth, 1.0 / n - radius, 5e-3);
  EXPECT_NEAR(inner.solid_depth.lower, 1.0 / n - radius, 1e-3);
  EXPECT_NEAR((inner.deepest_leak - kMiddle).norm(), 0.0, 0.01);

  const Certificate outer = of(Spheres(all.begin() + 1, all.end()));
  const double at_the_corner = Vector3d(1.5 / n, 0.5 / n, 0.5 / n).norm() - radius;
  expect_bounds(outer.uncovered_depth, at_the_corner, 1e-2);
  EXPECT_NEAR(outer.uncovered_depth.lower, at_the_corner, 5e-3);
  EXPECT_NEAR(outer.deepest_leak.norm(), 0.0, 0.02);
}

// Where spheres meet in a point of the surface, no piece of it is ever in one of them. The proof
// must come to an end however close it is told to look.
TEST(Certificate, TheSmallestResolutionIsThatOfTheCoordinates) {
  const ExternalSpheres box = box_of(cube_mesh());
  const Certificate unproved =
      certify(cube_mesh(), grid_of_spheres(3, 1 - 1e-15), {.external = &box, .resolution = 1e-300});
  EXPECT_FALSE(unproved.covered);
  EXPECT_GT(unproved.uncovered_depth.upper, 0.0);
  EXPECT_LT(unproved.uncovered_depth.upper, 1e-11);
}

// A sealed hollow is inside, whatever is in it: the spheres protrude as if the cube were solid. Nor
// does a part that is not closed take its closed neighbours' inside away.
TEST(Certificate, SpheresInASealedHollowDoNotProtrude) {
  const auto cube = [](double low, double high) {
    return box_mesh(Vector3d::Constant(low), Vector3d::Constant(high));
  };
  TriangleMesh sheet = cube(0.4, 0.6);
  sheet.triangles.resize(2);
  const TriangleMesh hollow = joined(cube_mesh(), inverted(cube(0.2, 0.8)));
  const Spheres spheres = grid_of_spheres(3);
  const double beyond_a_face = spheres.front().radius - 0.5 / 3;
  const ExternalSpheres box = box_of(cube_mesh());
  const std::vector<TriangleMesh> meshes = {joined(hollow, sheet), joined(hollow, cube(0.4, 0.6)),
                                            hollow, cube_mesh()};
  for (const TriangleMesh& mesh : effort(meshes, 1)) {
    const Certificate of_mesh =
        certify(mesh, spheres, {.external = &box, .protrusion_tolerance = 1e-3});
    const Bounds protrusion = of_mesh.protrusion_over_mesh.value();
    EXPECT_LE(protrusion.lower, beyond_a_face);
    EXPECT_GE(protrusion.upper, beyond_a_face);
    EXPECT_LT(protrusion.upper, 1.05 * beyond_a_face);
  }
}

// Spheres along the surface leave the inside open. The surface is covered, but |M| is not.
TEST(Certificate, AHollowSetIsNotACoverEvenWithoutExternalSpheres) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  // A bar: the flood is quick there.
  const TriangleMesh bar = box_mesh({0, 0, 0}, {1, 0.2, 0.2});
  const double radius = 0.04;
  Spheres spheres;
  for (int i = 0; i < 21 * 25; ++i) {
    const int x = i / 25, y = i / 5 % 5, z = i % 5;
    const bool inner = x % 20 != 0 && y % 4 != 0 && z % 4 != 0;
    if (!inner) spheres.push_back({Vector3d(x, y, z) / 20.0, radius});
  }
  // From the axis, half way between two rings of spheres.
  const double depth = std::hypot(0.1, 0.025) - radius;
  for (const TriangleMesh& mesh : {inverted(bar), bar}) {
    const Certificate certificate = certify(mesh, spheres);
    EXPECT_FALSE(certificate.covered);
    EXPECT_EQ(certificate.surface_depth.upper, 0.0);
    expect_bounds(certificate.solid_depth, depth, 0.002);
    EXPECT_NEAR(certificate.solid_depth.lower, depth, 0.001);
    const Vector3d& leak = certificate.deepest_leak;
    EXPECT_NEAR((leak - Vector3d(leak.x(), 0.1, 0.1)).norm(), 0.0, 0.01);
  }
  // Of a double-sided one nothing says that the middle is inside, but it cannot be reached.
  const TriangleMesh twice = with_duplicates(bar);
  const Certificate of_twice = certify(joined(twice, inverted(twice)), spheres);
  EXPECT_FALSE(of_twice.covered);
  EXPECT_NEAR(of_twice.solid_depth.upper, depth, 0.002);
  // An open one has no inside that its witness could be in, but what cannot be reached counts.
  TriangleMesh open = bar;
  open.triangles.resize(open.triangles.size() - 2);
  EXPECT_EQ(certify(open, spheres).surface_depth.upper, 0.0);
}

TEST(Certificate, TheProtrusionOfOneSphereAroundACubeIsExact) {
  const ExternalSpheres box = box_of(cube_mesh());
  const Certificate near = certify(cube_mesh(), Spheres{{kMiddle, 1.0}}, {.external = &box});
  EXPECT_TRUE(near.covered);
  // Above the middle of a face.
  expect_bounds(near.protrusion_over_mesh.value(), 0.5, 0.03);
  EXPECT_GE(near.protrusion_over_simplified_max.value(), 0.5);
  EXPECT_NEAR(*near.protrusion_over_simplified_max, 0.5, 1e-9);
  EXPECT_NEAR(near.volume_ratio.value(), 4.0 / 3.0 * std::numbers::pi, 0.05);
  // Far off, by its distance.
  const Certificate far =
      certify(cube_mesh(), Spheres{{kMiddle, 0.9}, {{4, 0.5, 0.5}, 0.25}}, {.external = &box});
  EXPECT_GE(far.protrusion_over_simplified_max.value(), 3.25);
  EXPECT_LE(*far.protrusion_over_simplified_max, 3.26);
  expect_bounds(far.protrusion_over_mesh.value(), 3.25, 0.15);
}

TEST(Certificate, AnEmptySetCoversNothing) {
  // The less room a box of the same diagonal has, the quicker the flood.
  const auto thin = [](TriangleMesh mesh) {
    for (Vector3d& v : mesh.vertices) v = v.cwiseProduct(Vector3d(1.0, 0.1, 0.1));
    return mesh;
  };
  for (const TriangleMesh& mesh :
       effort(std::vector{thin(cube_mesh()), thin(open_box()), thin(soup(5, 1))}, 1)) {
    const Certificate certificate =
        certify(mesh, {}, {.resolution = kSanitized ? 1.0 / 512.0 : CertifyOptions{}.resolution});
    EXPECT_FALSE(certificate.covered);
    EXPECT_EQ(certificate.uncovered_depth.upper, kInfinity);
    EXPECT_EQ(certificate.sphere_count, 0U);
    EXPECT_FALSE(record(certificate).covered);
  }
}

// A cube whose corners eight external spheres take: what remains is furthest from the middle where
// two of them and a face of the cube meet, at (1/2, y, 0) with 1/4 + y^2 = R^2.
TEST(Certificate, TheDepthOfALeakInACurvedSolidIsExact) {
  // A mesh in the middle, for which the cube is box enough.
  const TriangleMesh mesh = box_mesh(Vector3d::Constant(0.45), Vector3d::Constant(0.55));
  ExternalSpheres external = box_of(cube_mesh());
  for (const double taken : effort(std::vector{0.6, 0.55, 0.7}, 1)) {
    external.spheres.clear();
    for (int i = 0; i < 8; ++i) {
      external.spheres.push_back({Vector3d(i & 1, i >> 1 & 1, i >> 2 & 1), taken});
    }
    const double furthest = Vector3d(0.0, 0.5 - std::sqrt(taken * taken - 0.25), 0.5).norm();
    for (const double radius : {0.2, furthest - 0.01, furthest + 1e-3}) {
      SCOPED_TRACE(radius);
      const Certificate certificate =
          certify(mesh, Spheres{{kMiddle, radius}}, {.external = &external});
      const double depth = std::max(0.0, furthest - radius);
      EXPECT_EQ(certificate.covered, depth == 0.0);
      EXPECT_LE(certificate.solid_depth.lower, depth * (1.0 + 1e-12));
      EXPECT_GE(certificate.solid_depth.upper, depth * (1.0 - 1e-12));
      EXPECT_LE(certificate.solid_depth.upper - certificate.solid_depth.lower,
                0.04 * depth + 2e-3 * (depth > 0.0 ? 1.0 : 0.0));
    }
  }
}

// Sets that cover a part: some spheres of a fit, shrunk or left out at random. The octree's proof
// is one-sided as well: neither is content with a set that the other finds a leak in.
TEST(Certificate, TheBoundsOfTheDepthHoldAgainstSampling) {
  Random random(92);
  int leaks = 0;
  int proofs_of_leaks = 0;
  int proofs_of_covers = 0;
  for (const NamedMesh& named : zoo_to_fit()) {
    SCOPED_TRACE(named.name);
    const TriangleMesh& mesh = named.mesh;
    // The same D in both.
    const Fit fitted =
        fit(mesh, {.method = CoverMethod::kPaper},
            {.max_error = kSanitized ? 0.2 : 0.1, .diameter = kSanitized ? 2.0 : 4.0});
    const std::vector<Vector3d> surface = points_on_surface(mesh, samples(3000, 300), random);
    const std::vector<Vector3d> solid =
        points_of_solid(fitted.external, samples(3000, 300), random);
    for (int round = 0; round < 6; ++round) {
      const double share = std::pow(10.0, -1.0 - round / 2);
      Spheres spheres;
      for (const Sphere& s : fitted.cover.spheres) {
        if (round % 2 == 0 && random.unit() < share) continue;
        spheres.push_back({s.center, s.radius - random.between(0.0, share) * fitted.max_error});
      }
      if (spheres.empty()) continue;  // no set at all has no depth to compare
      const Certificate certificate = certificate_of(mesh, fitted, spheres);
      const Bounds& depth = certificate.uncovered_depth;
      const Judgement on_surface = judge_cover(surface, spheres);
      const Judgement in_solid = judge_cover(solid, spheres);
      ASSERT_GE(certificate.surface_depth.upper, on_surface.depth - 1e-15L);
      ASSERT_GE(certificate.solid_depth.upper, in_solid.depth);
      ASSERT_LE(depth.lower, depth.upper);
      const OctreeProof proof = prove_by_octree(fitted.external, spheres, 20, 60'000);
      if (proof.verdict == OctreeVerdict::kLeak) {
        ++proofs_of_leaks;
        ASSERT_FALSE(certificate.covered);
        ASSERT_TRUE(is_in_solid(proof.point, fitted.external));
        ASSERT_GT(gap_to_spheres(proof.point, spheres), 0.0L);
      }
      if (proof.verdict == OctreeVerdict::kCovered) {
        ++proofs_of_covers;
        ASSERT_EQ(certificate.solid_depth.lower, 0.0);
      }
      if (certificate.covered) {
        ASSERT_EQ(depth.upper, 0.0);
        ASSERT_EQ(in_solid.uncovered, 0U);
        ASSERT_EQ(on_surface.uncovered, 0U);
        continue;
      }
      ++leaks;
      // The lower bound is witnessed by a point of S.
      if (depth.lower > 0.0) {
        ASSERT_GE(gap_to_spheres(certificate.deepest_leak, spheres),
                  depth.lower * (1.0L - 1e-12L) - 1e-15L);
        ASSERT_TRUE(is_in_solid(certificate.deepest_leak, fitted.external));
      }
      // The proof comes near to the truth.
      ASSERT_LE(depth.upper - depth.lower, 0.05 * fitted.max_error + 0.05 * depth.upper);
    }
  }
  EXPECT_GT(leaks, effort(10, 2));
  EXPECT_GE(proofs_of_leaks, effort(10, 2));
  EXPECT_GE(proofs_of_covers, effort(10, 1));
}

// --- few cells where external spheres end close to a curved surface ---

// All vertices are equally far out: a bound by the size of cells alone needs millions of cells.
TEST(SolidProof, LeaksOfACurvedSurfaceAreBoundedInFewCells) {
  const TriangleMesh mesh = icosphere(2);
  const ExternalSpheres external = place_external_spheres(mesh, {.min_external_diameter = 0.5});
  const auto with_radius = [&](double radius) {
    return certify(mesh, Spheres{{Vector3d::Zero(), radius}}, {.external = &external});
  };
  const Certificate all_over = with_radius(0.95);
  EXPECT_NEAR(all_over.surface_depth.lower, 0.05, 1e-9);
  EXPECT_NEAR(all_over.surface_depth.upper, 0.05, 1e-9);
  EXPECT_EQ(all_over.solid_depth.lower, all_over.surface_depth.lower);
  EXPECT_LE(all_over.solid_depth.upper, 0.052);
  EXPECT_LE(all_over.pieces, 2U * mesh.triangles.size());
  EXPECT_LE(all_over.cells, 100'000U);
  // At vertices only: the sphere holds the middles of all facets.
  for (const double depth : effort(std::vector{1e-5, 1e-3, 1e-8}, 1)) {
    const Certificate leak = with_radius(1.0 - depth);
    EXPECT_NEAR(leak.uncovered_depth.lower, depth, 1e-12);
    EXPECT_NEAR(leak.surface_depth.upper, depth, 1e-12);
    EXPECT_NEAR(leak.deepest_leak.norm(), 1.0, 1e-12);
  }
}

// What external spheres take away of the mesh is not of S, and no witness against it.
TEST(SolidProof, BoundsAreInOrderWhereExternalSpheresPierceTheMesh) {
  const TriangleMesh cube = cube_mesh();
  ExternalSpheres external = box_of(cube);
  external.spheres.push_back({{0.5, 0.5, 10.0}, 9.5});
  // Up to where the external sphere crosses the vertical edges of the cube.
  const double edge = 10.0 - std::sqrt(9.5 * 9.5 - 0.5);
  const double radius = std::sqrt(0.5 + edge * edge) + 1e-5;
  const Certificate pierced =
      certify(cube, Spheres{{Vector3d(0.5, 0.5, 0.0), radius}}, {.external = &external});
  EXPECT_EQ(pierced.solid_depth.lower, 0.0);
  EXPECT_LE(pierced.solid_depth.upper, 1e-3);
  EXPECT_GT(pierced.surface_depth.lower, 0.1);
}

// --- protrusion over the mesh ---

Bounds protrusion_over(const TriangleMesh& mesh, const Spheres& spheres) {
  const ExternalSpheres box = box_of(mesh);
  return certify(mesh, spheres, {.external = &box}).protrusion_over_mesh.value();
}

// The inside of an open mesh counts for the upper bound and is further from the mesh than what is
// seen to protrude, which that does not hide.
TEST(ProtrusionOverMesh, IsWitnessedBeyondAnOpenMeshToo) {
  const TriangleMesh loosely_shut =
      joined(open_box(), box_mesh({0.0, 0.0, 1.001}, {1.0, 1.0, 1.01}));
  const Bounds protrusion = protrusion_over(loosely_shut, {{kMiddle, 0.7}});
  EXPECT_GE(protrusion.upper, 0.5);
  EXPECT_GE(protrusion.lower, 0.19);
  EXPECT_LE(protrusion.lower, 0.2);
}

// The bounds of the whole sphere meet; a search alone stops at 2 %. About the origin, and turned.
TEST(ProtrusionOverMesh, OfASphereOverAFaceIsExact) {
  Random random(41);
  for (int i = 0; i < effort(3, 1); ++i) {
    TriangleMesh cube = box_mesh({-1, -1, -1}, {1, 1, 1});
    const Eigen::Matrix3d turn = random.rotation().toRotationMatrix();
    for (Vector3d& vertex : cube.vertices) vertex = turn * vertex;
    const ExternalSpheres external = place_external_spheres(cube, {.min_external_diameter = 1.0});
    for (const double radius : {1.0, 1.3, 1.7}) {
      const Spheres spheres{{Vector3d::Zero(), radius}, {turn.col(0) * 0.2, 0.5}};
      const Bounds protrusion =
          certify(cube, spheres, {.external = &external}).protrusion_over_mesh.value();
      EXPECT_NEAR(protrusion.upper, radius - 1.0, 1e-12);
      EXPECT_NEAR(protrusion.lower, radius - 1.0, 1e-12);
    }
  }
}

const Vector3d kFar(4e7, -3e7, 7e7);

// The bound of the large sphere, whose centre is near a hollow, is far too large, so that cells
// about the point have to be searched, whatever their size.
TEST(ProtrusionOverMesh, OfAPointFarFromTheOriginIsBoundedByItsCells) {
  const TriangleMesh mesh =
      joined(box_mesh(kFar, kFar + Vector3d::Constant(10.0)),
             inverted(box_mesh(kFar + Vector3d::Constant(4.75), kFar + Vector3d::Constant(5.25))));
  Random random(43);
  for (int i = 0; i < effort(40, 10); ++i) {
    const Vector3d point =
        kFar + Vector3d(random.between(1, 9), random.between(1, 9), random.between(10.9, 11.1));
    const double away = point.z() - (kFar.z() + 10.0);
    const Bounds protrusion =
        protrusion_over(mesh, {{kFar + Vector3d(5.0, 5.0, 5.55), 2.0}, {point, 0.0}});
    EXPECT_GE(protrusion.upper, away);
    EXPECT_LE(protrusion.upper, away + 1e-3);
    EXPECT_LE(protrusion.lower, away);
  }
}

// --- volumes ---

constexpr double kBall = 4.0 / 3.0 * std::numbers::pi;

std::vector<internal::TriangleRole> roles_of(const TriangleMesh& mesh) {
  return internal::find_shells(internal::weld(mesh)).roles;
}

std::optional<double> maybe_ratio(const TriangleMesh& mesh, const Spheres& spheres) {
  return internal::estimate_volume_ratio(mesh, roles_of(mesh), spheres);
}
double ratio(const TriangleMesh& mesh, const Spheres& spheres) {
  return maybe_ratio(mesh, spheres).value();
}

TEST(VolumeRatio, WhatSeveralSpheresHoldCountsOnce) {
  const TriangleMesh cube = cube_mesh();
  const Sphere sphere{kMiddle, 1.0};
  EXPECT_NEAR(ratio(cube, {sphere}), kBall, 0.01 * kBall);
  EXPECT_NEAR(ratio(cube, {sphere, sphere}), kBall, 0.01 * kBall);
  // Two unit spheres whose centres are 1 apart share a lens of 5 pi / 12.
  const double both = 2.0 * kBall - 5.0 * std::numbers::pi / 12.0;
  EXPECT_NEAR(ratio(cube, {sphere, {kMiddle + Vector3d::UnitX(), 1.0}}), both, 0.01 * both);
}

TEST(VolumeRatio, OverlapsAndSealedHollowsOfTheMeshCountOnce) {
  const TriangleMesh cube = cube_mesh();
  const TriangleMesh hole = box_mesh(Vector3d::Constant(0.25), Vector3d::Constant(0.75));
  const double ring = 60.0 * std::sin(2.0 * std::numbers::pi / 60.0) / 2.0 * (1.0 - 0.9 * 0.9);
  std::vector<std::pair<TriangleMesh, double>> cases = {
      {joined(cube, box_mesh({0.5, 0, 0}, {1.5, 1, 1})), 1.5},
      {inverted(cube), 1.0},
      {joined(cube, inverted(hole)), 1.0},
      {joined(cube, hole), 1.0},
      {joined(cube, inverted(cube)), 1.0},
      {pipe(1.0, 0.9, 10.0, 60), 10.0 * ring}};
  for (int axis = 0; axis < 3; ++axis) {
    Vector3d size(4.0, 3.0, 2.0);
    size[axis] = 0.01;
    cases.emplace_back(box_mesh(Vector3d::Zero(), size), size.prod());
  }
  // Measured by a sphere of a known volume.
  for (const auto& [mesh, volume] : cases) {
    EXPECT_NEAR(kBall / ratio(mesh, {{Vector3d::Zero(), 1.0}}), volume, 0.02 * volume);
  }
}

// Two grains 100 apart, between which the lines pass, and a sheet of two faces.
TEST(VolumeRatio, IsAbsentWhereNothingIsMet) {
  const TriangleMesh grains = joined(box_mesh({0, 0, 0}, {0.001, 0.001, 0.001}),
                                     box_mesh({100, 0, 0}, {100.001, 0.001, 0.001}));
  const TriangleMesh sheet{{Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()},
                           {{0, 1, 2}, {0, 2, 1}}};
  const Spheres around{{Vector3d(50.0, 0.0, 0.0), 51.0}};
  const Spheres far_apart{{Vector3d::Zero(), 0.001}, {Vector3d::Constant(100.0), 0.001}};
  EXPECT_EQ(maybe_ratio(grains, around), std::nullopt);
  EXPECT_EQ(maybe_ratio(cube_mesh(), far_apart), std::nullopt);
  EXPECT_EQ(maybe_ratio(sheet, around), std::nullopt);
}

// Without external spheres S is the box.
TEST(FilledVolume, IsWhatTheSolidHasMoreThanTheMesh) {
  const TriangleMesh cube = cube_mesh();
  ExternalSpheres external;
  external.box = {Vector3d::Constant(-1.0), Vector3d::Constant(2.0)};
  const auto filled = [&](const TriangleMesh& mesh) {
    return internal::estimate_filled_volume(mesh, roles_of(mesh), external);
  };
  EXPECT_NEAR(filled(cube).volume, 26.0, 0.1);
  EXPECT_LT(std::abs(filled(cube).volume - 26.0), 4.0 * filled(cube).error + 1e-9);
  EXPECT_NEAR(filled(inverted(cube)).volume, 26.0, 0.1);
  EXPECT_NEAR(filled(joined(inverted(cube), cube)).volume, 26.0, 0.1);
  // A sphere that touches the cube, cut by the box on one side, and twice the same.
  external.spheres = {{Vector3d(1.75, 0.5, 0.5), 0.75}, {Vector3d(1.75, 0.5, 0.5), 0.75}};
  const double height = 0.5;  // of the cap that is cut off
  const double cut = std::numbers::pi * height * height * (3.0 * 0.75 - height) / 3.0;
  EXPECT_NEAR(filled(cube).volume, 26.0 - (kBall * std::pow(0.75, 3) - cut), 0.1);
}

// --- triangles that are turned either way ---

// The same set of points each time: as drawn, twice, both ways as in a double-sided drawing, some
// the other way round, all of them, and some of them both ways.
std::vector<NamedMesh> turned_cubes() {
  const TriangleMesh cube = box_mesh(Vector3d::Constant(-0.5), Vector3d::Constant(0.5));
  TriangleMesh mixed = cube, partly = cube;
  for (std::size_t i = 0; i < cube.triangles.size(); i += 3) {
    std::swap(mixed.triangles[i][1], mixed.triangles[i][2]);
    partly.triangles.push_back(mixed.triangles[i]);
  }
  return {{"plain", cube},
          {"twice", with_duplicates(cube)},
          {"both ways", joined(cube, inverted(cube))},
          {"mixed", mixed},
          {"inverted", inverted(cube)},
          {"partly both ways", partly}};
}

TEST(TurnedTriangles, DoNotChangeTheCertificateOfAFit) {
  for (const NamedMesh& named : turned_cubes()) {
    SCOPED_TRACE(named.name);
    const Certificate c = simplify(named.mesh, {.max_error = 0.05, .effort = 0}).certificate;
    EXPECT_TRUE(c.covered);
    EXPECT_LE(c.protrusion_over_mesh.value().upper, 0.0501);
    EXPECT_NEAR(c.filled_volume.value(), 0.0, 1e-9);
    EXPECT_NEAR(c.volume_ratio.value(), 1.23, 0.01);
  }
}

// The cube is covered but for its middle, which is 0.38 away from the spheres of its surface.
TEST(TurnedTriangles, DoNotChangeTheDepthOfALeak) {
  Spheres shell;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      for (int i = -4; i <= 4; ++i) {
        for (int k = -4; k <= 4; ++k) {
          Vector3d center(0.5 * (2 * side - 1), 0.125 * i, 0.125 * k);
          std::rotate(center.begin(), center.begin() + axis, center.end());
          shell.push_back({center, 0.12});
        }
      }
    }
  }
  for (const NamedMesh& named : turned_cubes()) {
    SCOPED_TRACE(named.name);
    const Certificate c = certify(named.mesh, shell);
    EXPECT_FALSE(c.covered);
    EXPECT_NEAR(c.uncovered_depth.lower, 0.38, 1e-3);
    EXPECT_NEAR(c.uncovered_depth.upper, 0.38, 1e-3);
    EXPECT_LE(c.deepest_leak.norm(), 1e-3);
    EXPECT_NEAR(c.protrusion_over_mesh.value().lower, 0.12, 0.003);
    EXPECT_NEAR(c.protrusion_over_mesh.value().upper, 0.12, 1e-3);
  }
}

// Two boxes that share a face are two bodies, each with its inside.
TEST(TurnedTriangles, OfTwoBodiesThatShareAFaceEachEnclosesItsOwn) {
  const TriangleMesh both = joined(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({1, 0, 0}, {2, 1, 1}));
  const Spheres corner{{Vector3d::Zero(), 0.1}};
  for (const TriangleMesh& mesh :
       {both, inverted(both), with_duplicates(both), joined(both, inverted(both))}) {
    EXPECT_NEAR(kBall * 1e-3 / ratio(mesh, corner), 2.0, 0.01);
    const MeshDistance distance(mesh);
    const internal::ClosedShells shells(mesh, distance);
    EXPECT_TRUE(shells.is_mesh_closed());
    for (const double x : {0.31, 0.99, 1.01, 1.69}) EXPECT_TRUE(shells.contain({x, 0.51, 0.52}));
    for (const double x : {-0.01, 2.01}) EXPECT_FALSE(shells.contain({x, 0.51, 0.52}));
  }
}

// --- refusals ---

std::string refused_cube(const Spheres& spheres, const CertifyOptions& options = {}) {
  return refused([&] { certify(cube_mesh(), spheres, options); });
}

// The gap to a sphere that grazes the mesh is known to the rounding of its radius only; halving
// pieces of less never ends.
TEST(Certificate, SpheresOfFarLargerSizeAreRefusedOrExaminedInFewPieces) {
  const auto grazing = [](double radius) { return Sphere{{radius + 0.5, 0.5, 0.5}, radius}; };
  EXPECT_EQ(refused_cube({{kMiddle, 1.0}, grazing(1e15)}), "sphere 1");
  EXPECT_EQ(refused_cube({grazing(0x1p24)}), "sphere 0");
  const ExternalSpheres box = box_of(cube_mesh());
  CertifyOptions options{.external = &box};
  if (kSanitized) options.protrusion_tolerance = 0.0;  // takes seconds there
  // One that has nothing to do with the mesh does not hide that others cover it.
  EXPECT_TRUE(certify(cube_mesh(), Spheres{{kMiddle, 0.9}, grazing(0x1p22)}, options).covered);
  if (kSanitized) return;
  options.protrusion_tolerance = 0.0;
  const Certificate leak = certify(cube_mesh(), Spheres{grazing(0x1p22)}, options);
  EXPECT_LE(leak.uncovered_depth.lower, 0.5 + 1e-7);  // of the corners at x = 0
  EXPECT_GE(leak.uncovered_depth.upper, 0.5);
  EXPECT_LE(leak.uncovered_depth.upper, 0.52);
  EXPECT_LT(leak.pieces + leak.cells, 500'000U);
}

}  // namespace
}  // namespace spherule::test
