// SPDX-License-Identifier: BSD-3-Clause
// The stage 2 method that baselines offer.
#include "base/error.h"
#include "bench/baseline/medial_spheres.h"
#include "bench/baseline/sphere_methods.h"
#include "simplifier/option_record.h"
#include "simplifier/simplify.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/simplifier/octree_proof.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

Fit fit_of(const TriangleMesh& mesh, const FitShares& shares = {}, CoverOptions options = {}) {
  Fit fitted;
  fitted.external = externals_of(mesh, shares);
  fitted.max_error = options.max_error = shares.max_error * diagonal_of(mesh);
  fitted.cover = medial_cover(mesh, fitted.external, options);
  return fitted;
}

// G1 by the certificate, by samples and by a proof that shares no code with the fit.
void expect_covered(const TriangleMesh& mesh, const Fit& fitted, std::uint64_t seed,
                    int samples = effort(3000, 300)) {
  const std::vector<Sphere>& spheres = fitted.cover.spheres;
  EXPECT_TRUE(certificate_of(mesh, fitted, spheres).covered);
  Random random(seed);
  const auto count = static_cast<std::size_t>(samples);
  std::vector<Vector3d> surface = points_on_surface(mesh, count, random);
  for (Vector3d& p : surface) p += 0.999999 * fitted.external.padding * random.direction();
  EXPECT_EQ(judge_cover(surface, spheres).uncovered, 0U);
  EXPECT_EQ(judge_cover(points_of_solid(fitted.external, count, random), spheres).uncovered, 0U);
}

// G2 by the certificate and by samples of the surfaces of the spheres.
void expect_tight(const TriangleMesh& mesh, const Fit& fitted, std::uint64_t seed,
                  int per_sphere = effort(40, 6)) {
  Random random(seed);
  const ProtrusionJudgement judged = judge_protrusion(fitted.cover.spheres, mesh, fitted.external,
                                                      fitted.max_error + 1e-9 * diagonal_of(mesh),
                                                      static_cast<std::size_t>(per_sphere), random);
  EXPECT_EQ(judged.beyond, 0U) << "of " << judged.points << ", one at "
                               << judged.example.transpose();
  const Certificate certificate = certificate_of(mesh, fitted, fitted.cover.spheres);
  ASSERT_TRUE(certificate.protrusion_over_simplified_max.has_value());
  EXPECT_LE(*certificate.protrusion_over_simplified_max, fitted.max_error);
}

TEST(MedialCover, CoversSevenShapesWithinTheError) {
  std::vector<NamedMesh> shapes = effort(zoo_to_fit(), 3);
  shapes.resize(std::min<std::size_t>(shapes.size(), 7));  // the others take long
  for (const NamedMesh& named : shapes) {
    SCOPED_TRACE(named.name);
    const Fit fitted = fit_of(named.mesh, {.max_error = 0.12});
    expect_covered(named.mesh, fitted, 171);
    expect_tight(named.mesh, fitted, 172);
    const OctreeProof proof = prove_by_octree(fitted.external, fitted.cover.spheres);
    EXPECT_EQ(proof.verdict, OctreeVerdict::kCovered) << "at " << proof.point.transpose();
  }
}

TEST(MedialCover, CoversHoweverExternalSpheresArePlacedAndWhateverTheScale) {
  for (const ExternalPlacement placement : {ExternalPlacement::kRandom, ExternalPlacement::kNone}) {
    FitShares shares;
    shares.placement = placement;
    const Fit fitted = fit_of(l_bracket(), shares);
    expect_covered(l_bracket(), fitted, 173);
    expect_tight(l_bracket(), fitted, 174);
  }
  for (const double scale : {1e-6, 1e6}) {
    TriangleMesh mesh = l_bracket();
    for (Vector3d& v : mesh.vertices) v = scale * (v + Vector3d(1e4, -1e4, 1e4));
    const Fit fitted = fit_of(mesh);
    expect_covered(mesh, fitted, 178);
    expect_tight(mesh, fitted, 179);
  }
  // Without a simplification to speak of, of more than a hundred thousand external spheres, all of
  // which are tried: D = E / 2.
  const Fit as_it_is = fit_of(open_box(), {.max_error = 0.12, .diameter = 0.5});
  expect_covered(open_box(), as_it_is, 175, 100);
  expect_tight(open_box(), as_it_is, 176, 1);
  TriangleMesh grown = mesh_named("three-fins");
  grown.vertex_error = 1e-3;
  FitShares shares;
  shares.padding = 0.9;
  expect_covered(grown, fit_of(grown, shares), 177);
}

