// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/simplify.h"

#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const double kRoot3 = std::numbers::sqrt3;
const Vector3d kMiddle = Vector3d::Constant(0.5);

// A solid without external spheres: its box.
ExternalSpheres box_of(const TriangleMesh& mesh) {
  return place_external_spheres(mesh, {.placement = ExternalPlacement::kNone});
}

// Without external spheres, what is inside is found by a flood, whose fine cells are many.
CertifyOptions flooded() {
  CertifyOptions options;
  if (kSanitized) options.resolution = 1.0 / 512.0;
  return options;
}

// One sphere a cell of an n x n x n grid over the unit cube, around the cell and a little more: a
// piece of surface that crosses from cell to cell has to fit into one of them.
std::vector<Sphere> grid_of_spheres(int n) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < n * n * n; ++i) {
    const Vector3d cell(i % n, i / n % n, i / n / n);
    spheres.push_back({(cell + kMiddle) / n, kRoot3 / (2 * n) * 1.01});
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
  std::vector<Sphere> spheres = grid_of_spheres(4);
  for (Sphere& sphere : spheres) sphere.radius = kRoot3 / 8 * (1 + 1e-9);
  ExternalSpheres external = box_of(mesh);
  CertifyOptions options;
  options.external = &external;
  EXPECT_TRUE(certify(mesh, spheres, options).covered);

  // Not if S does not hold the mesh: then nothing is proved of the rest of it.
  external.spheres.push_back({{0.5, 0.5, 0.5}, 0.3});
  const Certificate pierced = certify(mesh, spheres, options);
  EXPECT_FALSE(pierced.covered);
  EXPECT_EQ(pierced.solid_depth.upper, 0.0);
  EXPECT_EQ(pierced.surface_depth.lower, 0.0);
  external.spheres.clear();
  external.box.max().x() = 0.75;
  EXPECT_FALSE(certify(mesh, spheres, options).covered);
}

