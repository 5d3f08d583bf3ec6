// SPDX-License-Identifier: BSD-3-Clause
// cover() by both methods before judges that share no code with it: that S is covered (G1), proved
// again by an octree and by samples, and that nothing protrudes by more than E (G2). Then what is
// particular to the paper's loop, and what the spheres of a cover are for.
#include "simplifier/cover_breakdown.h"
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
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stop_token>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using Spheres = std::vector<Sphere>;

const Vector3d kMiddle = Vector3d::Constant(0.5);

// Without any volume, whose solid is as thin as the external spheres leave it.
bool is_sheet(const TriangleMesh& mesh) {
  return mesh.triangles.size() == three_fins().triangles.size();
}

void expect_covered(const TriangleMesh& mesh, const Fit& fitted, std::uint64_t seed) {
  const Spheres& spheres = fitted.cover.spheres;
  const Certificate certificate = certificate_of(mesh, fitted, spheres);
  EXPECT_TRUE(certificate.covered);
  EXPECT_EQ(certificate.uncovered_depth.upper, 0.0);

  Random random(seed);
  const std::size_t count = samples(6000, 600);
  std::vector<Vector3d> surface = points_on_surface(mesh, count, random);
  for (Vector3d& p : surface) p += 0.999999 * fitted.external.padding * random.direction();
  const std::vector<Vector3d> solid = points_of_solid(fitted.external, count, random);
  // Of sheets without a volume few points are met, and nearly all of the others.
  EXPECT_GE(solid.size(), is_sheet(mesh) ? 10U : count / 3);
  EXPECT_EQ(judge_cover(surface, spheres).uncovered, 0U);
  EXPECT_EQ(judge_cover(solid, spheres).uncovered, 0U);
}

void expect_nothing_beyond_the_error(const TriangleMesh& mesh, const Fit& fitted) {
  const Spheres& spheres = fitted.cover.spheres;
  const Certificate certificate = certificate_of(mesh, fitted, spheres);
  EXPECT_TRUE(certificate.covered);
  ASSERT_TRUE(certificate.protrusion_over_simplified_max.has_value());
  EXPECT_LE(*certificate.protrusion_over_simplified_max, fitted.max_error);
  Random random(83);
  const double slack = 1e-9 * fitted.external.box.diagonal().norm();
  const ProtrusionJudgement judged = judge_protrusion(
      spheres, mesh, fitted.external, fitted.max_error + slack, samples(24, 6), random);
  EXPECT_EQ(judged.beyond, 0U) << "of " << judged.points << ", one at "
                               << judged.example.transpose();
}

// Of the paper's loop: every sphere of the solid, free of all external spheres and within the box,
// inflated by the same error. A point, a sphere of radius zero, may stand where a sliver of S is
// too thin to be found, just outside of it.
void expect_inflated(const Fit& fitted) {
  const SphereCover& cover = fitted.cover;
  EXPECT_GT(cover.inflation, 0.0);
  EXPECT_LE(cover.inflation, fitted.max_error);
  ASSERT_EQ(cover.spheres.size(), cover.spheres_before_inflation.size());
  for (std::size_t i = 0; i < cover.spheres.size(); ++i) {
    const Sphere& s = cover.spheres_before_inflation[i];
    ASSERT_EQ(cover.spheres[i].center, s.center);
    ASSERT_GE(cover.spheres[i].radius, s.radius + cover.inflation);
    ASSERT_LE(cover.spheres[i].radius, (s.radius + cover.inflation) * (1.0 + 1e-15));
    const double off = (s.radius == 0.0 ? 1e-3 : 1e-15) * fitted.max_error;
    ASSERT_GE(gap_to_spheres(s.center, fitted.external.spheres), s.radius - off);
    ASSERT_GE((s.center - fitted.external.box.min()).minCoeff(), s.radius - off);
    ASSERT_GE((fitted.external.box.max() - s.center).minCoeff(), s.radius - off);
  }
}

class CoverOfZoo : public testing::TestWithParam<std::tuple<std::size_t, CoverMethod>> {};