TEST(MedialCover, IsEqualInEveryRunOnAnyNumberOfThreads) {
  for (const char* name : effort(std::vector{"l-bracket", "cube"}, 1)) {
    const TriangleMesh mesh = mesh_named(name);
    const std::vector<Sphere> first = fit_of(mesh).cover.spheres;
    for (const int threads : {1, 2}) {
      CoverOptions options;
      options.threads = threads;
      EXPECT_EQ(fit_of(mesh, {}, options).cover.spheres, first);
    }
  }
}

TEST(MedialCover, EverySphereIsInflatedByTheSame) {
  const Fit fitted = fit_of(l_bracket());
  const SphereCover& cover = fitted.cover;
  EXPECT_GT(cover.inflation, 0.0);
  ASSERT_EQ(cover.spheres.size(), cover.spheres_before_inflation.size());
  for (std::size_t i = 0; i < cover.spheres.size(); ++i) {
    ASSERT_EQ(cover.spheres[i].center, cover.spheres_before_inflation[i].center);
    ASSERT_NEAR(cover.spheres[i].radius, cover.spheres_before_inflation[i].radius + cover.inflation,
                1e-12);
  }
}

TEST(MedialCover, NoSphereIsSmallerThanTheLeastRadius) {
  const TriangleMesh mesh = l_bracket();
  CoverOptions options;
  options.min_radius = 2.5 * FitShares{}.max_error * diagonal_of(mesh);
  const Fit fitted = fit_of(mesh, {}, options);
  for (const Sphere& s : fitted.cover.spheres) ASSERT_GE(s.radius, options.min_radius);
  expect_covered(mesh, fitted, 180);
}

TEST(MedialCover, BadInputIsRefusedByName) {
  const ExternalSpheres external = externals_of(cube_mesh(), {});
  const auto refused = [&](const CoverOptions& options,
                           const TriangleMesh& mesh = cube_mesh()) -> std::string {
    try {
      medial_cover(mesh, external, options);
    } catch (const Error& error) {
      return error.subject();
    }
    return "accepted";
  };
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), 1e300}) {
    EXPECT_EQ(refused({.max_error = bad}), "max error");
    EXPECT_EQ(refused({.max_error = 0.3, .min_radius = bad}), "min radius");
    EXPECT_EQ(refused({.max_error = 0.3, .min_internal_diameter = bad}), "min internal diameter");
  }
  EXPECT_EQ(refused({}), "max error");
  EXPECT_EQ(refused({.max_error = 1e-15}), "max error");
  EXPECT_EQ(refused({.max_error = 0.3}, {}), "mesh");
  const Zone zone{.shape = Sphere{{0, 0, 0}, 0.5}, .max_error = 0.1};
  EXPECT_EQ(refused({.max_error = 0.3, .zones = {zone}}), "zones");
  const Zone of_diameter{.shape = Sphere{{0, 0, 0}, 0.5}, .min_external_diameter = 0.1};
  EXPECT_EQ(refused({.max_error = 0.3, .zones = {of_diameter}}), "accepted");
}

// What simplify() promises of its own stage 2 methods: the certificate, the record, levels.
TEST(MedialCover, StandsInSimplify) {
  const TriangleMesh mesh = l_bracket();
  const double max_error = 0.07 * diagonal_of(mesh);
  SimplifyOptions options{.max_error = max_error, .levels = {max_error, 3.0 * max_error}};
  options.stage2_method = Stage2Method{"medial", medial_cover};
  const Simplification result = simplify(mesh, options);
  EXPECT_EQ(broken_promises(result), "");
  EXPECT_EQ(std::get<std::string>(option_record(result.options, 1.0).at("method")), "medial");
  ASSERT_EQ(result.levels.size(), 1U);
  EXPECT_LE(result.levels[0].protrusion, 3.0 * max_error);
  EXPECT_LT(result.levels[0].spheres.spheres.size(), result.cover.spheres.size());
}

}  // namespace
}  // namespace spherule::test
