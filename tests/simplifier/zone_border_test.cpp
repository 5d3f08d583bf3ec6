// SPDX-License-Identifier: BSD-3-Clause
// Ways into zones of a smaller D: none is lost, and where a zone ends at D / 2 from a surface, so
// that spheres of D just do not get in, the search for the way ends.
#include "simplifier/external_spheres.h"
#include "simplifier/zones.h"
#include "tests/simplifier/fine_flood.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <variant>
#include <vector>

namespace spherule::test::zone_border_test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr double kTightness = 0.03;

bool holds(const ZoneShape& shape, const Vector3d& point) {
  if (const auto* const ball = std::get_if<Sphere>(&shape)) {
    return (point - ball->center).norm() <= ball->radius;
  }
  return std::get<AlignedBox3d>(shape).contains(point);
}

ExternalSpheres placed(const TriangleMesh& mesh, double diameter, double step, const Zone& zone) {
  ExternalOptions options;
  options.min_external_diameter = diameter;
  options.grid_step = step;
  options.tightness = kTightness;
  options.zones = {zone};
  return place_external_spheres(mesh, options);
}

TEST(ZoneBorder, NoPlaceBesideOneIsLost) {
  Random random(75);
  std::size_t narrow = 0;
  for (int n = 0; n < effort(5, 1); ++n) {
    const TriangleMesh mesh = random_blocks(random);
    const Vector3d middle = 1.2 * random.unit() * random.direction();
    const double size = random.between(0.4, 1.2);
    const ZoneShape shape =
        n % 2 == 0
            ? ZoneShape(Sphere{middle, size})
            : ZoneShape(AlignedBox3d(middle - Vector3d::Constant(size),
                                     middle + Vector3d(size, random.between(0.2, 1.2), size)));
    const Zone zone{.shape = shape, .min_external_diameter = random.between(0.35, 0.8)};
    const ExternalSpheres external = placed(mesh, 1.0, 0.12, zone);
    const double share = 1.0 + external.closing_slack;
    const auto radius_at = [&](const Vector3d& place) {
      return 0.5 * share * (holds(zone.shape, place) ? *zone.min_external_diameter : 1.0);
    };
    FineFlood(mesh, external.box, kSanitized ? 0.2 : 0.08, 0.5 * share, radius_at)
        .for_each_reached([&](const Vector3d& place) {
          if (external.box.exteriorDistance(place) > 0.0) return;
          narrow += holds(zone.shape, place) ? 1 : 0;
          ASSERT_TRUE(std::ranges::any_of(
              external.spheres,
              [&](const Sphere& sphere) { return (sphere.center - place).norm() < sphere.radius; }))
              << n << ": " << place.transpose();
        });
  }
  EXPECT_GT(narrow, static_cast<std::size_t>(effort(50, 1)));
}

// Halving cells shows nothing there: it went on until memory ended.
TEST(ZoneBorder, AtHalfADiameterFromASurfaceTheSearchEnds) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  constexpr double kDiameter = 4.0;
  const Zone zone{.shape = AlignedBox3d(Vector3d(3, 3, 5), Vector3d(7, 7, 10.0 + kDiameter / 2.0)),
                  .min_external_diameter = 1.0};
  const ExternalSpheres external = placed(box_mesh({0, 0, 0}, {10, 10, 10}), kDiameter, 0.4, zone);
  EXPECT_LT(external.closing_slack, 0.3 * kDiameter);
  EXPECT_LT(external.nodes_examined, 1500000U);
}

}  // namespace
}  // namespace spherule::test::zone_border_test
