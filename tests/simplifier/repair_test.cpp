// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/repair.h"

#include "base/error.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/simplifier/octree_proof.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

// What repair() promises, by the certificate, by an independent proof and by samples.
Repair expect_repaired(const TriangleMesh& mesh, const Fit& fitted, std::vector<Sphere> leaking,
                       double max_error) {
  Repair result =
      repair(mesh, fitted.external, leaking, {.max_error = max_error, .effort = effort(4, 1)});
  const std::vector<Sphere>& spheres = result.spheres;
  EXPECT_EQ(spheres.size(), leaking.size() + result.added);
  double largest = 0.0;
  double total = 0.0;
  std::size_t inflated = 0;
  for (std::size_t i = 0; i < leaking.size(); ++i) {
    EXPECT_EQ(spheres[i].center, leaking[i].center);
    EXPECT_GE(spheres[i].radius, leaking[i].radius);
    const double by = spheres[i].radius - leaking[i].radius;
    largest = std::max(largest, by);
    total += by;
    inflated += by > 0.0 ? 1U : 0U;
    // Protrudes no further than it did or than it may.
    if (by == 0.0) leaking[i].radius = 0.0;
  }
  EXPECT_EQ(result.inflated, inflated);
  EXPECT_EQ(result.largest_inflation, largest);
  EXPECT_NEAR(result.total_inflation, total, 1e-9 * total);
  EXPECT_EQ(result.max_error, max_error);
  EXPECT_LE(result.protrusion_after, std::max(max_error, result.protrusion_before));
  EXPECT_TRUE(certificate_of(mesh, fitted, spheres).covered);
  const OctreeProof proof = prove_by_octree(fitted.external, spheres, 26,
                                            static_cast<std::size_t>(effort(300'000, 60'000)));
  EXPECT_NE(proof.verdict, OctreeVerdict::kLeak) << proof.point.transpose();
  Random random(91);
  const auto count = static_cast<std::size_t>(effort(4000, 400));
  EXPECT_EQ(judge_cover(points_of_solid(fitted.external, count, random), spheres).uncovered, 0U);
  EXPECT_EQ(judge_cover(points_on_surface(mesh, count, random), spheres).uncovered, 0U);
  std::vector<Sphere> changed;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (i >= leaking.size() || leaking[i].radius > 0.0) changed.push_back(spheres[i]);
  }
  const Certificate of_changed = certificate_of(mesh, fitted, changed);
  EXPECT_LE(*of_changed.protrusion_over_simplified_max, max_error);
  EXPECT_EQ(judge_protrusion(changed, mesh, fitted.external, max_error + 1e-9 * diagonal_of(mesh),
                             static_cast<std::size_t>(effort(10, 3)), random)
                .beyond,
            0U);
  return result;
}

Fit fit_of(const TriangleMesh& mesh, CoverMethod method = CoverMethod::kCover) {
  return fit(mesh, options_for(method));
}

TEST(RepairOf, CoversThatAreWholeComeBackUnchanged) {
  const TriangleMesh mesh = l_bracket();
  const Fit fitted = fit_of(mesh);
  const Repair result = expect_repaired(mesh, fitted, fitted.cover.spheres, fitted.max_error);
  EXPECT_EQ(result.spheres, fitted.cover.spheres);
}

TEST(RepairOf, NoSpheresIsACover) {
  const TriangleMesh mesh = cube_mesh();
  const Fit fitted = fit_of(mesh);
  const Repair result = expect_repaired(mesh, fitted, {}, fitted.max_error);
  EXPECT_EQ(result.inflated, 0U);
  EXPECT_LE(result.added, fitted.cover.spheres.size() + 3);
}

TEST(RepairOf, CoversWithoutSomeOfTheirSpheres) {
  for (const char* name :
       effort(std::vector{"cube", "l-bracket", "torus", "open-box", "three-fins"}, 1)) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = mesh_named(name);
    const Fit fitted = fit_of(mesh);
    Random random(92);
    std::vector<Sphere> leaking = fitted.cover.spheres;
    std::size_t taken = 0;
    for (; taken < 3 && leaking.size() > 1; ++taken) {
      leaking.erase(leaking.begin() + static_cast<std::ptrdiff_t>(random.index(leaking.size())));
    }
    const Repair result = expect_repaired(mesh, fitted, leaking, fitted.max_error);
    // As many as were taken would do; a search may find a few more.
    EXPECT_LE(result.added, 2 * taken);
    EXPECT_GT(result.added, 0U);
  }
}

// All that is missing is within reach of the spheres: none has to be added, and none grows beyond
// what it had.
TEST(RepairOf, CoversWithShrunkSpheresGrowsThemAgain) {
  int leaked = 0;
  for (const char* name : effort(std::vector{"cube", "l-bracket", "torus", "soup"}, 1)) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = mesh_named(name);
    const Fit fitted = fit_of(mesh);
    std::vector<Sphere> leaking = fitted.cover.spheres;
    double taken = 0.0;
    for (Sphere& sphere : leaking) {
      taken += 0.03 * sphere.radius;
      sphere.radius *= 0.97;
    }
    const Repair result = expect_repaired(mesh, fitted, leaking, fitted.max_error);
    EXPECT_EQ(result.added, 0U);
    EXPECT_EQ(result.inflated > 0, !certificate_of(mesh, fitted, leaking).covered);
    EXPECT_LT(result.total_inflation, taken);
    leaked += result.inflated > 0 ? 1 : 0;
  }
  EXPECT_GE(leaked, effort(3, 1));
}

