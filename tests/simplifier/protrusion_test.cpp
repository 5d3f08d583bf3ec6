// SPDX-License-Identifier: BSD-3-Clause
// G2: nothing protrudes by more than E, whatever external spheres there are.
#include "simplifier/simplify.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

class Protrusion : public testing::TestWithParam<CoverMethod> {
 protected:
  CoverOptions options() const { return options_for(GetParam()); }
};

void expect_nothing_beyond_the_error(const TriangleMesh& mesh, const Fit& fitted) {
  const std::vector<Sphere>& spheres = fitted.cover.spheres;
  const Certificate certificate = certificate_of(mesh, fitted, spheres);
  EXPECT_TRUE(certificate.covered);
  ASSERT_TRUE(certificate.protrusion_over_simplified_max.has_value());
  EXPECT_LE(*certificate.protrusion_over_simplified_max, fitted.max_error);
  Random random(83);
  const double slack = 1e-9 * fitted.external.box.diagonal().norm();
  const ProtrusionJudgement judged =
      judge_protrusion(spheres, mesh, fitted.external, fitted.max_error + slack,
                       static_cast<std::size_t>(effort(24, 6)), random);
  EXPECT_EQ(judged.beyond, 0U) << "of " << judged.points << ", one at "
                               << judged.example.transpose();
}

// Eight spheres about the corners of a cube that leave no room in its middle, by `depth`. The solid
// begins about 1 above that. The box is such that its halves do not fit the cube.
ExternalSpheres pinched(double depth) {
  ExternalSpheres external;
  external.box = Eigen::AlignedBox3d(Vector3d(-0.07, -0.03, -0.05), Vector3d(1.01, 1.02, 4));
  for (int i = 0; i < 8; ++i) {
    external.spheres.push_back({Vector3d(i & 1, i >> 1 & 1, i >> 2 & 1), std::sqrt(0.75) + depth});
  }
  return external;
}

// Where the solid is empty by less than the search resolves uncovered points of it, a sphere
// would protrude by the whole way to the solid.
TEST_P(Protrusion, NoSphereStandsWhereExternalSpheresOnlyJustCloseTheSolid) {
  const TriangleMesh mesh = box_mesh({0.2, 0.2, 3.8}, {0.8, 0.8, 4});
  for (const double depth : {1e-3, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6}) {
    SCOPED_TRACE(depth);
    Fit fitted;
    fitted.external = pinched(depth);
    CoverOptions options = this->options();
    fitted.max_error = options.max_error = 0.3;
    fitted.cover = cover(mesh, fitted.external, options);
    for (const Sphere& s : fitted.cover.spheres) EXPECT_GT(s.center.z(), 1.0);
    expect_nothing_beyond_the_error(mesh, fitted);
  }
}

TEST_P(Protrusion, NothingProtrudesHoweverExternalSpheresArePlaced) {
  for (const NamedMesh& named : zoo_to_fit()) {
    SCOPED_TRACE(named.name);
    for (const ExternalPlacement placement :
         {ExternalPlacement::kRandom, ExternalPlacement::kNone}) {
      FitShares shares;
      shares.placement = placement;
      expect_nothing_beyond_the_error(named.mesh, fit(named.mesh, options(), shares));
    }
  }
}

// The inside of an open mesh counts for the upper bound and is further from the mesh than what is
// seen to protrude, which that does not hide.
TEST(ProtrusionOverMesh, IsWitnessedBeyondAnOpenMeshToo) {
  const TriangleMesh loosely_shut =
      joined(open_box(), box_mesh({0.0, 0.0, 1.001}, {1.0, 1.0, 1.01}));
  const std::vector<Sphere> sphere{{Vector3d::Constant(0.5), 0.7}};
  const ExternalSpheres box =
      place_external_spheres(loosely_shut, {.placement = ExternalPlacement::kNone});
  CertifyOptions options;
  options.external = &box;
  const Bounds protrusion = certify(loosely_shut, sphere, options).protrusion_over_mesh.value();
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
    CertifyOptions options;
    options.external = &external;
    for (const double radius : {1.0, 1.3, 1.7}) {
      const std::vector<Sphere> spheres{{Vector3d::Zero(), radius}, {turn.col(0) * 0.2, 0.5}};
      const Bounds protrusion = certify(cube, spheres, options).protrusion_over_mesh.value();
      EXPECT_NEAR(protrusion.upper, radius - 1.0, 1e-12);
      EXPECT_NEAR(protrusion.lower, radius - 1.0, 1e-12);
    }
  }
}

// Cells that are as small as the resolution of coordinates contain no point that is computed to be
// in such spheres.
TEST(ProtrusionOverMesh, OfPointsFarFromTheOriginEnds) {
  const Vector3d far(4e7, -3e7, 7e7);
  const TriangleMesh cube = box_mesh(far, far + Vector3d::Ones());
  const ExternalSpheres box = place_external_spheres(cube, {.placement = ExternalPlacement::kNone});
  CertifyOptions options;
  options.external = &box;
  for (const double radius : {0.0, 1e-9, 1e-7}) {
    const std::vector<Sphere> spheres{{far + Vector3d(0.5, 0.5, 3.0), radius},
                                      {far + Vector3d(0.5, 0.5, 0.5), radius}};
    const Bounds protrusion = certify(cube, spheres, options).protrusion_over_mesh.value();
    EXPECT_NEAR(protrusion.upper, 2.0, 1e-6);
    EXPECT_NEAR(protrusion.lower, 2.0, 1e-6);
  }
}

// The bound of the large sphere, whose centre is near a hollow, is far too large, so that cells
// about the point have to be searched, whatever their size.
TEST(ProtrusionOverMesh, OfAPointFarFromTheOriginIsBoundedByItsCells) {
  const Vector3d far(4e7, -3e7, 7e7);
  TriangleMesh hollow = box_mesh(far + Vector3d::Constant(4.75), far + Vector3d::Constant(5.25));
  for (Eigen::Vector3i& triangle : hollow.triangles) std::swap(triangle[0], triangle[1]);
  const TriangleMesh mesh = joined(box_mesh(far, far + Vector3d::Constant(10.0)), hollow);
  const ExternalSpheres box = place_external_spheres(mesh, {.placement = ExternalPlacement::kNone});
  CertifyOptions options;
  options.external = &box;
  Random random(43);
  for (int i = 0; i < effort(40, 10); ++i) {
    const Vector3d point =
        far + Vector3d(random.between(1, 9), random.between(1, 9), random.between(10.9, 11.1));
    const double away = point.z() - (far.z() + 10.0);
    const std::vector<Sphere> spheres{{far + Vector3d(5.0, 5.0, 5.55), 2.0}, {point, 0.0}};
    const Bounds protrusion = certify(mesh, spheres, options).protrusion_over_mesh.value();
    EXPECT_GE(protrusion.upper, away);
    EXPECT_LE(protrusion.upper, away + 1e-3);
    EXPECT_LE(protrusion.lower, away);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Protrusion,
                         testing::Values(CoverMethod::kCover, CoverMethod::kPaper),
                         [](const auto& tested) { return name_of(tested.param); });

}  // namespace
}  // namespace spherule::test
