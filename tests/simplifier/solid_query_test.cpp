// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/solid/solid_query.h"

#include "simplifier/solid/clearance.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

namespace spherule::test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using internal::Clearance;
using internal::solid_point_in_groove;

// External spheres that meet in the origin, whose clearance therefore is about 0, and leave a
// groove or a pit open from there: along `opening` the clearances to all of them grow at a rate of
// `slope` at least.
ExternalSpheres grooved(Random& random, std::size_t count, const Vector3d& opening, double slope) {
  ExternalSpheres external;
  external.box = AlignedBox3d(Vector3d::Constant(-100), Vector3d::Constant(100));
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3d across = opening.cross(random.direction()).normalized();
    // The second is opposite to the first, so that the groove is as acute as it may be.
    const Vector3d side = i == 1 ? Vector3d(-external.spheres.front().center) : across;
    const Vector3d level = (side - side.dot(opening) * opening).normalized();
    const double rise = slope * (i < 2 ? 1.0 : random.between(1.0, 2.0));
    const Vector3d normal = rise * opening + std::sqrt(1.0 - rise * rise) * level;
    const double radius = random.between(2.0, 6.0);
    external.spheres.push_back({-radius * normal, radius});
  }
  return external;
}

// Away from one contact alone, a point beside the edge of an acute groove stays outside of S.
TEST(SolidQuery, TheSolidIsFoundBesideTheEdgeOfAnAcuteGroove) {
  Random random(11);
  for (int i = 0; i < effort(2000, 300); ++i) {
    const Vector3d opening = random.direction();
    const ExternalSpheres external =
        grooved(random, 2 + random.index(3), opening, random.between(0.05, 0.45));
    const Clearance clearance(external);
    const double within = 0.02;
    const double away = within * std::pow(2.0, -random.between(8, 28));
    const Vector3d start = away * (random.direction() - opening);
    if (clearance(start).lower >= 0.0) continue;
    const auto found = solid_point_in_groove(clearance, start, away, within);
    ASSERT_TRUE(found) << "case " << i;
    ASSERT_GE(clearance(*found).lower, 0.0) << "case " << i;
    ASSERT_LE((*found - start).norm(), within) << "case " << i;
  }
}

// A point deep in external spheres has no point of S near.
TEST(SolidQuery, NothingIsFoundWhereTheSolidIsFar) {
  Random random(12);
  for (int i = 0; i < effort(300, 50); ++i) {
    ExternalSpheres external;
    external.box = AlignedBox3d(Vector3d::Constant(-100), Vector3d::Constant(100));
    for (std::size_t k = 0; k < 6; ++k) external.spheres.push_back({random.direction(), 1.2});
    const Clearance clearance(external);
    const double depth = -clearance(Vector3d::Zero()).upper;
    ASSERT_FALSE(solid_point_in_groove(clearance, Vector3d::Zero(), 1e-6, 0.99 * depth))
        << "case " << i;
  }
}

}  // namespace
}  // namespace spherule::test