TEST(Certificate, ACubeIsCoveredByItsCircumscribedSphereAndByNoSmallerOne) {
  const ExternalSpheres box = box_of(cube_mesh());
  // The flood without external spheres is fine, and slow under sanitizers.
  for (const ExternalSpheres* external :
       effort(std::vector<const ExternalSpheres*>{&box, nullptr}, 1)) {
    CertifyOptions options;
    options.external = external;
    const auto certificate = [&](double radius) {
      return certify(cube_mesh(), std::vector<Sphere>{{kMiddle, radius}}, options);
    };
    EXPECT_TRUE(certificate(kRoot3 / 2 + 1e-9).covered);
    const Certificate leak = certificate(0.8);
    EXPECT_FALSE(leak.covered);
    EXPECT_LE(leak.surface_depth.lower, kRoot3 / 2 - 0.8);
    EXPECT_GE(leak.surface_depth.upper, kRoot3 / 2 - 0.8);
    EXPECT_LE(leak.surface_depth.upper - leak.surface_depth.lower, 1e-9);
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
  CertifyOptions options;
  options.external = &box;
  const std::vector<Sphere> all = grid_of_spheres(n);
  EXPECT_TRUE(certify(cube_mesh(), all, options).covered);

  // Spheres that only just meet: nothing is open, but that is not proved, and so not said.
  std::vector<Sphere> tight = all;
  for (Sphere& s : tight) s.radius = kRoot3 / (2 * n) * (1 + 1e-9);
  const Certificate unproved = certify(cube_mesh(), tight, options);
  EXPECT_FALSE(unproved.covered);
  EXPECT_EQ(unproved.uncovered_depth.lower, 0.0);
  EXPECT_GT(unproved.uncovered_depth.upper, 0.0);

  std::vector<Sphere> hollow = all;
  hollow.erase(hollow.begin() + (n * n * n) / 2);
  // The middle of the middle cell, to the spheres of the cells beside it.
  const double in_the_middle = 1.0 / n - all.front().radius;
  const Certificate inner = certify(cube_mesh(), hollow, options);
  EXPECT_FALSE(inner.covered);
  EXPECT_EQ(inner.surface_depth.upper, 0.0);
  EXPECT_LE(inner.solid_depth.lower, in_the_middle);
  EXPECT_GE(inner.solid_depth.upper, in_the_middle);
  EXPECT_NEAR(inner.solid_depth.lower, in_the_middle, 1e-3);
  EXPECT_NEAR(inner.solid_depth.upper, in_the_middle, 5e-3);
  EXPECT_NEAR((inner.deepest_leak - kMiddle).norm(), 0.0, 0.01);

  std::vector<Sphere> cut = all;
  cut.erase(cut.begin());
  const double at_the_corner = Vector3d(1.5 / n, 0.5 / n, 0.5 / n).norm() - all.front().radius;
  const Certificate outer = certify(cube_mesh(), cut, options);
  EXPECT_LE(outer.uncovered_depth.lower, at_the_corner);
  EXPECT_GE(outer.uncovered_depth.upper, at_the_corner);
  EXPECT_NEAR(outer.uncovered_depth.lower, at_the_corner, 5e-3);
  EXPECT_NEAR(outer.uncovered_depth.upper, at_the_corner, 1e-2);
  EXPECT_NEAR(outer.deepest_leak.norm(), 0.0, 0.02);
}

// Where spheres meet in a point of the surface, no piece of it is ever in one of them. The proof
// must come to an end however close it is told to look.
TEST(Certificate, TheSmallestResolutionIsThatOfTheCoordinates) {
  const int n = 3;
  std::vector<Sphere> touching = grid_of_spheres(n);
  for (Sphere& s : touching) s.radius = kRoot3 / (2 * n) * (1 - 1e-15);
  const ExternalSpheres box = box_of(cube_mesh());
  CertifyOptions options;
  options.external = &box;
  options.resolution = 1e-300;
  const Certificate unproved = certify(cube_mesh(), touching, options);
  EXPECT_FALSE(unproved.covered);
  EXPECT_GT(unproved.uncovered_depth.upper, 0.0);
  EXPECT_LT(unproved.uncovered_depth.upper, 1e-11);
}

// A sealed hollow is inside, whatever is in it: the spheres protrude as if the cube were solid. Nor
// does a part that is not closed take its closed neighbours' inside away.
TEST(Certificate, SpheresInASealedHollowDoNotProtrude) {
  const auto cube = [](double low, double high) {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.translation() = Vector3d::Constant(low);
    TriangleMesh mesh = cube_mesh();
    for (Vector3d& v : mesh.vertices) v *= high - low;
    return moved(mesh, motion);
  };
  TriangleMesh sheet = cube(0.4, 0.6);
  sheet.triangles.resize(2);
  const TriangleMesh hollow = joined(cube_mesh(), inverted(cube(0.2, 0.8)));
  const int n = 3;
  const std::vector<Sphere> spheres = grid_of_spheres(n);
  const double beyond_a_face = spheres.front().radius - 0.5 / n;
  CertifyOptions options;
  options.protrusion_tolerance = 1e-3;
  const ExternalSpheres box = box_of(cube_mesh());
  options.external = &box;
  const std::vector<TriangleMesh> meshes = {joined(hollow, sheet), joined(hollow, cube(0.4, 0.6)),
                                            hollow, cube_mesh()};
  for (const TriangleMesh& mesh : effort(meshes, 1)) {
    const Bounds protrusion = certify(mesh, spheres, options).protrusion_over_mesh.value();
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
  std::vector<Sphere> spheres;
  for (int i = 0; i <= 20; ++i) {
    for (int k = 0; k <= 4; ++k) {
      for (int m = 0; m <= 4; ++m) {
        const bool inner = i % 20 != 0 && k % 4 != 0 && m % 4 != 0;
        if (!inner) spheres.push_back({Vector3d(i, k, m) / 20.0, radius});
      }
    }
  }
  // From the axis, half way between two rings of spheres.
  const double depth = std::hypot(0.1, 0.025) - radius;
  for (const TriangleMesh& mesh : {inverted(bar), bar}) {
    const Certificate certificate = certify(mesh, spheres);
    EXPECT_FALSE(certificate.covered);
    EXPECT_EQ(certificate.surface_depth.upper, 0.0);
    EXPECT_NEAR(certificate.solid_depth.lower, depth, 0.001);
    EXPECT_NEAR(certificate.solid_depth.upper, depth, 0.002);
    EXPECT_LE(certificate.solid_depth.lower, depth);
    EXPECT_GE(certificate.solid_depth.upper, depth);
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
  const double radius = 1.0;
  const std::vector<Sphere> sphere{{kMiddle, radius}};
  const ExternalSpheres box = box_of(cube_mesh());
  CertifyOptions options;
  options.external = &box;
  const Certificate certificate = certify(cube_mesh(), sphere, options);
  EXPECT_TRUE(certificate.covered);
  // Above the middle of a face.
  const double exact = radius - 0.5;
  ASSERT_TRUE(certificate.protrusion_over_simplified_max.has_value());
  EXPECT_GE(*certificate.protrusion_over_simplified_max, exact);
  EXPECT_NEAR(*certificate.protrusion_over_simplified_max, exact, 1e-9);
  ASSERT_TRUE(certificate.protrusion_over_mesh.has_value());
  EXPECT_LE(certificate.protrusion_over_mesh->lower, exact);
  EXPECT_GE(certificate.protrusion_over_mesh->upper, exact);
  EXPECT_NEAR(certificate.protrusion_over_mesh->lower, exact, 0.03);
  EXPECT_NEAR(certificate.protrusion_over_mesh->upper, exact, 0.03);
  ASSERT_TRUE(certificate.volume_ratio.has_value());
  EXPECT_NEAR(*certificate.volume_ratio, 4.0 / 3.0 * std::numbers::pi, 0.05);
}

TEST(Certificate, ASphereFarOffProtrudesByItsDistance) {
  const std::vector<Sphere> spheres{{kMiddle, 0.9}, {{4, 0.5, 0.5}, 0.25}};
  const ExternalSpheres box = box_of(cube_mesh());
  CertifyOptions options;
  options.external = &box;
  const Certificate certificate = certify(cube_mesh(), spheres, options);
  EXPECT_GE(*certificate.protrusion_over_simplified_max, 3.25);
  EXPECT_LE(*certificate.protrusion_over_simplified_max, 3.26);
  EXPECT_LE(certificate.protrusion_over_mesh->lower, 3.25);
  EXPECT_GE(certificate.protrusion_over_mesh->upper, 3.25);
  EXPECT_LE(certificate.protrusion_over_mesh->upper, 3.4);
}

TEST(Certificate, AnEmptySetCoversNothing) {
  // The less room a box of the same diagonal has, the quicker the flood.
  const auto thin = [](TriangleMesh mesh) {
    for (Vector3d& v : mesh.vertices) v = v.cwiseProduct(Vector3d(1.0, 0.1, 0.1));
    return mesh;
  };
  for (const TriangleMesh& mesh :
       effort(std::vector{thin(cube_mesh()), thin(open_box()), thin(soup(5, 1))}, 1)) {
    const Certificate certificate = certify(mesh, {}, flooded());
    EXPECT_FALSE(certificate.covered);
    EXPECT_EQ(certificate.uncovered_depth.upper, kInfinity);
    EXPECT_EQ(certificate.sphere_count, 0U);
    EXPECT_FALSE(record(certificate).covered);
  }
}

// A cube whose corners eight external spheres take: what remains is furthest from the middle where
// two of them and a face of the cube meet, at (1/2, y, 0) with 1/4 + y^2 = R^2.
TEST(Certificate, TheDepthOfALeakInACurvedSolidIsExact) {
  ExternalSpheres external = box_of(cube_mesh());
  for (const double taken : effort(std::vector{0.6, 0.55, 0.7}, 1)) {
    external.spheres.clear();
    for (int i = 0; i < 8; ++i) {
      external.spheres.push_back({Vector3d(i & 1, i >> 1 & 1, i >> 2 & 1), taken});
    }
    const double y = std::sqrt(taken * taken - 0.25);
    const double furthest = Vector3d(0.0, 0.5 - y, 0.5).norm();
    CertifyOptions options;
    options.external = &external;
    for (const double radius : {0.2, furthest - 0.01, furthest + 1e-3}) {
      SCOPED_TRACE(radius);
      // A mesh in the middle, for which the cube is box enough.
      const Certificate certificate =
          certify(box_mesh(Vector3d::Constant(0.45), Vector3d::Constant(0.55)),
                  std::vector<Sphere>{{kMiddle, radius}}, options);
      const double depth = std::max(0.0, furthest - radius);
      EXPECT_EQ(certificate.covered, depth == 0.0);
      EXPECT_LE(certificate.solid_depth.lower, depth * (1.0 + 1e-12));
      EXPECT_GE(certificate.solid_depth.upper, depth * (1.0 - 1e-12));
      EXPECT_LE(certificate.solid_depth.upper - certificate.solid_depth.lower,
                0.04 * depth + 2e-3 * (depth > 0.0 ? 1.0 : 0.0));
    }
  }
}

// Sets that cover a part: some spheres of a fit, shrunk or left out at random.
TEST(Certificate, TheBoundsOfTheDepthHoldAgainstSampling) {
  Random random(92);
  int leaks = 0;
  for (const NamedMesh& named : zoo_to_fit()) {
    SCOPED_TRACE(named.name);
    const TriangleMesh& mesh = named.mesh;
    CoverOptions options;
    options.method = CoverMethod::kPaper;
    // The same D in both.
    const Fit fitted = fit(
        mesh, options, {.max_error = kSanitized ? 0.2 : 0.1, .diameter = kSanitized ? 2.0 : 4.0});
    const auto count = static_cast<std::size_t>(effort(3000, 300));
    const std::vector<Vector3d> surface = points_on_surface(mesh, count, random);
    const std::vector<Vector3d> solid = points_of_solid(fitted.external, count, random);
    for (int round = 0; round < effort(3, 1); ++round) {
      std::vector<Sphere> spheres;
      for (const Sphere& s : fitted.cover.spheres) {
        if (random.unit() < 0.1) continue;
        spheres.push_back({s.center, s.radius * random.between(0.9, 1.0)});
      }
      if (spheres.empty()) continue;  // no set at all has no depth to compare
      const Certificate certificate = certificate_of(mesh, fitted, spheres);
      const Judgement on_surface = judge_cover(surface, spheres);
      const Judgement in_solid = judge_cover(solid, spheres);
      ASSERT_GE(certificate.surface_depth.upper, on_surface.depth - 1e-15L);
      ASSERT_GE(certificate.solid_depth.upper, in_solid.depth);
      ASSERT_LE(certificate.uncovered_depth.lower, certificate.uncovered_depth.upper);
      if (certificate.covered) {
        ASSERT_EQ(certificate.uncovered_depth.upper, 0.0);
        ASSERT_EQ(in_solid.uncovered, 0U);
        ASSERT_EQ(on_surface.uncovered, 0U);
        continue;
      }
      ++leaks;
      // The lower bound is witnessed by a point of S.
      if (certificate.uncovered_depth.lower > 0.0) {
        ASSERT_GE(gap_to_spheres(certificate.deepest_leak, spheres),
                  certificate.uncovered_depth.lower * (1.0L - 1e-12L) - 1e-15L);
        ASSERT_TRUE(is_in_solid(certificate.deepest_leak, fitted.external));
      }
      // The proof comes near to the truth.
      ASSERT_LE(certificate.uncovered_depth.upper - certificate.uncovered_depth.lower,
                0.05 * fitted.max_error + 0.05 * certificate.uncovered_depth.upper);
    }
  }
  EXPECT_GT(leaks, effort(10, 2));
}

TEST(Certificate, IsEqualOnAnyNumberOfThreads) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  CoverOptions fit_options;
  fit_options.method = CoverMethod::kPaper;
  const TriangleMesh mesh = l_bracket();
  const Fit fitted = fit(mesh, fit_options);
  CertifyOptions options;
  options.external = &fitted.external;
  std::vector<Certificate> certificates;
  for (const int threads : {1, 2, 0}) {
    options.threads = threads;
    certificates.push_back(certify(mesh, fitted.cover.spheres_before_inflation, options));
  }
  for (const Certificate& c : certificates) {
    EXPECT_EQ(c.uncovered_depth.lower, certificates.front().uncovered_depth.lower);
    EXPECT_EQ(c.uncovered_depth.upper, certificates.front().uncovered_depth.upper);
    EXPECT_EQ(c.deepest_leak, certificates.front().deepest_leak);
    EXPECT_EQ(c.protrusion_over_mesh->upper, certificates.front().protrusion_over_mesh->upper);
    EXPECT_EQ(c.volume_ratio, certificates.front().volume_ratio);
  }
}

}  // namespace
}  // namespace spherule::test
