// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/simplify.h"

#include "base/error.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

class CoverOfZoo : public testing::TestWithParam<std::tuple<std::size_t, CoverMethod>> {
 protected:
  TriangleMesh mesh() const { return mesh_zoo().at(std::get<0>(GetParam())).mesh; }
  CoverOptions options() const { return options_for(std::get<1>(GetParam())); }
};

// Without any volume, whose solid is as thin as the external spheres leave it.
bool is_sheet(const TriangleMesh& mesh) {
  return mesh.triangles.size() == three_fins().triangles.size();
}

void expect_covered(const TriangleMesh& mesh, const Fit& fitted, std::uint64_t seed) {
  const std::vector<Sphere>& spheres = fitted.cover.spheres;
  const Certificate certificate = certificate_of(mesh, fitted, spheres);
  EXPECT_TRUE(certificate.covered);
  EXPECT_EQ(certificate.uncovered_depth.upper, 0.0);

  Random random(seed);
  const auto count = static_cast<std::size_t>(effort(6000, 600));
  std::vector<Vector3d> surface = points_on_surface(mesh, count, random);
  for (Vector3d& p : surface) p += 0.999999 * fitted.external.padding * random.direction();
  const std::vector<Vector3d> solid = points_of_solid(fitted.external, count, random);
  // Of sheets without a volume few points are met, and nearly all of the others.
  EXPECT_GE(solid.size(), is_sheet(mesh) ? 10U : count / 3);
  EXPECT_EQ(judge_cover(surface, spheres).uncovered, 0U);
  EXPECT_EQ(judge_cover(solid, spheres).uncovered, 0U);
}

TEST_P(CoverOfZoo, TheSolidIsCoveredAndNothingProtrudesByMoreThanTheError) {
  const TriangleMesh mesh = this->mesh();
  const Fit fitted = fit(mesh, options());
  expect_covered(mesh, fitted, 71);

  const double size = diagonal_of(mesh);
  Random random(72);
  const ProtrusionJudgement protrusion =
      judge_protrusion(fitted.cover.spheres, mesh, fitted.external, fitted.max_error + 1e-9 * size,
                       static_cast<std::size_t>(effort(24, 6)), random);
  EXPECT_EQ(protrusion.beyond, 0U)
      << "of " << protrusion.points << ", one at " << protrusion.example.transpose();
  const Certificate certificate = certificate_of(mesh, fitted, fitted.cover.spheres);
  ASSERT_TRUE(certificate.protrusion_over_simplified_max.has_value());
  EXPECT_LE(*certificate.protrusion_over_simplified_max, fitted.max_error);
}

