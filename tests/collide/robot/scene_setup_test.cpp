// SPDX-License-Identifier: BSD-3-Clause
#include "collide/robot/scene_setup.h"

#include "tests/support/temp_dir.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

using Rational = boost::multiprecision::cpp_rational;

// Whether a ball contains the one of the radius about (x, y, z), in exact arithmetic.
bool contains(const Sphere& ball, const Rational (&point)[3], double radius) {
  const Rational room = Rational(ball.radius) - Rational(radius);
  Rational squared = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Rational off = point[axis] - Rational(ball.center[axis]);
    squared += off * off;
  }
  return room >= 0 && squared <= room * room;
}

// Decimals are rounded when they are read and again when they are scaled: by less than one part in
// 10^15, but a ball that does not grow by it is too small.
TEST(PointBalls, ContainThoseAboutThePointsAsWritten) {
  const TempDir folder;
  constexpr double kRadius = 0.01;
  int needed = 0;
  for (const int scale : {1, 1000}) {
    for (int i = 1; i <= 40; ++i) {
      // A tenth of i, 7 i and -3 i, divided by the scale.
      std::string line;
      Rational point[3];
      for (int axis = 0; axis < 3; ++axis) {
        const int tenths = i * (axis == 0 ? 1 : axis == 1 ? 7 : -3);
        line += (tenths < 0 ? "-" : "") + std::to_string(std::abs(tenths) / 10) + "." +
                std::to_string(std::abs(tenths) % 10) + " ";
        point[axis] = Rational(tenths, 10 * scale);
      }
      const PointsSource source{
          .path = folder.write("scan.xyz", line + "\n"), .radius = kRadius, .scale = 1.0 / scale};
      const std::vector<Sphere> balls = point_balls(source);
      ASSERT_EQ(balls.size(), 1U);
      EXPECT_TRUE(contains(balls[0], point, kRadius)) << i << ' ' << scale;
      EXPECT_LE(balls[0].radius, kRadius + 1e-13);
      needed += contains({balls[0].center, kRadius}, point, kRadius) ? 0 : 1;
    }
  }
  EXPECT_GT(needed, 60);
}

TEST(PointBalls, OneForThoseOfACell) {
  const TempDir folder;
  PointsSource source{.path = folder.write("scan.xyz", "1 1 1\n2 1 1\n9 1 1\n"), .radius = 0.01};
  EXPECT_EQ(point_balls(source).size(), 3U);
  source.scale = 0.001;
  source.voxel = 0.005;
  EXPECT_EQ(point_balls(source).size(), 2U);
}

}  // namespace
}  // namespace spherule::test
