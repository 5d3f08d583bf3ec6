// SPDX-License-Identifier: BSD-3-Clause
// Covers with zones of their own E: the spheres keep both errors, the certificate knows it, and the
// tool that made D does not notice the simplification.
#include "geometry/mesh_distance.h"
#include "simplifier/option_record.h"
#include "simplifier/simplify.h"
#include "tests/simplifier/fitting.h"
#include "tests/simplifier/judge.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr double kError = kSanitized ? 0.2 : 0.1;
constexpr double kZoneError = kSanitized ? 0.04 : 0.02;

bool holds(const ZoneShape& shape, const Vector3d& p) {
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return (p - sphere->center).norm() <= sphere->radius;
  }
  if (const auto* box = std::get_if<AlignedBox3d>(&shape)) return box->contains(p);
  const auto& capsule = std::get<ZoneCapsule>(shape);
  for (int i = 0; i <= 1000; ++i) {
    const Vector3d at = capsule.from + i / 1000.0 * (capsule.to - capsule.from);
    if ((p - at).norm() <= capsule.radius) return true;
  }
  return false;
}

// Of points in spheres and in the zone, densest on the spheres' surfaces: how many there are
// outside of S, and how many of these have no point of S within the error, where a sphere that
// holds them promises one: on the way to its centre.
struct ZoneJudgement {
  int outside = 0;
  int beyond = 0;
};

ZoneJudgement judge_zone(const Zone& zone, const std::vector<Sphere>& spheres,
                         const ExternalSpheres& external, double error, Random& random) {
  ZoneJudgement judgement;
  for (const Sphere& sphere : spheres) {
    for (int i = 0; i < effort(600, 150); ++i) {
      const Vector3d direction = random.direction();
      const double way = sphere.radius * (i % 2 == 0 ? 1.0 : random.between(0.7, 1.0));
      const Vector3d p = sphere.center + way * direction;
      if (!holds(zone.shape, p) || is_in_solid(p, external)) continue;
      ++judgement.outside;
      bool near = false;
      for (const double share : {0.5, 0.9, 1.0 + 1e-9}) {
        const double back = std::min(way, share * error);
        near = near || is_in_solid(sphere.center + (way - back) * direction, external);
      }
      if (!near) ++judgement.beyond;
    }
  }
  return judgement;
}

SimplifyOptions options_with(std::vector<Zone> zones) {
  return {.max_error = kError, .zones = std::move(zones), .effort = effort(4, 1)};
}

std::vector<Zone> zones_of_all_shapes() {
  return {{.shape = Sphere{{1, 1, 1}, 0.2}, .max_error = kZoneError},
          {.shape = AlignedBox3d(Vector3d(-0.3, -0.3, -0.3), Vector3d(0.2, 0.15, 0.1)),
           .max_error = 2.0 * kZoneError},
          {.shape = ZoneCapsule{{1, 0.2, 0}, {1, 0.5, 0}, 0.1}, .max_error = kZoneError}};
}

TEST(ZoneFit, NoPointOfASphereInAZoneIsFurtherFromTheSolidThanTheZoneAllows) {
  const TriangleMesh mesh = cube_mesh();
  Random random(81);
  const Simplification fit = simplify(mesh, options_with(zones_of_all_shapes()));
  EXPECT_EQ(broken_promises(fit), "");
  ASSERT_EQ(fit.certificate.protrusion_in_zones.size(), 3U);
  const Simplification coarse = simplify(mesh, options_with({}));
  for (std::size_t i = 0; i < 3; ++i) {
    const Zone& zone = fit.options.zones[i];
    EXPECT_LE(fit.certificate.protrusion_in_zones[i], *zone.max_error);
    EXPECT_GT(fit.certificate.protrusion_in_zones[i], 0.0);
    const ZoneJudgement judgement =
        judge_zone(zone, fit.cover.spheres, fit.external, *zone.max_error, random);
    EXPECT_GT(judgement.outside, effort(20, 5)) << i;
    EXPECT_EQ(judgement.beyond, 0) << i;
    // The judge is not blind: without zones the error is E there too.
    EXPECT_GT(
        judge_zone(zone, coarse.cover.spheres, coarse.external, *zone.max_error, random).beyond,
        effort(20, 2))
        << i;
  }
  // G1 and G2 as ever.
  const auto points = points_of_solid(fit.external, samples(20000, 2000), random);
  EXPECT_EQ(judge_cover(points, fit.cover.spheres).uncovered, 0U);
  EXPECT_EQ(
      judge_protrusion(fit.cover.spheres, mesh, fit.external, kError, samples(200, 40), random)
          .beyond,
      0U);
}