TEST_P(CoverOfZoo, TheSolidIsCoveredAndNothingProtrudesByMoreThanTheError) {
  const TriangleMesh mesh = mesh_zoo().at(std::get<0>(GetParam())).mesh;
  const CoverMethod method = std::get<1>(GetParam());
  for (const ExternalPlacement placement :
       {ExternalPlacement::kReachable, ExternalPlacement::kRandom, ExternalPlacement::kNone}) {
    SCOPED_TRACE(static_cast<int>(placement));
    const Fit fitted = fit(mesh, options_for(method), {.placement = placement});
    expect_covered(mesh, fitted, 71);
    expect_nothing_beyond_the_error(mesh, fitted);
    const OctreeProof proof = prove_by_octree(fitted.external, fitted.cover.spheres);
    EXPECT_EQ(proof.verdict, OctreeVerdict::kCovered) << "at " << proof.point.transpose();
    EXPECT_GT(proof.cubes, 0U);
    if (method == CoverMethod::kPaper) expect_inflated(fitted);
  }
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

TEST_P(CoverByMethod, WithPaddingTheGrownMeshIsCovered) {
  const std::vector<std::pair<const char*, double>> cases = {
      {"three-fins", 3.0}, {"open-box", 0.1}, {"cube", 0.9},
      {"three-fins", 0.1}, {"open-box", 3.0}, {"l-bracket", 0.9}};
  for (const auto& [name, padding] : effort(cases, 2)) {
    SCOPED_TRACE(name);
    SCOPED_TRACE(padding);
    TriangleMesh mesh = mesh_named(name);
    mesh.vertex_error = 1e-3;
    expect_covered(mesh, fit(mesh, options(), {.padding = padding}), 74);
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

// Where the solid is empty by less than the search resolves uncovered points of it, a sphere
// would protrude by the whole way to the solid. Eight external spheres about the corners of a cube
// leave no room in its middle, by `depth`; the solid begins about 1 above that. The box is such
// that its halves do not fit the cube.
TEST_P(CoverByMethod, NoSphereStandsWhereExternalSpheresOnlyJustCloseTheSolid) {
  const TriangleMesh mesh = box_mesh({0.2, 0.2, 3.8}, {0.8, 0.8, 4});
  for (const double depth : {1e-3, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6}) {
    SCOPED_TRACE(depth);
    Fit fitted;
    fitted.max_error = 0.3;
    fitted.external.box = {Vector3d(-0.07, -0.03, -0.05), Vector3d(1.01, 1.02, 4)};
    for (int i = 0; i < 8; ++i) {
      fitted.external.spheres.push_back(
          {Vector3d(i & 1, i >> 1 & 1, i >> 2 & 1), std::sqrt(0.75) + depth});
    }
    CoverOptions options = this->options();
    options.max_error = fitted.max_error;
    fitted.cover = cover(mesh, fitted.external, options);
    for (const Sphere& s : fitted.cover.spheres) EXPECT_GT(s.center.z(), 1.0);
    expect_nothing_beyond_the_error(mesh, fitted);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, CoverByMethod,
                         testing::Values(CoverMethod::kCover, CoverMethod::kPaper),
                         [](const auto& tested) { return name_of(tested.param); });

// --- a search that is told to stop ends with what it has proved ---

TEST(CoverStop, EndsWithWhatIsProved) {
  const TriangleMesh mesh = l_bracket();
  const FitShares shares{.max_error = kSanitized ? 0.12 : 0.05};
  const ExternalSpheres external = externals_of(mesh, shares);
  CoverOptions options{.max_error = shares.max_error * diagonal_of(mesh), .effort = 0};
  const Spheres first = cover(mesh, external, options).spheres;
  // Requested beforehand: the first answer.
  options.effort = std::numeric_limits<int>::max();
  std::stop_source before;
  before.request_stop();
  options.stop = before.get_token();
  options.lower_bound = true;
  const SphereCover unsearched = cover(mesh, external, options);
  EXPECT_EQ(unsearched.spheres, first);
  EXPECT_EQ(unsearched.lower_bound, 0U);
  EXPECT_TRUE(certify(mesh, unsearched.spheres, {.external = &external}).covered);
  // With the second answer: the search would go on for hours.
  options.lower_bound = false;
  std::stop_source stop;
  options.stop = stop.get_token();
  std::vector<std::size_t> counts;
  options.on_proved = [&](std::size_t count) {
    counts.push_back(count);
    if (counts.size() == 2) stop.request_stop();
  };
  const Spheres searched = cover(mesh, external, options).spheres;
  ASSERT_EQ(counts.size(), 2U);
  EXPECT_LT(counts[1], counts[0]);
  EXPECT_EQ(searched.size(), counts[1]);
  EXPECT_TRUE(certify(mesh, searched, {.external = &external}).covered);
}

// --- the octree's proof itself ---

ExternalSpheres cube_without_externals() {
  ExternalSpheres external;
  external.box = Eigen::AlignedBox3d(Vector3d(0, 0, 0), Vector3d(1, 1, 1));
  return external;
}

OctreeVerdict verdict(const ExternalSpheres& external, const Spheres& spheres) {
  return prove_by_octree(external, spheres).verdict;
}

TEST(OctreeProof, ACubeIsCoveredByItsCircumscribedSphereAndByNoSmallerOne) {
  const ExternalSpheres cube = cube_without_externals();
  const double radius = std::sqrt(0.75);
  EXPECT_EQ(verdict(cube, {{kMiddle, radius + 1e-12}}), OctreeVerdict::kCovered);
  EXPECT_EQ(verdict(cube, {}), OctreeVerdict::kLeak);
  for (const double less : {1e-3, 1e-6, 1e-8}) {
    const OctreeProof proof = prove_by_octree(cube, Spheres{{kMiddle, radius - less}});
    EXPECT_EQ(proof.verdict, OctreeVerdict::kLeak) << less;
    EXPECT_NEAR((proof.point - kMiddle).norm(), radius, less);
  }
}

TEST(OctreeProof, WhatExternalSpheresTakeNeedNotBeCovered) {
  ExternalSpheres cube = cube_without_externals();
  cube.spheres = {{{0, 0, 0}, 0.5}};
  // Reaches every corner but the one that is taken.
  const Spheres sphere{{Vector3d::Constant(0.55), 0.92}};
  EXPECT_EQ(verdict(cube_without_externals(), sphere), OctreeVerdict::kLeak);
  EXPECT_EQ(verdict(cube, sphere), OctreeVerdict::kCovered);
  // Spheres that touch leave a point of S between them.
  cube.spheres = {{{0, 0.5, 0.5}, 0.5}, {{1, 0.5, 0.5}, 0.5}};
  EXPECT_NE(verdict(cube, {{{0.5, 0, 0.5}, 0.4}}), OctreeVerdict::kCovered);
}

// --- the paper's loop ---

Fit paper_fit(const TriangleMesh& mesh, const FitShares& shares = {}) {
  return fit(mesh, options_for(CoverMethod::kPaper), shares);
}

// An audit of the spheres before inflation finds the leak, as deep as the loop itself says that the
// remaining error is.
TEST(InternalSpheres, AnAuditBeforeInflationFindsTheErrorOfTheLoop) {
  for (const TriangleMesh& mesh :
       {cube_mesh(), l_bracket(), torus(1.0, 0.3, 24, 12), open_box(), soup(20, 5)}) {
    const Fit fitted = paper_fit(mesh);
    const Spheres& before = fitted.cover.spheres_before_inflation;
    const Certificate certificate = certificate_of(mesh, fitted, before);
    const Bounds& depth = certificate.uncovered_depth;
    // The loop looks no closer than its target of 0.97 E; the inflation adds a reserve of 0.02 E.
    EXPECT_FALSE(certificate.covered);
    EXPECT_LE(depth.lower, fitted.cover.inflation);
    EXPECT_GE(depth.upper, fitted.cover.inflation - 0.12 * fitted.max_error);
    EXPECT_LE(depth.upper - depth.lower, 0.05 * fitted.max_error);
    ASSERT_GT(depth.lower, 0.0);
    // The witness stands up before the judge, and no sample is deeper than proved.
    EXPECT_TRUE(is_in_solid(certificate.deepest_leak, fitted.external));
    EXPECT_GE(gap_to_spheres(certificate.deepest_leak, before), depth.lower * (1.0 - 1e-12));
    Random random(81);
    const auto solid = points_of_solid(fitted.external, samples(4000, 400), random);
    EXPECT_LE(judge_cover(solid, before).depth, depth.upper);
  }
}

TEST(InternalSpheres, TheHistoryTellsOfBothErrorsBeforeAndAfter) {
  CoverOptions options = options_for(CoverMethod::kPaper);
  options.history = true;
  const TriangleMesh mesh = l_bracket();
  const Fit fitted = fit(mesh, options);
  const std::vector<CoverHistoryEntry>& history = fitted.cover.history;
  ASSERT_EQ(history.size(), fitted.cover.spheres.size());
  for (std::size_t i = 0; i < history.size(); ++i) {
    SCOPED_TRACE(i);
    const CoverHistoryEntry& e = history[i];
    EXPECT_EQ(e.sphere_count, i + 1);
    EXPECT_LE(e.max_error_lower, e.max_error_upper);
    // On the surface, a subset of S; figure 6 is about less than section II.B.
    EXPECT_LE(e.surface_error_before, e.max_error_upper + 1e-12);
    EXPECT_LE(e.surface_error_after, e.surface_error_before);
    // Inflated by the proved error, everything is covered at every step.
    EXPECT_LE(e.surface_error_after, 0.0);
    EXPECT_EQ(e.coverage_after, 1.0);
    EXPECT_LE(e.coverage_before, e.coverage_after);
    EXPECT_LE(e.excess_before, e.excess_after);
    if (i == 0) continue;
    const CoverHistoryEntry& last = history[i - 1];
    EXPECT_LE(e.max_error_upper, last.max_error_upper);
    EXPECT_LE(e.surface_error_before, last.surface_error_before);
    EXPECT_GE(e.coverage_before, last.coverage_before);
    EXPECT_GE(e.excess_before, last.excess_before);
  }
  EXPECT_LE(history.back().max_error_upper, fitted.max_error);
  EXPECT_GT(history.front().max_error_lower, fitted.max_error);
  EXPECT_GT(history.back().coverage_before, kSanitized ? 0.1 : 0.3);
  // The history is a by-product.
  const SphereCover without = paper_fit(mesh).cover;
  EXPECT_EQ(without.spheres, fitted.cover.spheres);
  EXPECT_TRUE(without.history.empty());
}

TEST(InternalSpheres, AnErrorBelowTheRoundingOfTheCoordinatesIsRefused) {
  const TriangleMesh mesh = box_mesh(Vector3d::Constant(1e9), Vector3d::Constant(1e9 + 1.0));
  CoverOptions options = options_for(CoverMethod::kPaper);
  options.max_error = 1e-4;
  EXPECT_NE(refused([&] { cover(mesh, box_of(mesh), options); }), "accepted");
}

// --- what the spheres of a cover are there for ---

CoverBreakdown breakdown_of(const TriangleMesh& mesh, const Fit& fitted) {
  CoverBreakdown result =
      cover_breakdown(mesh, fitted.external, fitted.cover.spheres, fitted.max_error);
  EXPECT_EQ(result.edges + result.thin + result.faces + result.inside, fitted.cover.spheres.size());
  return result;
}

// Some sphere along each of the twelve edges, in its middle half: at a point that two spheres cover
// neither is there for it.
TEST(CoverBreakdown, ACubeCostsItsEdgesWhicheverWayItsTrianglesFace) {
  const TriangleMesh mesh = cube_mesh();
  const Fit fitted = fit(mesh, {}, {.max_error = 0.06});
  const CoverBreakdown found = breakdown_of(mesh, fitted);
  EXPECT_EQ(breakdown_of(inverted(mesh), fitted).roles, found.roles);
  EXPECT_GE(2 * found.edges, fitted.cover.spheres.size());
  EXPECT_EQ(found.thin, 0U);
  for (int edge = 0; edge < 12; ++edge) {
    const int axis = edge / 4;
    Vector3d middle = kMiddle;
    middle[(axis + 1) % 3] = edge % 2;
    middle[(axis + 2) % 3] = edge / 2 % 2;
    bool is_paid_for = false;
    for (std::size_t i = 0; i < found.roles.size(); ++i) {
      const Sphere& sphere = fitted.cover.spheres[i];
      middle[axis] = std::clamp(sphere.center[axis], 0.25, 0.75);
      is_paid_for = is_paid_for || (found.roles[i] == SphereRole::kEdge &&
                                    (sphere.center - middle).norm() <= sphere.radius);
    }
    EXPECT_TRUE(is_paid_for) << edge;
  }
}

TEST(CoverBreakdown, APlateIsThin) {
  const TriangleMesh mesh = thin_sheet(0.01);
  const Fit fitted = fit(mesh, {}, {.max_error = 0.03});
  const CoverBreakdown found = breakdown_of(mesh, fitted);
  const std::size_t count = fitted.cover.spheres.size();
  EXPECT_GT(found.thin, kSanitized ? count / 3 : count / 2);
  EXPECT_GT(found.edges, 0U);
  EXPECT_EQ(found.faces, 0U);
}

// On the surface, as if the sphere inside were missing.
TEST(CoverBreakdown, ASphereHasFacesOnly) {
  const TriangleMesh mesh = icosphere(3);
  const FitShares shares{.max_error = 0.02};
  Spheres spheres;
  for (const Vector3d& v : mesh.vertices) spheres.push_back({0.8 * v, 0.22});
  const CoverBreakdown found = cover_breakdown(mesh, externals_of(mesh, shares), spheres,
                                               shares.max_error * diagonal_of(mesh));
  EXPECT_EQ(found.faces, spheres.size() - found.inside);
  EXPECT_GT(found.faces, spheres.size() / 3);
}

// A concave edge is no edge of S that costs spheres.
TEST(CoverBreakdown, ConcaveEdgesAreNone) {
  const TriangleMesh mesh = joined(box_mesh({0, 0, 0}, {1, 1, 1}), box_mesh({1, 0, 0}, {2, 2, 1}));
  const FitShares shares{.max_error = 0.03};
  const Spheres spheres = {{{1.0, 1.0, 0.5}, 0.1}, {{0.0, 0.0, 0.5}, 0.1}};
  const CoverBreakdown found = cover_breakdown(mesh, externals_of(mesh, shares), spheres,
                                               shares.max_error * diagonal_of(mesh));
  EXPECT_NE(found.roles[0], SphereRole::kEdge);
  EXPECT_EQ(found.roles[1], SphereRole::kEdge);
}

// Counted by the gaps to all external spheres and to the box.
TEST(SpheresInThinParts, AreThoseWhoseCentresAreNearTheOutside) {
  for (const bool is_plate : {true, false}) {
    const Fit fitted = fit(is_plate ? thin_sheet(0.01) : cube_mesh(), {}, {.max_error = 0.03});
    const Spheres& spheres = fitted.cover.spheres;
    const Eigen::AlignedBox3d& box = fitted.external.box;
    const auto thin = static_cast<std::size_t>(std::ranges::count_if(spheres, [&](const Sphere& s) {
      const double in_box =
          std::min((s.center - box.min()).minCoeff(), (box.max() - s.center).minCoeff());
      return std::min<Real>(in_box, gap_to_spheres(s.center, fitted.external.spheres)) <
             fitted.max_error;
    }));
    EXPECT_EQ(spheres_in_thin_parts(fitted.external, spheres, fitted.max_error), thin);
    EXPECT_TRUE(is_plate ? thin == spheres.size() : thin < spheres.size() / 2) << thin;
  }
}

}  // namespace
}  // namespace spherule::test
