// SPDX-License-Identifier: BSD-3-Clause
// What leaks, as points and as a surface, and what repair() makes of it.
#include "simplifier/repair.h"

#include "simplifier/leaks.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/simplifier/octree_proof.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using Spheres = std::vector<Sphere>;

const Vector3d kMiddle = Vector3d::Constant(0.5);

// What repair() promises, by the certificate, by an independent proof and by samples.
Repair expect_repaired(const TriangleMesh& mesh, const Fit& fitted, Spheres leaking,
                       double max_error) {
  Repair result =
      repair(mesh, fitted.external, leaking, {.max_error = max_error, .effort = effort(4, 1)});
  const Spheres& spheres = result.spheres;
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
  const OctreeProof proof = prove_by_octree(fitted.external, spheres, 26, samples(300'000, 60'000));
  EXPECT_NE(proof.verdict, OctreeVerdict::kLeak) << proof.point.transpose();
  Random random(91);
  const std::size_t count = samples(4000, 400);
  EXPECT_EQ(judge_cover(points_of_solid(fitted.external, count, random), spheres).uncovered, 0U);
  EXPECT_EQ(judge_cover(points_on_surface(mesh, count, random), spheres).uncovered, 0U);
  Spheres changed;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (i >= leaking.size() || leaking[i].radius > 0.0) changed.push_back(spheres[i]);
  }
  const Certificate of_changed = certificate_of(mesh, fitted, changed);
  EXPECT_LE(*of_changed.protrusion_over_simplified_max, max_error);
  EXPECT_EQ(judge_protrusion(changed, mesh, fitted.external, max_error + 1e-9 * diagonal_of(mesh),
                             samples(10, 3), random)
                .beyond,
            0U);
  return result;
}

Fit fit_of(const TriangleMesh& mesh, CoverMethod method = CoverMethod::kCover) {
  return fit(mesh, options_for(method));
}

// None at all, and spheres about points outside of S, which are all there is at the corners and may
// not grow to hold them.
TEST(RepairOf, NoSpheresAndSpheresBesideTheSolid) {
  const TriangleMesh mesh = cube_mesh();
  const Fit fitted = fit(mesh, options_for(CoverMethod::kCover), {.max_error = 0.07});
  Spheres beside;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d at(corner % 2, corner / 2 % 2, corner / 4);
    beside.push_back({at + 0.08 * (at - kMiddle), 0.04});
  }
  const Repair of_none = expect_repaired(mesh, fitted, {}, fitted.max_error);
  EXPECT_LE(of_none.added, fitted.cover.spheres.size() + 3);
  EXPECT_EQ(expect_repaired(mesh, fitted, beside, fitted.max_error).inflated, 0U);
}

// Covers that are whole, that lack some spheres, whose spheres are shrunk; the paper's spheres
// before inflation; spheres anywhere.
TEST(RepairOf, CoversThatLeak) {
  int leaked = 0;
  for (const char* name :
       effort(std::vector{"cube", "l-bracket", "torus", "open-box", "soup"}, 1)) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = mesh_named(name);
    const Fit fitted = fit_of(mesh);
    const double error = fitted.max_error;
    const Spheres& whole = fitted.cover.spheres;
    EXPECT_EQ(expect_repaired(mesh, fitted, whole, error).spheres, whole);
    Random random(92);
    Spheres fewer = whole;
    std::size_t taken = 0;
    for (; taken < 3 && fewer.size() > 1; ++taken) {
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(random.index(fewer.size())));
    }
    const Repair of_fewer = expect_repaired(mesh, fitted, fewer, error);
    // As many as were taken would do; a search may find a few more.
    EXPECT_LE(of_fewer.added, 2 * taken);
    EXPECT_GT(of_fewer.added, 0U);
    // All that is missing is within reach of the spheres: none has to be added, and none grows
    // beyond what it had.
    Spheres shrunk = whole;
    double taken_in_all = 0.0;
    for (Sphere& sphere : shrunk) {
      taken_in_all += 0.03 * sphere.radius;
      sphere.radius *= 0.97;
    }
    const Repair of_shrunk = expect_repaired(mesh, fitted, shrunk, error);
    EXPECT_EQ(of_shrunk.added, 0U);
    EXPECT_EQ(of_shrunk.inflated > 0, !certificate_of(mesh, fitted, shrunk).covered);
    EXPECT_LT(of_shrunk.total_inflation, taken_in_all);
    leaked += of_shrunk.inflated > 0 ? 1 : 0;
    const Eigen::AlignedBox3d box(Vector3d(fitted.external.box.min() - 0.3 * Vector3d::Ones()),
                                  Vector3d(fitted.external.box.max() + 0.3 * Vector3d::Ones()));
    Spheres junk;
    for (int i = 0; i < 20; ++i) junk.push_back({random.in_box(box), random.between(0.0, 0.3)});
    expect_repaired(mesh, fitted, junk, error);
  }
  EXPECT_GE(leaked, effort(3, 1));
  const Fit paper = fit_of(l_bracket(), CoverMethod::kPaper);
  const Repair of_paper =
      expect_repaired(l_bracket(), paper, paper.cover.spheres_before_inflation, paper.max_error);
  EXPECT_EQ(of_paper.added, 0U);
  EXPECT_LE(of_paper.largest_inflation, paper.max_error);
}

