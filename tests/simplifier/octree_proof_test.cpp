// SPDX-License-Identifier: BSD-3-Clause
// The covers of the simplifier before a proof that shares no code with it (G1).
#include "tests/simplifier/octree_proof.h"

#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <vector>

namespace spherule::test::octree_proof_test {
namespace {

using Eigen::Vector3d;

const Vector3d kMiddle = Vector3d::Constant(0.5);

ExternalSpheres cube_without_externals() {
  ExternalSpheres external;
  external.box = Eigen::AlignedBox3d(Vector3d(0, 0, 0), Vector3d(1, 1, 1));
  return external;
}

OctreeVerdict verdict(const ExternalSpheres& external, const std::vector<Sphere>& spheres) {
  return prove_by_octree(external, spheres).verdict;
}

TEST(OctreeProof, ACubeIsCoveredByItsCircumscribedSphereAndByNoSmallerOne) {
  const ExternalSpheres cube = cube_without_externals();
  const double radius = std::sqrt(0.75);
  EXPECT_EQ(verdict(cube, {{kMiddle, radius + 1e-12}}), OctreeVerdict::kCovered);
  EXPECT_EQ(verdict(cube, {}), OctreeVerdict::kLeak);
  for (const double less : {1e-3, 1e-6, 1e-8}) {
    const OctreeProof proof = prove_by_octree(cube, std::vector<Sphere>{{kMiddle, radius - less}});
    EXPECT_EQ(proof.verdict, OctreeVerdict::kLeak) << less;
    EXPECT_NEAR((proof.point - kMiddle).norm(), radius, less);
  }
}

TEST(OctreeProof, WhatExternalSpheresTakeNeedNotBeCovered) {
  ExternalSpheres cube = cube_without_externals();
  cube.spheres = {{{0, 0, 0}, 0.5}};
  // Reaches every corner but the one that is taken.
  const std::vector<Sphere> sphere{{Vector3d::Constant(0.55), 0.92}};
  EXPECT_EQ(verdict(cube_without_externals(), sphere), OctreeVerdict::kLeak);
  EXPECT_EQ(verdict(cube, sphere), OctreeVerdict::kCovered);
  // Spheres that touch leave a point of S between them.
  cube.spheres = {{{0, 0.5, 0.5}, 0.5}, {{1, 0.5, 0.5}, 0.5}};
  EXPECT_NE(verdict(cube, {{{0.5, 0, 0.5}, 0.4}}), OctreeVerdict::kCovered);
}

class OctreeProofOfZoo : public testing::TestWithParam<std::tuple<CoverMethod, ExternalPlacement>> {
};

TEST_P(OctreeProofOfZoo, EveryCoverIsProvedAgain) {
  CoverOptions options;
  options.method = std::get<0>(GetParam());
  FitShares shares;
  shares.placement = std::get<1>(GetParam());
  if (kSanitized) shares.max_error *= 2.0;
  for (const NamedMesh& named : zoo_to_fit()) {
    SCOPED_TRACE(named.name);
    const Fit fitted = fit(named.mesh, options, shares);
    const OctreeProof proof = prove_by_octree(fitted.external, fitted.cover.spheres);
    EXPECT_EQ(proof.verdict, OctreeVerdict::kCovered) << "at " << proof.point.transpose();
    EXPECT_GT(proof.cubes, 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(Zoo, OctreeProofOfZoo,
                         testing::Combine(testing::Values(CoverMethod::kCover, CoverMethod::kPaper),
                                          testing::Values(ExternalPlacement::kReachable,
                                                          ExternalPlacement::kRandom,
                                                          ExternalPlacement::kNone)));

// Both proofs are one-sided: neither is content with a set that the other finds a leak in.
TEST(OctreeProof, AgreesWithTheCertificateOnSpoiltCovers) {
  Random random(111);
  int leaks = 0;
  int covers = 0;
  CoverOptions options;
  options.method = CoverMethod::kPaper;
  for (const NamedMesh& named : zoo_to_fit()) {
    SCOPED_TRACE(named.name);
    const Fit fitted = fit(named.mesh, options);
    for (int round = 0; round < effort(4, 2); ++round) {
      const double share = std::pow(10.0, -1.0 - round);
      std::vector<Sphere> spheres = fitted.cover.spheres;
      for (Sphere& s : spheres) s.radius -= random.between(0.0, share) * fitted.max_error;
      const Certificate certificate = certificate_of(named.mesh, fitted, spheres);
      const OctreeProof proof = prove_by_octree(fitted.external, spheres, 20, 60'000);
      if (proof.verdict == OctreeVerdict::kLeak) {
        ++leaks;
        ASSERT_FALSE(certificate.covered);
        ASSERT_TRUE(is_in_solid(proof.point, fitted.external));
        ASSERT_GT(gap_to_spheres(proof.point, spheres), 0.0L);
      }
      if (proof.verdict == OctreeVerdict::kCovered) {
        ++covers;
        ASSERT_EQ(certificate.solid_depth.lower, 0.0);
      }
    }
  }
  EXPECT_GE(leaks, effort(10, 2));
  EXPECT_GE(covers, effort(10, 2));
}

}  // namespace
}  // namespace spherule::test::octree_proof_test