// A small zone makes its surroundings fine, not the whole part.
TEST(ZoneFit, ASmallZoneCostsLittle) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const Zone zone{.shape = Sphere{{1, 1, 1}, 0.1}, .max_error = kZoneError};
  const Simplification coarse = simplify(cube_mesh(), options_with({}));
  const Simplification fit = simplify(cube_mesh(), options_with({zone}));
  EXPECT_EQ(broken_promises(fit), "");
  const auto elsewhere = [](const std::vector<Sphere>& spheres) {
    return std::ranges::count_if(
        spheres, [](const Sphere& s) { return (s.center - Vector3d(1, 1, 1)).norm() > 0.4; });
  };
  EXPECT_LE(elsewhere(fit.cover.spheres), 5 * elsewhere(coarse.cover.spheres) / 4 + 2);
}

TEST(ZoneFit, ASphereThatReachesIntoAZoneTooFarIsBlamed) {
  const std::vector<Zone> zones = zones_of_all_shapes();
  Simplification fit = simplify(cube_mesh(), options_with({}));
  const Certificate certificate =
      certify(cube_mesh(), fit.cover.spheres, {.external = &fit.external, .zones = zones});
  fit.options.zones = zones;
  EXPECT_NE(broken_promises(fit).find("in zone 0"), std::string::npos);  // not even examined
  fit.certificate = certificate;
  EXPECT_NE(broken_promises(fit).find("in zone 0, only by at most " +
                                      std::string(kSanitized ? "0.2" : "0.1")),
            std::string::npos)
      << broken_promises(fit);
}

TEST(ZoneFit, ZonesSurviveTheRecordAndAnAuditPlacesTheSameExternalSpheres) {
  TriangleMesh mesh = l_bracket();
  SimplifyOptions options = options_with(zones_of_all_shapes());
  options.zones[1].min_external_diameter = 0.2;
  options.keep_concave_edges = true;
  options.effort = 0;
  const Simplification fit = simplify(mesh, options);
  const SphereFile file = sphere_file(fit, 1.0);
  const SimplifyOptions again = options_from_record(file.options);
  EXPECT_EQ(again.zones, options.zones);
  EXPECT_TRUE(again.keep_concave_edges);
  EXPECT_EQ(place_external_spheres(mesh, external_options(again)).spheres, fit.external.spheres);
  EXPECT_EQ(file.certificate->protrusion_in_zones, fit.certificate.protrusion_in_zones);
  EXPECT_FALSE(option_record({}, 1.0).contains("zones"));
  EXPECT_FALSE(option_record({}, 1.0).contains("keep-concave-edges"));
  EXPECT_THROW(options_from_record({{"zones", std::string("[]")}}), Error);
  EXPECT_THROW(options_from_record({{"zones", 1.0}}), Error);
  EXPECT_THROW(options_from_record({{"keep-concave-edges", 1.0}}), Error);
}

TEST(ZoneFit, WhatCannotBeDoneIsRefused) {
  const auto subject = [](const SimplifyOptions& options) {
    return refused([&] { simplify(cube_mesh(), options); });
  };
  const Zone zone{.shape = Sphere{{0, 0, 0}, 1.0}, .max_error = 0.05, .min_external_diameter = 0.1};
  SimplifyOptions options = options_with({zone});
  options.method = CoverMethod::kPaper;
  EXPECT_EQ(subject(options), "zones");
  options = options_with({zone});
  options.external = ExternalPlacement::kRandom;
  EXPECT_EQ(subject(options), "zones");
  options = options_with({zone, zone});
  options.zones[1].max_error = 2.0 * kError;
  EXPECT_EQ(subject(options), "zone 1");
  options.zones[1] = {.shape = zone.shape, .min_external_diameter = 5.0 * kError};
  EXPECT_EQ(subject(options), "zone 1");
}