TEST(RepairOf, ThePapersSpheresBeforeInflation) {
  const TriangleMesh mesh = l_bracket();
  const Fit fitted = fit_of(mesh, CoverMethod::kPaper);
  const Repair result =
      expect_repaired(mesh, fitted, fitted.cover.spheres_before_inflation, fitted.max_error);
  EXPECT_EQ(result.added, 0U);
  EXPECT_LE(result.largest_inflation, fitted.max_error);
}

TEST(RepairOf, SpheresAnywhere) {
  for (const char* name : effort(std::vector{"cube", "l-bracket", "open-box"}, 1)) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = mesh_named(name);
    const Fit fitted = fit_of(mesh);
    Random random(93);
    const Eigen::AlignedBox3d box(Vector3d(fitted.external.box.min() - 0.3 * Vector3d::Ones()),
                                  Vector3d(fitted.external.box.max() + 0.3 * Vector3d::Ones()));
    std::vector<Sphere> junk;
    for (int i = 0; i < 20; ++i) junk.push_back({random.in_box(box), random.between(0.0, 0.3)});
    expect_repaired(mesh, fitted, junk, fitted.max_error);
  }
}

// Spheres about points outside of S are all there is at the corners, and may not grow to hold them.
TEST(RepairOf, SpheresBesideTheSolid) {
  const TriangleMesh mesh = cube_mesh();
  const Fit fitted = fit(mesh, options_for(CoverMethod::kCover), {.max_error = 0.07});
  std::vector<Sphere> leaking;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d at(corner % 2, corner / 2 % 2, corner / 4);
    leaking.push_back({at + 0.08 * (at - Vector3d::Constant(0.5)), 0.04});
  }
  const Repair result = expect_repaired(mesh, fitted, leaking, fitted.max_error);
  EXPECT_EQ(result.inflated, 0U);
}

// Two prongs that spheres stand on, one of them far out; what leaks between them is mended by
// spheres that leave the gap free, as any do that protrude less than half of it.
TEST(RepairOf, OneFarSphereDoesNotLicenseTheOthers) {
  const TriangleMesh prongs = joined(box_mesh({0.0, 0.0, 0.0}, {10.0, 10.0, 60.0}),
                                     box_mesh({40.0, 0.0, 0.0}, {50.0, 10.0, 60.0}));
  const ExternalSpheres external =
      place_external_spheres(prongs, {.min_external_diameter = 16.0, .max_error = 4.0});
  std::vector<Sphere> leaking;
  for (const double x : {5.0, 45.0}) {
    for (const double z : {10.0, 30.0, 50.0}) leaking.push_back({{x, 5.0, z}, 7.0});
  }
  leaking.push_back({{5.0, 5.0, 0.0}, 44.0});  // stands out by 39
  const Repair mended = repair(prongs, external, leaking, {.effort = effort(4, 1)});
  EXPECT_GE(mended.protrusion_before, 38.9);
  EXPECT_LE(mended.protrusion_after, mended.protrusion_before);
  EXPECT_LE(mended.max_error, 4.0);
  EXPECT_TRUE(certify(prongs, mended.spheres, {.external = &external}).covered);
  // The middle of the gap, beyond the far one's reach.
  Random random(5);
  for (int i = 0; i < effort(10'000, 1'000); ++i) {
    const Vector3d between(random.between(15.0, 35.0), random.between(0.0, 10.0),
                           random.between(50.0, 60.0));
    for (const Sphere& sphere : mended.spheres) {
      EXPECT_GT((between - sphere.center).norm(), sphere.radius) << sphere.center.transpose();
    }
  }
}

TEST(RepairOf, IsEqualInEveryRunOnAnyNumberOfThreads) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const TriangleMesh mesh = l_bracket();
  const Fit fitted = fit_of(mesh);
  std::vector<Sphere> leaking = fitted.cover.spheres;
  leaking.pop_back();
  for (Sphere& sphere : leaking) sphere.radius *= 0.98;
  const auto on = [&](int threads) {
    return repair(mesh, fitted.external, leaking,
                  {.max_error = fitted.max_error, .effort = 2, .threads = threads})
        .spheres;
  };
  const std::vector<Sphere> first = on(1);
  EXPECT_EQ(on(2), first);
  EXPECT_EQ(on(0), first);
}

TEST(RepairOf, RefusesWhatItCannotUse) {
  const TriangleMesh mesh = cube_mesh();
  const Fit fitted = fit_of(mesh);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {-1.0, nan, 1e300, 1e-17}) {
    EXPECT_THROW(repair(mesh, fitted.external, {}, {.max_error = bad}), Error) << bad;
  }
  const std::vector<Sphere> unusable = {{Vector3d::Zero(), nan}};
  EXPECT_THROW(repair(mesh, fitted.external, unusable, {.max_error = 0.1}), Error);
  EXPECT_THROW(repair(mesh, fitted.external, {}, {.max_error = 0.1, .effort = -1}), Error);
  const Zone upside_down{.shape = Sphere{Vector3d::Zero(), -20.0}, .max_error = 0.05};
  EXPECT_THROW(repair(mesh, fitted.external, {}, {.max_error = 0.1, .zones = {upside_down}}),
               Error);
  const Zone nowhere{.shape = Sphere{Vector3d::Zero(), 1.0}, .max_error = nan};
  EXPECT_THROW(repair(mesh, fitted.external, {}, {.max_error = 0.1, .zones = {nowhere}}), Error);
}

}  // namespace
}  // namespace spherule::test
