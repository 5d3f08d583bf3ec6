// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/primitive_mesh.h"
#include "tests/robot/cover/cover_oracle.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <variant>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::lie_in_single_spheres;

LinkShape shape_of(const Primitive& primitive, const Pose& pose = {}) {
  return {.name = "", .link_from_shape = pose, .geometry = primitive};
}

// The largest distance from a point to one of the primitive, in its own frame.
struct Farthest {
  const WidePoint& from;

  Wide operator()(const Box& box) const {
    return (from.cwiseAbs() + box.size.cast<Wide>() / 2).norm();
  }
  Wide operator()(const SolidSphere& sphere) const { return from.norm() + sphere.radius; }
  Wide operator()(const Cylinder& cylinder) const {
    return std::hypot(std::hypot(from.x(), from.y()) + cylinder.radius,
                      std::abs(from.z()) + Wide(cylinder.length) / 2);
  }
  Wide operator()(const Capsule& capsule) const {
    return std::hypot(from.x(), from.y(), std::abs(from.z()) + Wide(capsule.length) / 2) +
           capsule.radius;
  }
  Wide operator()(const HalfSpace&) const { return 0; }
};

// Radii step by step through the limit: never held by less, and held by hardly more.
TEST(ShapesInSpheres, ExactlyWhatLiesInASphereUpToRounding) {
  Random random(3);
  for (int i = 0; i < effort(2000, 200); ++i) {
    const double size = std::pow(10.0, random.between(-3, 3));
    const Primitive primitive = random_primitive(random, size);
    const Pose pose =
        random_pose(random, i % 3 == 0 ? 0.0 : size * std::pow(10.0, random.between(0, 3)));
    const double away = i % 5 == 0 ? 0.0 : size * random.between(0, 3);
    const Vector3d center = pose.translation() + away * random.direction();
    const WidePoint own = unmove(pose, center.cast<Wide>());
    const Wide limit = std::visit(Farthest{own}, primitive);
    const double scene = size + center.norm() + pose.translation().norm();
    for (int k = -40; k <= 40; ++k) {
      const double radius = static_cast<double>(limit) + k * 1e-17 * scene;
      const bool held = lie_in_single_spheres(std::array{shape_of(primitive, pose)},
                                              std::array{Sphere{center, radius}});
      // The oracle is off by less than 2^-60 of the scene.
      ASSERT_FALSE(held && Wide(radius) < limit - Wide(scene) * 0x1p-60L) << "case " << i;
    }
    const Sphere more{center, static_cast<double>(limit) + 1e-13 * scene};
    ASSERT_TRUE(lie_in_single_spheres(std::array{shape_of(primitive, pose)}, std::array{more}))
        << "case " << i;
  }
}

TEST(ShapesInSpheres, ASphereLiesInItselfAndNoMeshDoes) {
  const Pose pose(Eigen::Quaterniond(1, 2, 3, 4), {0.1, -0.3, 0.7});
  const std::vector<LinkShape> shape{shape_of(SolidSphere{0.1}, pose)};
  EXPECT_TRUE(lie_in_single_spheres(shape, std::array{Sphere{pose.translation(), 0.1}}));
  const double less = std::nextafter(0.1, 0.0);
  EXPECT_FALSE(lie_in_single_spheres(shape, std::array{Sphere{pose.translation(), less}}));
  EXPECT_FALSE(lie_in_single_spheres(shape, {}));
  const LinkShape mesh{.name = "", .geometry = MeshFile{"part.stl", Vector3d::Ones()}};
  EXPECT_FALSE(lie_in_single_spheres(std::array{mesh}, std::array{Sphere{Vector3d::Zero(), 1e6}}));
}

// Every shape needs one sphere that holds all of it.
TEST(ShapesInSpheres, AChainOfCapsules) {
  std::vector<LinkShape> shapes;
  std::vector<Sphere> spheres;
  for (int i = 0; i < 12; ++i) {
    const auto middle = Pose::from_translation({0.1 * i, 0.0, 0.0});
    shapes.push_back(shape_of(Capsule{.radius = 0.02, .length = 0.06}, middle));
    spheres.push_back({middle.translation(), 0.0501});
  }
  EXPECT_TRUE(lie_in_single_spheres(shapes, spheres));
  std::ranges::reverse(spheres);
  EXPECT_TRUE(lie_in_single_spheres(shapes, spheres));
  spheres[5].radius = 0.0499;
  EXPECT_FALSE(lie_in_single_spheres(shapes, spheres));
}

// Six spheres at the corners of an octahedron overlap in threes and leave a cavity between them,
// which belongs to the inside and is covered by none.
TEST(ShapesInSpheres, ACavityBetweenThemIsNotHeld) {
  std::vector<LinkShape> shapes;
  std::vector<Sphere> spheres;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {
      const Vector3d center = side * Vector3d::Unit(axis);
      shapes.push_back(shape_of(SolidSphere{0.9}, Pose::from_translation(center)));
      spheres.push_back({center, 0.9});
    }
  }
  EXPECT_FALSE(lie_in_single_spheres(shapes, spheres));
  EXPECT_TRUE(lie_in_single_spheres(std::span(shapes).first(3), spheres));
  // One sphere that holds all of them encloses none.
  spheres.insert(spheres.begin(), {Vector3d::Zero(), 2.0});
  EXPECT_TRUE(lie_in_single_spheres(shapes, spheres));
}

}  // namespace
}  // namespace spherule::test