// --- the right tool ---

TEST(Tool, DIsTheDiameterOfItsSmallestSphere) {
  EXPECT_EQ(tool_diameter(std::vector<Sphere>{{{0, 0, 0}, 2.0}, {{1, 0, 0}, 0.75}}), 1.5);
  EXPECT_THROW(tool_diameter({}), Error);
  EXPECT_THROW(tool_diameter(std::vector<Sphere>{{{0, 0, 0}, 2.0}, {{1, 0, 0}, 0.0}}), Error);
  EXPECT_THROW(tool_diameter(std::vector<Sphere>{{{0, 0, 0}, -2.0}}), Error);
}

// "Nothing is lost by simplifying, for the right tool" (docs/guarantee.md). Let h be the grid step.
// A tool whose every sphere (c, r), r >= rho, keeps a room of m = 1.733 h > 2 sqrt(3)/2 h beyond r
// all the way in intersects nothing of S, not even by the scallops: take a point p of the sphere
// and c' between c and p, p within rho of c', where the room is still rho + m. As m is more than
// the 1.367 h that the flood requires, the grid reaches the cell of c'. If that is a node x, |x -
// c'| <= 0.867 h, then d(x) >= rho + m - 0.867 h > rho + 0.866 h >= |p - x|; if it is a coarse cell
// of half diagonal g, then d(x) >= rho + g + 1.2 h > |p - x|. So p lies in the sphere kept for that
// cell, which is open, and not in S.
class Walk {
 public:
  Walk(const MeshDistance& distance, const std::vector<Sphere>& tool, double room)
      : distance_(distance), tool_(tool), room_(room) {}

  static Vector3d at(const Eigen::Isometry3d& pose, const Sphere& sphere) {
    return pose * sphere.center;
  }

  // Whether every sphere has the room here, and half a step more for the way here.
  bool is_free(const Eigen::Isometry3d& pose, double step) const {
    return std::ranges::all_of(tool_, [&](const Sphere& sphere) {
      return distance_(at(pose, sphere)).lower >= sphere.radius + room_ + step / 2.0;
    });
  }

  // Towards the target in small free steps, with turns where the way is blocked.
  Eigen::Isometry3d run(Eigen::Isometry3d pose, const Vector3d& target, double step,
                        Random& random) const {
    double reach = 0.1;
    for (const Sphere& sphere : tool_) reach = std::max(reach, sphere.center.norm());
    for (int i = 0; i < effort(400, 200); ++i) {
      const double angle = random.between(-0.2, 0.2) * step / reach;
      const Vector3d towards = target - pose.translation();
      const Vector3d astray = random.between(0.0, 1.5) * random.direction();
      Eigen::Isometry3d next = pose;
      next.linear() = (Eigen::AngleAxisd(angle, random.direction()) * pose.linear()).eval();
      // A sphere moves by at most the step in all: 0.8 of it and a fifth of it.
      next.translation() +=
          std::min(towards.norm(), 0.8 * step) * (towards.normalized() + astray).normalized();
      if (is_free(next, step)) pose = next;
    }
    return pose;
  }

 private:
  const MeshDistance& distance_;
  const std::vector<Sphere>& tool_;
  double room_;
};

// A thin rod, covered by spheres of one radius nearly along its axis.
std::vector<Sphere> rod() {
  const TriangleMesh mesh = box_mesh({-0.01, -0.01, -0.4}, {0.01, 0.01, 0.4});
  return simplify(mesh, {.max_error = 0.05, .min_radius = 0.1, .effort = 2}).cover.spheres;
}