// Two prongs that spheres stand on, one of them far out; what leaks between them is mended by
// spheres that leave the gap free, as any do that protrude less than half of it.
TEST(RepairOf, OneFarSphereDoesNotLicenseTheOthers) {
  const TriangleMesh prongs = joined(box_mesh({0.0, 0.0, 0.0}, {10.0, 10.0, 60.0}),
                                     box_mesh({40.0, 0.0, 0.0}, {50.0, 10.0, 60.0}));
  const ExternalSpheres external =
      place_external_spheres(prongs, {.min_external_diameter = 16.0, .max_error = 4.0});
  Spheres leaking;
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

// --- leak points ---

// The distance to the surface of the unit cube.
double from_cube(const Vector3d& p) {
  const Vector3d inside = p.cwiseMin(Vector3d::Ones() - p);
  const Vector3d outside = (-inside).cwiseMax(0.0);
  return inside.minCoeff() >= 0.0 ? inside.minCoeff() : outside.norm();
}

TEST(LeakPoints, AreLeaksOfTheSurfaceAndMissNone) {
  Random random(20);
  const Eigen::AlignedBox3d room(Vector3d::Constant(-0.2), Vector3d::Constant(1.2));
  const LeakPointOptions options{.spacing = 0.02, .separation = 0.04, .max_count = 10000};
  const double diagonal = std::sqrt(3.0);
  std::size_t leaks_seen = 0;
  for (int round = 0; round < effort(12, 3); ++round) {
    Spheres spheres;
    for (int i = 0; i < 12; ++i) spheres.push_back({random.in_box(room), random.between(0.1, 0.6)});
    const auto leaks = leak_points(cube_mesh(), spheres, options);
    leaks_seen += leaks.size();
    for (std::size_t i = 0; i < leaks.size(); ++i) {
      EXPECT_LT(from_cube(leaks[i].point), 1e-15);
      EXPECT_GT(leaks[i].depth, 0.0);
      EXPECT_GE(gap_to_spheres(leaks[i].point, spheres), Real{leaks[i].depth});
      EXPECT_NEAR(static_cast<double>(gap_to_spheres(leaks[i].point, spheres)), leaks[i].depth,
                  1e-14);
      if (i > 0) {
        EXPECT_GE(leaks[i - 1].depth, leaks[i].depth);
      }
      for (std::size_t k = 0; k < i; ++k) {
        EXPECT_GT((leaks[i].point - leaks[k].point).norm(), options.separation * diagonal);
      }
    }
    // Every point of the surface that is deeper than the samples are apart has a leak nearby.
    const double reach = (options.separation + options.spacing) * diagonal;
    for (int sample = 0; sample < effort(500, 100); ++sample) {
      Vector3d p = random.in_box({Vector3d::Zero(), Vector3d::Ones()});
      p[static_cast<int>(random.index(3))] = random.index(2) == 0 ? 0.0 : 1.0;
      if (gap_to_spheres(p, spheres) < options.spacing * diagonal) continue;
      EXPECT_TRUE(std::any_of(leaks.begin(), leaks.end(), [&](const LeakPoint& leak) {
        return (leak.point - p).norm() <= reach;
      }));
    }
  }
  EXPECT_GT(leaks_seen, 100u);
}

TEST(LeakPoints, AreTheCornersThatASphereInTheMiddleLeaves) {
  const Spheres sphere{{kMiddle, 0.8}};
  const auto leaks = leak_points(cube_mesh(), sphere);
  ASSERT_GE(leaks.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(leaks[i].depth, std::sqrt(0.75) - 0.8, 1e-14);
  }
  EXPECT_EQ(leak_points(cube_mesh(), sphere, {.max_count = 3}).size(), 3u);
}

// Far from the origin the samples that are requested are closer than coordinates are to each other.
TEST(LeakPoints, PiecesThatRoundingCannotHalveAreNotHalved) {
  TriangleMesh mesh = cube_mesh();
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex.x() += 9e14;
  EXPECT_FALSE(leak_points(mesh, Spheres{{{5, 0, 0}, 0.3}}).empty());
}

// --- leak surface ---

// Twice the area, and outwards.
Vector3d normal_of(const std::array<Vector3d, 3>& t) {
  return (t[1] - t[0]).cross(t[2] - t[0]);
}

// A sphere about the middle of the unit cube covers a disc of each face.
TEST(LeakSurface, IsTheCubeWithoutADiscOfEachFace) {
  for (const double radius : {0.52, 0.6, 0.7}) {
    const LeakSurface leaks = leak_surface(cube_mesh(), Spheres{{kMiddle, radius}});
    const double disc = std::numbers::pi * (radius * radius - 0.25);
    ASSERT_EQ(leaks.depths.size(), leaks.mesh.vertices.size());
    for (std::size_t i = 0; i < leaks.depths.size(); ++i) {
      const Vector3d& point = leaks.mesh.vertices[i];
      // On a face, as deep as it is told; what is interpolated is not far off.
      EXPECT_LT(std::min(point.minCoeff(), 1.0 - point.maxCoeff()), 1e-12);
      const double depth = (point - kMiddle).norm() - radius;
      EXPECT_NEAR(leaks.depths[i], depth, leaks.depths[i] > 0.0 ? 1e-12 : 1e-4);
    }
    double area = 0.0;
    for (const Eigen::Vector3i& triangle : leaks.mesh.triangles) {
      const std::array<Vector3d, 3> t = corners_of(leaks.mesh, triangle);
      area += 0.5 * normal_of(t).norm();
      EXPECT_GE(normal_of(t).dot((t[0] + t[1] + t[2]) / 3.0 - kMiddle), 0.0);
    }
    EXPECT_NEAR(area, 6.0 * (1.0 - disc), 1e-3) << radius;
  }
}

// --- of both ---

TEST(Leaks, AreNoneWhereAllIsCoveredOrNothingIs) {
  for (const Spheres& spheres : {Spheres{{kMiddle, 0.9}}, Spheres{}}) {
    EXPECT_TRUE(leak_points(cube_mesh(), spheres).empty());
    EXPECT_TRUE(leak_surface(cube_mesh(), spheres).mesh.triangles.empty());
  }
}

}  // namespace
}  // namespace spherule::test
