// SPDX-License-Identifier: BSD-3-Clause
// Ways into zones of a smaller D: none is lost, and where a zone ends at D / 2 from a surface, so
// that spheres of D just do not get in, the search for the way ends.
#include "simplifier/simplify.h"
#include "simplifier/types/zones.h"
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

ExternalSpheres placed(const TriangleMesh& mesh, double diameter, double step,
                       const std::vector<Zone>& zones) {
  ExternalOptions options;
  options.min_external_diameter = diameter;
  options.grid_step = step;
  options.tightness = kTightness;
  options.zones = zones;
  return place_external_spheres(mesh, options);
}

bool is_in_a_sphere(const ExternalSpheres& external, const Vector3d& place) {
  return std::ranges::any_of(external.spheres, [&](const Sphere& sphere) {
    return (sphere.center - place).norm() < sphere.radius;
  });
}

// How many of the places in zones that a sphere gets to which is larger by the slack lie in the
// box, each in an external sphere.
std::size_t places_in_zones(const TriangleMesh& mesh, const ExternalSpheres& external,
                            const std::vector<Zone>& zones, double step) {
  const double share = 1.0 + external.closing_slack / external.min_external_diameter;
  const double greatest = 0.5 * share * external.min_external_diameter;
  const auto in_zone = [](const Vector3d& place) {
    return [&](const Zone& zone) { return holds(zone.shape, place); };
  };
  const auto radius_at = [&](const Vector3d& place) {
    double radius = greatest;
    for (const Zone& zone : zones) {
      if (in_zone(place)(zone)) {
        radius = std::min(radius, 0.5 * share * zone.min_external_diameter.value());
      }
    }
    return radius;
  };
  std::size_t count = 0;
  FineFlood(mesh, external.box, step, greatest, radius_at)
      .for_each_reached([&](const Vector3d& place) {
        if (external.box.exteriorDistance(place) > 0.0) return;
        count += std::ranges::any_of(zones, in_zone(place)) ? 1 : 0;
        EXPECT_TRUE(is_in_a_sphere(external, place)) << place.transpose();
      });
  return count;
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
    const std::vector<Zone> zones = {
        {.shape = shape, .min_external_diameter = random.between(0.35, 0.8)}};
    const ExternalSpheres external = placed(mesh, 1.0, 0.12, zones);
    narrow += places_in_zones(mesh, external, zones, kSanitized ? 0.2 : 0.08);
    ASSERT_FALSE(HasFailure()) << n;
  }
  EXPECT_GT(narrow, static_cast<std::size_t>(effort(50, 1)));
}

// Halving cells shows nothing there: it went on until memory ended.
TEST(ZoneBorder, AtHalfADiameterFromASurfaceTheSearchEnds) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  constexpr double kDiameter = 4.0;
  const TriangleMesh block = box_mesh({0, 0, 0}, {10, 10, 10});
  for (const ZoneShape& shape :
       {ZoneShape(AlignedBox3d(Vector3d(3, 3, 5), Vector3d(7, 7, 10.0 + kDiameter / 2.0))),
        ZoneShape(Sphere{Vector3d::Zero(), kDiameter / 2.0})}) {
    const ExternalSpheres external =
        placed(block, kDiameter, 0.4, {{.shape = shape, .min_external_diameter = 1.0}});
    EXPECT_EQ(external.closing_slack, kTightness * kDiameter);
    EXPECT_LT(external.nodes_examined, 1000000U);
  }
}

// Of a ball about a corner, beside which the way of the larger sphere along the border is long.
TEST(ZoneBorder, ALongBorderIsFollowedToItsEnd) {
  const Vector3d corner(1.8692347497298332, 1.8538621497110468, 0.87688810503765979);
  const TriangleMesh mesh = joined(
      joined(box_mesh({0.47556057437192245, 0.6539228147908045, 0.34505270004082561}, corner),
             box_mesh({-0.413413374000901, -0.49420333538120342, -0.18814292867191337},
                      {0.46895134757748086, 0.72679422644759906, 0.25346337387765083})),
      box_mesh({0.080069186767595654, -0.14610412349455482, 0.0061430038422198409},
               {0.60415015232072988, 0.55903746388034936, 0.99559841005211114}));
  ExternalOptions options;
  options.min_external_diameter = 1.0;
  options.grid_step = 0.125;
  options.tightness = 0.08;
  options.zones = {{.shape = Sphere{corner, 0.5}, .min_external_diameter = 0.61536468020448976}};
  EXPECT_EQ(place_external_spheres(mesh, options).closing_slack, 0.08);
}

// Two blocks with a slot between them that only a zone opens, and just so for the larger sphere,
// and above one of them another zone that ends at half a diameter: that one is not to be reached,
// the slot is.
TEST(ZoneBorder, BesideSuchAZoneNarrowWaysAreFound) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  constexpr double kDiameter = 2.0;
  constexpr double kSmall = 0.5;
  constexpr double kSlot = (1.0 + kTightness) * kSmall * 1.01;
  Random random(76);
  for (int n = 0; n < 2; ++n) {
    const Vector3d low = random.direction();
    const auto at = [&](double x, double y, double z) -> Vector3d {
      return low + Vector3d(x, y, z);
    };
    const TriangleMesh mesh = joined(box_mesh(at(-4, 0, 0), at(4, 4, 4)),
                                     box_mesh(at(4.0 + kSlot, 0, 0), at(7.0 + kSlot, 4, 4)));
    const double depth = random.between(1.0, 3.0);
    const ZoneShape above = AlignedBox3d(at(-3, 1, 2), at(-1, 3, 4.0 + kDiameter / 2.0));
    const ZoneShape slot =
        AlignedBox3d(at(3.5, -3, depth), at(4.5 + kSlot, 7, random.between(5.5, 7.0)));
    const ExternalSpheres external = placed(mesh, kDiameter, 0.2,
                                            {{.shape = above, .min_external_diameter = kSmall},
                                             {.shape = slot, .min_external_diameter = kSmall}});
    EXPECT_DOUBLE_EQ(external.closing_slack, kTightness * kDiameter);
    for (double y = 0.5; y < 4.0; y += 0.25) {
      for (double z = depth + 0.3; z < 4.0; z += 0.25) {
        const Vector3d place = at(4.0 + kSlot / 2.0, y, z);
        EXPECT_TRUE(is_in_a_sphere(external, place)) << n << ": " << y << " " << z;
      }
    }
  }
}

}  // namespace
}  // namespace spherule::test::zone_border_test