ExternalSpheres externals_for(const std::vector<Sphere>& tool, const TriangleMesh& mesh) {
  return place_external_spheres(mesh,
                                {.min_external_diameter = tool_diameter(tool), .max_error = 0.05});
}

// No point of the closed spheres, those next to the mesh among them, is in S.
void expect_nothing_met(const std::vector<Sphere>& tool, const Eigen::Isometry3d& pose,
                        const MeshDistance& distance, const ExternalSpheres& external,
                        Random& random) {
  for (const Sphere& sphere : tool) {
    const Vector3d c = Walk::at(pose, sphere);
    const Vector3d to_mesh = (distance(c).closest - c).normalized();
    ASSERT_FALSE(is_in_solid(c + sphere.radius * to_mesh, external));
    for (int k = 0; k < 30; ++k) {
      const double share = k % 3 == 0 ? random.unit() : 1.0;
      const Vector3d beside = to_mesh + 0.3 * random.unit() * random.direction();
      const Vector3d direction = k % 2 == 0 ? random.direction() : beside.normalized();
      ASSERT_FALSE(is_in_solid(c + share * sphere.radius * direction, external));
    }
  }
}

constexpr double kRoom = 1.733;  // of the grid step

TEST(Tool, AToolThatDIsMadeForMeetsNothingOfTheSolidUnlessItMeetsTheMesh) {
  const std::vector<Sphere> tool = rod();
  EXPECT_GE(tool_diameter(tool), 0.2);
  Random random(91);
  int close = 0;
  for (const TriangleMesh& mesh : {cube_mesh(1.5), l_bracket(), pipe(0.8, 0.6, 1.0, 16)}) {
    const ExternalSpheres external = externals_for(tool, mesh);
    const MeshDistance distance(mesh);
    const Walk walk(distance, tool, kRoom * external.grid_step);
    for (int i = 0; i < effort(60, 8); ++i) {
      const Vector3d target = random.in_box(external.box);
      Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
      start.linear() = random.rotation().toRotationMatrix();
      start.translation() = target + 6.0 * random.direction();
      const Eigen::Isometry3d pose = walk.run(start, target, 0.05, random);
      ASSERT_TRUE(walk.is_free(pose, 0.0));
      expect_nothing_met(tool, pose, distance, external, random);
      if (external.box.exteriorDistance(pose.translation()) < 0.4) ++close;
    }
  }
  EXPECT_GT(close, effort(60, 8));
}

// A slot that is hardly wider than the tool and the room that it needs.
TEST(Tool, ANarrowSlotIsOpenForTheToolThatFits) {
  const std::vector<Sphere> tool = rod();
  double radius = 0.0;
  for (const Sphere& sphere : tool) {
    radius = std::max(radius, sphere.radius + std::abs(sphere.center.y()));
  }
  const double step = 0.02;
  const double grid = externals_for(tool, cube_mesh()).grid_step;
  const double half = radius + kRoom * grid + step / 2.0 + 0.01;
  const TriangleMesh mesh = joined(box_mesh({-0.5, half, -1}, {0.5, half + 0.2, 1}),
                                   box_mesh({-0.5, -half - 0.2, -1}, {0.5, -half, 1}));
  const ExternalSpheres external = externals_for(tool, mesh);
  ASSERT_EQ(external.grid_step, grid);
  const MeshDistance distance(mesh);
  const Walk walk(distance, tool, kRoom * grid);
  Random random(92);
  int inside = 0;
  for (int i = 0; i < effort(20, 5); ++i) {
    Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
    start.translation() = Vector3d(-1.5, 0, 0);
    const Vector3d target(random.between(-0.3, 0.3), 0, random.between(-0.4, 0.4));
    const Eigen::Isometry3d pose = walk.run(start, target, step, random);
    expect_nothing_met(tool, pose, distance, external, random);
    if (std::abs(pose.translation().x()) < 0.4) ++inside;
  }
  EXPECT_GT(inside, 1);
}

}  // namespace
}  // namespace spherule::test
