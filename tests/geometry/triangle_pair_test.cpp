// SPDX-License-Identifier: BSD-3-Clause
// Two triangles in one frame, against rational numbers.
#include "base/rounding.h"
#include "collide/search/relative_pose.h"
#include "geometry/triangles.h"
#include "tests/support/effort.h"
#include "tests/support/exact/shapes.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::Triangle;
using internal::triangle_contact;
using internal::TriangleContact;

struct Scene {
  Triangle a, b;
};

double reach(const Triangle& t) {
  return norm_upper(t[0]) + norm_upper(t[1]) + norm_upper(t[2]);
}

struct Tally {
  int apart = 0, touching = 0, uncertain = 0;
  double widest_uncertainty = 0.0;  // distance uncertain, as a share of the scene
};

// Judges every scene in both orders.
Tally judge(int count, std::uint64_t seed, const std::function<Scene(Random&)>& make) {
  Random random(seed);
  Tally tally;
  for (int i = 0; i < count; ++i) {
    const Scene scene = make(random);
    const double size = reach(scene.a) + reach(scene.b);
    const double pad = 76.0 * kUnitRoundoff * size + kUnderflow;
    const TriangleContact contact = triangle_contact(scene.a, scene.b, pad, size);
    EXPECT_EQ(contact, triangle_contact(scene.b, scene.a, pad, size));
    const double gap = exact_gap(scene.a, Pose(), scene.b, Pose());
    switch (contact) {
      case TriangleContact::kApart:
        EXPECT_GT(gap, 0.0) << "missed in case " << i;
        ++tally.apart;
        break;
      case TriangleContact::kTouch:
        EXPECT_EQ(gap, 0.0) << "invented in case " << i;
        ++tally.touching;
        break;
      case TriangleContact::kUncertain:
        ++tally.uncertain;
        tally.widest_uncertainty = std::max(tally.widest_uncertainty, gap / size);
    }
  }
  return tally;
}

Triangle random_triangle(Random& random) {
  return {random.point(1.0), random.point(1.0), random.point(1.0)};
}
// Its third corner lies near the first edge, or on it up to rounding.
Triangle needle(Random& random, double width) {
  const Vector3d a = random.point(1.0), edge = random.point(1.0);
  return {a, a + edge, a + random.between(0.0, 1.0) * edge + width * random.point(1.0)};
}
Vector3d point_of(const Triangle& t, Random& random) {
  const double v = random.between(0.0, 1.0), w = random.between(0.0, 1.0 - v);
  return t[0] + v * (t[1] - t[0]) + w * (t[2] - t[0]);
}
Vector3d point_of_edge(const Triangle& t, Random& random) {
  return t[0] + random.between(0.0, 1.0) * (t[1] - t[0]);
}
// Zero, some units in the last place, or a small distance, on either side.
double offset(Random& random) {
  constexpr double kOffsets[] = {0.0, 0x1p-53, 0x1p-51, 1e-13, 1e-11, 1e-9, 1e-6, 1e-3};
  return kOffsets[random.whole(0, 7)] * (random.whole(0, 1) == 0 ? -1.0 : 1.0);
}
Triangle moved(Triangle t, const Vector3d& by) {
  for (Vector3d& corner : t) corner += by;
  return t;
}
// So that `from`, a point of t, comes to `to` but for a small distance.
Triangle brought(const Triangle& t, const Vector3d& from, const Vector3d& to, Random& random) {
  return moved(t, to - from + offset(random) * random.point(1.0).normalized());
}

struct Case {
  const char* name;
  int count;
  int apart, touching, uncertain;  // more than so many
  Scene (*make)(Random&);
};

const Case kCases[] = {
    {"corner against face", 3000, 100, 300, 100,
     [](Random& random) -> Scene {
       const Triangle a = random_triangle(random), b = random_triangle(random);
       return {a, brought(b, b[0], point_of(a, random), random)};
     }},
    {"edge against edge", 3000, 100, 300, 100,
     [](Random& random) -> Scene {
       const Triangle a = random_triangle(random), b = random_triangle(random);
       return {a, brought(b, point_of_edge(b, random), point_of_edge(a, random), random)};
     }},
    {"corner against corner or edge", 3000, 500, -1, 100,
     [](Random& random) -> Scene {
       const Triangle a = random_triangle(random), b = random_triangle(random);
       const Vector3d to = random.coin() ? a[2] : point_of_edge(a, random);
       return {a, brought(b, b[0], to, random)};
     }},
    // On a grid, so that corners and edges often coincide; each along the axes' plane in turn.
    {"in one plane", 2000, 500, -1, 500,
     [](Random& random) -> Scene {
       const int axis = random.whole(0, 2);
       const auto triangle = [&] {
         Triangle t;
         for (Vector3d& corner : t) {
           corner = Vector3d(random.whole(0, 4), random.whole(0, 4), random.whole(0, 4)) / 4.0;
           corner[axis] = 0.5;
         }
         return t;
       };
       Vector3d shift = Vector3d::Zero();
       if (random.coin()) shift[random.whole(0, 2)] = offset(random);
       return {triangle(), moved(triangle(), shift)};
     }},
    {"small, far from the origin", 2000, 50, -1, 500, [](Random& random) -> Scene {
       const Vector3d far = random.point(1e6);
       const Triangle a = moved(random_triangle(random), far), b = random_triangle(random);
       return {a, brought(b, b[0], point_of(a, random), random)};
     }}};