INSTANTIATE_TEST_SUITE_P(Zoo, CoverOfZoo,
                         testing::Combine(testing::Range(std::size_t{0}, zoo_to_fit().size()),
                                          testing::Values(CoverMethod::kCover,
                                                          CoverMethod::kPaper)),
                         [](const auto& tested) {
                           std::string name = mesh_zoo().at(std::get<0>(tested.param)).name + "_" +
                                              name_of(std::get<1>(tested.param));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

class CoverByMethod : public testing::TestWithParam<CoverMethod> {
 protected:
  CoverOptions options() const { return options_for(GetParam()); }
};

TEST_P(CoverByMethod, IsEqualInEveryRunOnAnyNumberOfThreads) {
  for (const char* name : effort(std::vector{"l-bracket", "soup"}, 1)) {
    const TriangleMesh mesh = mesh_named(name);
    CoverOptions options = this->options();
    const std::vector<Sphere> first = fit(mesh, options).cover.spheres;
    EXPECT_EQ(fit(mesh, options).cover.spheres, first);
    for (const int threads : {1, 2}) {
      options.threads = threads;
      EXPECT_EQ(fit(mesh, options).cover.spheres, first);
    }
  }
}

TEST_P(CoverByMethod, EveryWayToPlaceExternalSpheresGivesACoveredSolid) {
  for (const ExternalPlacement placement : {ExternalPlacement::kRandom, ExternalPlacement::kNone}) {
    const TriangleMesh mesh = l_bracket();
    FitShares shares;
    shares.placement = placement;
    expect_covered(mesh, fit(mesh, options(), shares), 73);
  }
}

TEST_P(CoverByMethod, WithPaddingTheGrownMeshIsCovered) {
  const std::vector<std::pair<const char*, double>> cases = {
      {"three-fins", 3.0}, {"open-box", 0.1}, {"cube", 0.9},
      {"three-fins", 0.1}, {"open-box", 3.0}, {"l-bracket", 0.9}};
  for (const auto& [name, padding] : effort(cases, 2)) {
    SCOPED_TRACE(name);
    SCOPED_TRACE(padding);
    TriangleMesh mesh = mesh_named(name);
    mesh.vertex_error = 1e-3;
    FitShares shares;
    shares.padding = padding;
    expect_covered(mesh, fit(mesh, options(), shares), 74);
  }
}

TEST_P(CoverByMethod, NoSphereIsSmallerThanTheLeastRadius) {
  const TriangleMesh mesh = mesh_named("open-box");
  for (const double share : effort(std::vector{2.5, 5.0, 1.0}, 2)) {
    CoverOptions options = this->options();
    options.min_radius = share * FitShares{}.max_error * diagonal_of(mesh);
    const Fit fitted = fit(mesh, options);
    for (const Sphere& s : fitted.cover.spheres) ASSERT_GE(s.radius, options.min_radius);
    expect_covered(mesh, fitted, 75);
  }
}

// Sizes and places far from one.
TEST_P(CoverByMethod, ScaleAndPlaceDoNotMatter) {
  for (const double scale : {1e-6, 1e6}) {
    for (const Vector3d& shift : {Vector3d(0, 0, 0), Vector3d(1e4, -1e4, 1e4)}) {
      TriangleMesh mesh = l_bracket();
      for (Vector3d& v : mesh.vertices) v = scale * (v + shift);
      expect_covered(mesh, fit(mesh, options()), 76);
    }
  }
}

TEST_P(CoverByMethod, OptionsOfOtherMethodsHaveNoEffect) {
  const TriangleMesh mesh = mesh_named("l-bracket");
  CoverOptions others = options();
  FitShares shares;  // with the effort
  if (others.method == CoverMethod::kCover) {
    others.min_internal_diameter = 0.01;
    others.history = true;
  } else {
    shares.effort += 1;
    others.seconds = 1e-9;
    others.lower_bound = true;
    others.on_proved = [](std::size_t) { FAIL(); };
  }
  const SphereCover expected = fit(mesh, options()).cover;
  const SphereCover found = fit(mesh, others, shares).cover;
  EXPECT_EQ(found.spheres, expected.spheres);
  EXPECT_TRUE(found.history.empty());
  EXPECT_EQ(found.lower_bound, 0U);
}

TEST_P(CoverByMethod, BadOptionsAreRefusedByName) {
  const TriangleMesh mesh = cube_mesh();
  const ExternalSpheres external = externals_of(mesh, {});
  const auto refused = [&](const CoverOptions& options) -> std::string {
    try {
      cover(mesh, external, options);
    } catch (const Error& error) {
      return error.subject();
    }
    return "accepted";
  };
  CoverOptions good = options();
  good.max_error = 0.3;
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), 1e300}) {
    CoverOptions bad_options = good;
    bad_options.max_error = bad;
    EXPECT_EQ(refused(bad_options), "max error");
    bad_options = good;
    bad_options.min_radius = bad;
    EXPECT_EQ(refused(bad_options), "min radius");
    bad_options = good;
    bad_options.min_internal_diameter = bad;
    EXPECT_EQ(refused(bad_options), "min internal diameter");
  }
  CoverOptions none = good;
  none.max_error = 0.0;
  EXPECT_EQ(refused(none), "max error");
  EXPECT_EQ(refused(good), "accepted");
}

INSTANTIATE_TEST_SUITE_P(Methods, CoverByMethod,
                         testing::Values(CoverMethod::kCover, CoverMethod::kPaper),
                         [](const auto& tested) { return name_of(tested.param); });

}  // namespace
}  // namespace spherule::test
