// SPDX-License-Identifier: BSD-3-Clause
// The kernels of the inner loop give the same bits as the portable code, lane by lane.

#include "collide/search/traversal.h"
#include "tests/collide/exact_scene.h"
#include "tests/collide/scene_random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace spherule::test {
namespace {

TEST(OverlapMask, IsThePortableOneForEveryCountNearTheLimit) {
  SceneRandom random(1);
  int overlapping = 0;
  int apart = 0;
  int equal = 0;
  for (int round = 0; round < 3000; ++round) {
    const double size = std::ldexp(1.0, random.whole(-30, 30));
    std::vector<double> x, y, z, radius;
    const internal::QuerySphere query{random.uniform(-size, size), random.uniform(-size, size),
                                      random.uniform(-size, size), random.uniform(0.0, 0.1 * size)};
    // Radii within two ulps of where the test turns. The last ones are never to be read as part of
    // a mask, and overlap, so that a lane too many shows.
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector3d p = random.point(size);
      const double dx = p.x() - query.x, dy = p.y() - query.y, dz = p.z() - query.z;
      double r = std::sqrt(dx * dx + dy * dy + dz * dz) - query.radius;
      const int ulps = random.whole(-2, 2);
      for (int step = 0; step < std::abs(ulps); ++step) {
        r = std::nextafter(r, ulps > 0 ? 1e300 : -1e300);
      }
      if (i >= 36) r = 10.0 * size;
      x.push_back(p.x());
      y.push_back(p.y());
      z.push_back(p.z());
      radius.push_back(std::max(0.0, r));
      const double limit = query.radius + radius.back();
      equal += dx * dx + dy * dy + dz * dz == limit * limit;
    }
    const internal::SphereArrays spheres{x.data(), y.data(), z.data(), radius.data()};
    for (std::int32_t count = 1; count <= 32; ++count) {
      for (const std::int32_t first : {0, 1, 36 - std::min(count, 36)}) {
        const std::uint32_t mask = internal::overlap_mask(spheres, first, count, query);
        ASSERT_EQ(mask, internal::portable_overlap_mask(spheres, first, count, query))
            << count << " spheres from " << first;
        for (std::int32_t i = 0; i < 32; ++i) {
          const bool bit = mask >> i & 1u;
          ASSERT_EQ(bit, i < count && internal::overlaps(spheres, first + i, query));
          if (i < count) bit ? ++overlapping : ++apart;
        }
      }
    }
  }
  EXPECT_GT(overlapping, 100000);
  EXPECT_GT(apart, 100000);
  EXPECT_GT(equal, 1000);
}

}  // namespace
}  // namespace spherule::test