TEST(TrianglePair, NextToContactIsDecidedOrUncertainWithinTheSlack) {
  for (const Case& tested : kCases) {
    SCOPED_TRACE(tested.name);
    constexpr int kShare = kSanitized ? 15 : 1;
    const Tally tally = judge(tested.count / (kSanitized ? 12 : 1), 2, tested.make);
    EXPECT_GT(tally.apart, tested.apart / kShare);
    EXPECT_GT(tally.touching, tested.touching < 0 ? -1 : tested.touching / kShare);
    EXPECT_GT(tally.uncertain, tested.uncertain / kShare);
    EXPECT_LT(tally.widest_uncertainty, internal::kSlack);
  }
}

TEST(TrianglePair, RandomOnesAreDecidedForSure) {
  const Tally tally = judge(effort(3000, 250), 1, [](Random& random) -> Scene {
    return {random_triangle(random), random_triangle(random)};
  });
  EXPECT_GT(tally.apart, effort(1000, 66));
  EXPECT_GT(tally.touching, effort(300, 20));
  EXPECT_EQ(tally.uncertain, 0);
}

TEST(TrianglePair, NeedlesSegmentsAndPoints) {
  for (const double width : {1e-6, 1e-9, 1e-13, 0.0}) {
    const Tally tally = judge(effort(1000, 83), 6, [width](Random& random) -> Scene {
      const Triangle a = random.whole(0, 1) == 0 ? needle(random, width) : random_triangle(random);
      Triangle b = needle(random, width);
      if (random.whole(0, 4) == 0) b = {b[0], b[0], random.whole(0, 1) == 0 ? b[0] : b[1]};
      const Vector3d from = random.whole(0, 1) == 0 ? b[0] : point_of(b, random);
      const Vector3d to = random.whole(0, 1) == 0 ? a[1] : point_of(a, random);
      return {a, brought(b, from, to, random)};
    });
    EXPECT_GT(tally.apart, effort(200, 13)) << width;
    EXPECT_GT(tally.uncertain, effort(50, 3)) << width;
    EXPECT_LT(tally.widest_uncertainty, 1e-9) << width;
  }
}

// Far smaller than the scene, and so small that squares of areas underflow.
TEST(TrianglePair, TinyOnesAreNotTakenForApart) {
  for (const double size : {1e-6, 1e-30, 1e-90, 1e-150, 1e-300}) {
    judge(effort(60, 2), 8, [size](Random& random) -> Scene {
      Scene scene{random_triangle(random), random_triangle(random)};
      for (Vector3d& corner : scene.a) corner *= size;
      for (Vector3d& corner : scene.b) corner *= random.whole(0, 1) == 0 ? 1.0 : size;
      return scene;
    });
  }
}

// A triangle that is moved by as much as its depth, in any direction, still touches; by a bit more,
// in the direction of the least overlap, it does not always.
TEST(TrianglePair, KeepsTouchingUpToItsDepth) {
  Random random(11);
  int deep = 0, tight = 0;
  for (int i = 0; i < effort(400, 33); ++i) {
    const Triangle a = random.whole(0, 2) == 0 ? needle(random, 0.1) : random_triangle(random);
    Triangle b = random_triangle(random);
    if (random.whole(0, 1) == 0) b = brought(b, point_of(b, random), point_of(a, random), random);
    const double size = reach(a) + reach(b);
    const double pad = 76.0 * kUnitRoundoff * size + kUnderflow;
    const double depth = internal::triangle_depth(a, b, size);
    EXPECT_EQ(depth > 0.0, triangle_contact(a, b, pad, size) == TriangleContact::kTouch);
    if (!(depth > 0.0)) continue;
    ++deep;
    bool parted = false;
    for (int k = 0; k < 8; ++k) {
      // Each corner by itself: a rigid motion is one case of it.
      Triangle near = a, away = a;
      const Vector3d same = random.point(1.0).normalized();
      for (Vector3d& corner : near) {
        const Vector3d way = k % 2 == 0 ? same : random.point(1.0).normalized();
        corner += (1.0 - 1e-9) * depth * way;
      }
      for (Vector3d& corner : away) corner += 1.5 * depth * same;
      EXPECT_EQ(exact_gap(near, Pose(), b, Pose()), 0.0) << i;
      parted = parted || exact_gap(away, Pose(), b, Pose()) > 0.0;
    }
    tight += parted;
  }
  EXPECT_GT(deep, effort(50, 4));
  EXPECT_GT(tight, effort(25, 2));
}

}  // namespace
}  // namespace spherule::test
