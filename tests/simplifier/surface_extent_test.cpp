// SPDX-License-Identifier: BSD-3-Clause
#include "simplifier/stage2/cover_problem.h"
#include "simplifier/simplify.h"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <cmath>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::cap_width;
using internal::cap_width_at;
using internal::Clearance;
using internal::ClearanceAt;
using internal::inside_radius;
using internal::touched_by;

constexpr double kSize = 100.0;
constexpr double kError = 1.0;

// S is a cube.
struct Box {
  ExternalSpheres external;
  Clearance clearance;

  Box() : external(make()), clearance(external) {}
  static ExternalSpheres make() {
    ExternalSpheres made;
    made.box = {Vector3d::Zero(), Vector3d::Constant(kSize)};
    return made;
  }
};

TEST(SurfaceExtent, ACapIsAsWideAsItsGeometrySays) {
  for (const double inside : {0.0, 0.3, 5.0, 400.0}) {
    const double width = cap_width(inside, kError);
    // A corner of the cap is on the sphere of radius inside + E.
    EXPECT_NEAR(std::hypot(inside, width), inside + kError, 1e-9);
    EXPECT_NEAR(inside_radius(width, kError), inside, 1e-9);
  }
}

TEST(SurfaceExtent, SpheresThatTouchNearAnEdgeAreNoLargerThanTheWayToIt) {
  const Box box;
  int judged = 0;
  for (const double to_edge : {0.0, 2.0, 10.0, 45.0}) {
    for (const double depth : {-0.5, 0.0, 1.0}) {
      SCOPED_TRACE(testing::Message() << to_edge << " " << depth);
      const Vector3d point(50.0, to_edge, depth);
      const ClearanceAt at = box.clearance(point);
      // Two of the points on the edge or beside it are as near to the other face, or nearer.
      if (depth > to_edge || at.away != Vector3d::UnitZ()) continue;
      ++judged;
      EXPECT_TRUE(touched_by(box.clearance, point, at, to_edge, kError));
      EXPECT_FALSE(touched_by(box.clearance, point, at, to_edge + 0.5, kError));
      const double width = cap_width_at(box.clearance, point, at, kError);
      EXPECT_LE(width, cap_width(to_edge + 0.5, kError));
      EXPECT_GE(width * 1.4, std::min(cap_width(to_edge, kError), 15.0));
    }
  }
  EXPECT_EQ(judged, 10);
}

}  // namespace
}  // namespace spherule::test
