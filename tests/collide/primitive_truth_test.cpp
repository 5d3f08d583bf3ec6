// SPDX-License-Identifier: BSD-3-Clause
// Solids against FCL, which has a closed formula for a sphere and each of them: a second opinion on
// what the solids are and where a pose puts them. FCL is no judge within 1e-6 of contact.
#include "collide/solids/primitive.h"
#include "spheretree/build.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>
#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

std::pair<Primitive, Geometry> random_solid(Random& random, int kind) {
  const auto length = [&] { return random.between(0.05, 1.0); };
  const double a = length(), b = length(), c = length();
  switch (kind) {
    case 0:
      return {Box{{a, b, c}}, std::make_shared<fcl::Boxd>(a, b, c)};
    case 1:
      return {SolidSphere{a}, std::make_shared<fcl::Sphered>(a)};
    case 2:
      return {Cylinder{a, b}, std::make_shared<fcl::Cylinderd>(a, b)};
    case 3:
      return {Capsule{a, b}, std::make_shared<fcl::Capsuled>(a, b)};
    default:
      return {HalfSpace{}, std::make_shared<fcl::Halfspaced>(Vector3d::UnitZ(), 0.0)};
  }
}

bool fcl_collides(const Geometry& solid, const Pose& world_from_solid, double radius,
                  const Vector3d& center) {
  const fcl::CollisionObjectd placed(solid, world_from_solid.isometry());
  const fcl::CollisionObjectd sphere(std::make_shared<fcl::Sphered>(radius),
                                     Eigen::Matrix3d::Identity(), center);
  fcl::CollisionResultd result;
  return fcl::collide(&sphere, &placed, fcl::CollisionRequestd(), result) > 0;
}

TEST(PrimitiveTruth, AgreesWithFcl) {
  Random random(1);
  for (int kind = 0; kind < 5; ++kind) {
    SCOPED_TRACE(kind);
    int counts[2] = {};
    int uncertain = 0;
    for (int i = 0; i < effort(3000, 300); ++i) {
      const auto drawn = random_solid(random, kind);
      const auto& solid = drawn.first;
      const auto& geometry = drawn.second;
      const Pose world_from_solid(random.rotation(), 0.4 * random.direction());
      const Pose world_from_tree(random.rotation(), 0.4 * random.direction());
      const double radius = random.between(0.01, 0.5);
      const Vector3d center = 1.2 * random.between(0.0, 1.0) * random.direction();
      const SphereTree tree = build_tree(std::vector<Sphere>{{center, radius}});
      const auto ours = [&](double clearance) {
        return within(tree, world_from_tree, solid, world_from_solid, clearance);
      };
      const SphereTree smaller = build_tree(std::vector<Sphere>{{center, radius - 1e-6}});
      const bool hit = ours(0.0);
      if (hit != ours(1e-6) || hit != collides(smaller, world_from_tree, solid, world_from_solid)) {
        ++uncertain;
        continue;
      }
      ASSERT_EQ(hit, fcl_collides(geometry, world_from_solid, radius, world_from_tree * center))
          << i;
      ++counts[hit];
    }
    EXPECT_GT(counts[0], effort(300, 30));
    EXPECT_GT(counts[1], effort(300, 30));
    EXPECT_LT(uncertain, 10);
  }
}

}  // namespace
}  // namespace spherule::test
