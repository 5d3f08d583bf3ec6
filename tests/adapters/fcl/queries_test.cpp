// SPDX-License-Identifier: BSD-3-Clause
#include "adapters/fcl/collide.h"
#include "base/error.h"
#include "collide/collide.h"
#include "geometry/point_triangle.h"
#include "spheretree/build.h"
#include "tests/adapters/fcl/models.h"
#include "tests/support/random.h"

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/continuous_collision.h>
#include <fcl/narrowphase/distance.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace spherule {
namespace {

namespace api = fcl_api;

fcl::Transform3d at(double x, double y, double z) {
  fcl::Transform3d transform = fcl::Transform3d::Identity();
  transform.translation() = Eigen::Vector3d(x, y, z);
  return transform;
}

template <class S>
std::shared_ptr<api::SphereModel<S>> row_of_spheres(int count) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < count; ++i) spheres.push_back({{2.0 * i, 0.0, 0.0}, 1.0});
  return std::make_shared<api::SphereModel<S>>(
      std::make_shared<const SphereTree>(build_tree(spheres)));
}

template <class Ask>
std::string subject_of(const Ask& query) {
  try {
    query();
  } catch (const Error& error) {
    return error.subject();
  }
  return "none";
}

TEST(FclQueries, ContactsAreSpheresThatTouch) {
  const auto a = row_of_spheres<double>(10), b = row_of_spheres<double>(8);
  test::Random random(1);
  std::size_t touching = 0;
  for (int i = 0; i < 300; ++i) {
    const fcl::Transform3d tf_a = test::random_transform(random, 5.0);
    const fcl::Transform3d tf_b = test::random_transform(random, 15.0);
    const Pose pose_a = api::from_fcl(tf_a), pose_b = api::from_fcl(tf_b);
    const SphereTree& tree_a = *a->part().spheres;
    const SphereTree& tree_b = *b->part().spheres;
    const std::size_t all = collide(tree_a, pose_a, tree_b, pose_b).pairs.size();
    touching += all > 0;
    for (const std::size_t most : {std::size_t{1}, std::size_t{3}, std::size_t{1000}}) {
      api::CollisionResultd result;
      const api::CollisionRequestd request(most, true);
      EXPECT_EQ(api::collide(a.get(), tf_a, b.get(), tf_b, request, result), std::min(all, most));
      EXPECT_EQ(result.isCollision(), all > 0);
      std::set<std::pair<std::intptr_t, std::intptr_t>> pairs;
      for (std::size_t k = 0; k < result.numContacts(); ++k) {
        const api::Contactd& contact = result.getContact(k);
        EXPECT_EQ(contact.o1, a.get());
        EXPECT_EQ(contact.o2, b.get());
        EXPECT_TRUE(pairs.emplace(contact.b1, contact.b2).second);
        EXPECT_TRUE(spheres_touch(tree_a, static_cast<std::int32_t>(contact.b1), pose_a, tree_b,
                                  static_cast<std::int32_t>(contact.b2), pose_b));
        const Eigen::Vector3d c1 = pose_a * Eigen::Vector3d(2.0 * double(contact.b1), 0, 0);
        const Eigen::Vector3d c2 = pose_b * Eigen::Vector3d(2.0 * double(contact.b2), 0, 0);
        EXPECT_LE((contact.pos - c1).norm(), 1.0 + 1e-12);
        EXPECT_LE((contact.pos - c2).norm(), 1.0 + 1e-12);
        EXPECT_NEAR(contact.penetration_depth, 2.0 - (c1 - c2).norm(), 1e-12);
        EXPECT_LE((contact.normal * (c2 - c1).norm() - (c2 - c1)).norm(), 1e-12);
      }
    }
  }
  EXPECT_GT(touching, 30u);
}

// FCL adds to what a result holds; here nothing of an earlier call survives.
TEST(FclQueries, ResultsAreFresh) {
  const auto row = row_of_spheres<double>(10);
  const api::CollisionObjectd here(row), near(row, at(0, 1.5, 0)), far(row, at(0, 5, 0));
  const api::CollisionRequestd request(1000, false);
  api::CollisionResultd result;
  const std::size_t contacts = api::collide(&here, &near, request, result);
  EXPECT_GT(contacts, 0u);
  EXPECT_EQ(api::collide(&here, &near, request, result), contacts);
  EXPECT_EQ(result.numContacts(), contacts);
  EXPECT_EQ(api::collide(&here, &far, request, result), 0u);
  EXPECT_FALSE(result.isCollision());

  api::DistanceResultd distance;
  EXPECT_EQ(api::distance(&here, &near, api::DistanceRequestd(), distance), -1.0);
  EXPECT_NEAR(api::distance(&here, &far, api::DistanceRequestd(), distance), 3.0, 1e-12);
}

// The least gap of two of the spheres, poses taken as exact; its own rounding is far below that of
// double.
long double least_gap(const SphereTree& a, const Pose& pose_a, const SphereTree& b,
                      const Pose& pose_b) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  const auto placed = [](const Sphere& sphere, const Pose& pose) -> Vector {
    return pose.matrix().cast<long double>() * sphere.center.cast<long double>() +
           pose.translation().cast<long double>();
  };
  long double least = std::numeric_limits<long double>::infinity();
  for (const Sphere& one : a.spheres()) {
    for (const Sphere& other : b.spheres()) {
      const long double gap = (placed(one, pose_a) - placed(other, pose_b)).norm() -
                              static_cast<long double>(one.radius) -
                              static_cast<long double>(other.radius);
      least = std::min(least, gap);
    }
  }
  return least;
}

TEST(FclQueries, DistanceIsALowerBound) {
  const auto a = row_of_spheres<double>(10), b = row_of_spheres<double>(8);
  const auto a_float = row_of_spheres<float>(10), b_float = row_of_spheres<float>(8);
  test::Random random(2);
  int apart = 0;
  int apart_in_float = 0;
  for (int i = 0; i < 300; ++i) {
    const fcl::Transform3d tf_a = test::random_transform(random, 5.0);
    const fcl::Transform3d tf_b = test::random_transform(random, 40.0);
    const long double gap =
        least_gap(*a->part().spheres, api::from_fcl(tf_a), *b->part().spheres, api::from_fcl(tf_b));
    const DistanceResult expected =
        distance(*a->part().spheres, api::from_fcl(tf_a), *b->part().spheres, api::from_fcl(tf_b));
    api::DistanceResultd result;
    EXPECT_EQ(api::distance(a.get(), tf_a, b.get(), tf_b, api::DistanceRequestd(), result),
              result.min_distance);
    api::DistanceResultf result_float;
    api::distance(a_float.get(), fcl::Transform3f(tf_a.cast<float>()), b_float.get(),
                  fcl::Transform3f(tf_b.cast<float>()), api::DistanceRequestf(), result_float);
    if (expected.lower == 0.0) {
      EXPECT_EQ(result.min_distance, -1.0);
      EXPECT_LE(gap, 1e-11L);
      continue;
    }
    ++apart;
    EXPECT_LE(static_cast<long double>(result.min_distance), gap);
    EXPECT_GE(static_cast<long double>(result.min_distance), gap - 1e-11L);
    EXPECT_EQ(result.min_distance, expected.lower);
    EXPECT_NEAR((result.nearest_points[0] - result.nearest_points[1]).norm(), expected.upper,
                1e-12 * 40.0);
    const Pose rounded_a = api::from_fcl(fcl::Transform3f(tf_a.cast<float>()));
    const Pose rounded_b = api::from_fcl(fcl::Transform3f(tf_b.cast<float>()));
    const DistanceResult rounded =
        distance(*a->part().spheres, rounded_a, *b->part().spheres, rounded_b);
    if (rounded.lower == 0.0) continue;
    ++apart_in_float;
    EXPECT_LE(static_cast<long double>(result_float.min_distance),
              least_gap(*a->part().spheres, rounded_a, *b->part().spheres, rounded_b));
    EXPECT_LE(double(result_float.min_distance), rounded.lower);
    EXPECT_GE(double(result_float.min_distance), rounded.lower * (1.0 - 0x1p-22));
  }
  EXPECT_GT(apart, 200);
  EXPECT_GT(apart_in_float, 200);
}

TEST(FclQueries, ConfirmedContactsAreTrianglesThatTouch) {
  const auto bracket = test::covered_model("bracket", true),
             cube = test::covered_model("cube", true);
  test::Random random(3);
  std::size_t touching = 0;
  for (int i = 0; i < 100; ++i) {
    const fcl::Transform3d tf_a = test::random_transform(random, 10.0);
    const fcl::Transform3d tf_b = test::random_transform(random, 200.0);
    api::CollisionResultd result;
    api::collide(bracket.get(), tf_a, cube.get(), tf_b, api::CollisionRequestd(50, true), result);
    const auto off = [&](const api::CoveredPart& part, std::intptr_t triangle,
                         const fcl::Transform3d& tf, const Eigen::Vector3d& point) {
      const auto& t = part.mesh->mesh().triangle(static_cast<std::int32_t>(triangle));
      return point_triangle_distance(tf.inverse() * point, t[0], t[1], t[2]).upper;
    };
    std::set<std::pair<std::intptr_t, std::intptr_t>> pairs;
    for (std::size_t k = 0; k < result.numContacts(); ++k) {
      const api::Contactd& contact = result.getContact(k);
      EXPECT_TRUE(pairs.emplace(contact.b1, contact.b2).second);
      EXPECT_LE(off(bracket->part(), contact.b1, tf_a, contact.pos), 1e-9);
      EXPECT_LE(off(cube->part(), contact.b2, tf_b, contact.pos), 1e-9);
      EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-12);
      EXPECT_GE(contact.penetration_depth, 0.0);
    }
    touching += result.isCollision();
  }
  EXPECT_GT(touching, 20u);
}

// FCL calls a cube inside another free.
TEST(FclQueries, OneInsideTheOtherIsACollision) {
  const auto cube = test::covered_model("cube", true), probe = test::covered_model("probe", true);
  api::CollisionResultd result;
  EXPECT_EQ(api::collide(cube.get(), at(0, 0, 0), probe.get(), at(3, 2, 1),
                         api::CollisionRequestd(9, true), result),
            1u);
  EXPECT_EQ(result.getContact(0).b1, std::intptr_t{api::Contactd::NONE});
  EXPECT_EQ(result.getContact(0).b2, std::intptr_t{api::Contactd::NONE});
}

// One with triangles and one without: the spheres decide.
TEST(FclQueries, ConfirmationNeedsBothMeshes) {
  const auto meshed = test::covered_model("cube", true), plain = test::covered_model("cube");
  const fcl::Transform3d apart = at(100.5, 0, 0);  // E is 17.3
  api::CollisionResultd result;
  const api::CollisionRequestd request;
  EXPECT_EQ(api::collide(meshed.get(), at(0, 0, 0), meshed.get(), apart, request, result), 0u);
  EXPECT_EQ(api::collide(meshed.get(), at(0, 0, 0), plain.get(), apart, request, result), 1u);
  EXPECT_EQ(api::collide(plain.get(), at(0, 0, 0), plain.get(), apart, request, result), 1u);
}

TEST(FclQueries, BoxesHoldTheSpheres) {
  const auto check = [](const auto& model, std::uint64_t seed) {
    using S = std::decay_t<decltype(model->aabb_radius)>;
    const SphereTree& tree = *model->part().spheres;
    test::Random random(seed);
    for (int i = 0; i < 200; ++i) {
      fcl::Transform3d tf = test::random_transform(random, 100.0 * tree.reach());
      if (i % 2 == 0) {  // as near to none as FCL takes for none
        const double angle = 0.5 * double(Eigen::NumTraits<S>::dummy_precision());
        tf.linear() = Eigen::AngleAxisd(angle, random.direction()).toRotationMatrix();
      }
      const fcl::Transform3<S> rounded = tf.template cast<S>();
      const fcl::CollisionObject<S> object(model, rounded);
      const Pose pose = api::from_fcl(rounded);
      const auto& box = object.getAABB();
      for (const Sphere& sphere : tree.spheres()) {
        const Eigen::Vector3d center = pose * sphere.center;
        const Eigen::Vector3d low = center.array() - sphere.radius;
        const Eigen::Vector3d high = center.array() + sphere.radius;
        EXPECT_TRUE((box.min_.template cast<double>().array() <= low.array()).all());
        EXPECT_TRUE((box.max_.template cast<double>().array() >= high.array()).all());
      }
    }
  };
  check(row_of_spheres<double>(10), 4);
  check(row_of_spheres<float>(10), 5);
}

TEST(FclQueries, WhatCannotBeAnsweredIsAnError) {
  const auto row = row_of_spheres<double>(3);
  const auto bare = test::fcl_model<fcl::OBBRSSd>(test::fcl_test_mesh("cube"));
  const fcl::Transform3d id = fcl::Transform3d::Identity();
  fcl::Transform3d bad = id;
  bad.translation()[1] = std::numeric_limits<double>::quiet_NaN();
  api::CollisionResultd result;
  const auto collide_with = [&](const fcl::CollisionGeometryd* o1, const fcl::Transform3d& tf1,
                                const fcl::CollisionGeometryd* o2, const fcl::Transform3d& tf2,
                                const api::CollisionRequestd& request) {
    return subject_of([&] { api::collide(o1, tf1, o2, tf2, request, result); });
  };
  const api::CollisionRequestd request;
  EXPECT_EQ(collide_with(bare.get(), id, row.get(), id, request), "o1");
  EXPECT_EQ(collide_with(row.get(), id, bare.get(), id, request), "o2");
  EXPECT_EQ(collide_with(row.get(), id, nullptr, id, request), "o2");
  EXPECT_EQ(collide_with(row.get(), bad, row.get(), id, request), "tf1");
  EXPECT_EQ(collide_with(row.get(), id, row.get(), bad, request), "tf2");
  EXPECT_EQ(collide_with(row.get(), id, row.get(), id, api::CollisionRequestd(0)),
            "num_max_contacts");
  EXPECT_EQ(collide_with(row.get(), id, row.get(), id, api::CollisionRequestd(1, false, 1, true)),
            "enable_cost");
  EXPECT_EQ(collide_with(row.get(), id, row.get(), id, request), "none");
  const api::CollisionObjectd object(row);
  EXPECT_EQ(subject_of([&] { api::collide<double>(&object, nullptr, request, result); }), "o2");

  api::DistanceResultd distance;
  const auto distance_with = [&](const api::DistanceRequestd& queried) {
    return subject_of([&] { api::distance(&object, &object, queried, distance); });
  };
  EXPECT_EQ(distance_with(api::DistanceRequestd(true, true)), "enable_signed_distance");
  EXPECT_EQ(distance_with(api::DistanceRequestd(true, false, 0.0, -1.0)), "abs_err");
  EXPECT_EQ(distance_with(
                api::DistanceRequestd(true, false, 0.0, std::numeric_limits<double>::infinity())),
            "abs_err");
  EXPECT_EQ(distance_with(api::DistanceRequestd()), "none");
}

// An fcl:: that was overlooked is no silent "free".
TEST(FclQueries, FclItselfRefusesSphereModels) {
  const auto row = row_of_spheres<double>(3);
  const fcl::CollisionObjectd object(row);
  fcl::CollisionResultd result;
  EXPECT_THROW(fcl::collide(&object, &object, fcl::CollisionRequestd(), result), Error);
  fcl::DistanceResultd distance;
  EXPECT_THROW(fcl::distance(&object, &object, fcl::DistanceRequestd(), distance), Error);
  const auto bare = std::make_shared<fcl::Sphered>(1.0);
  const fcl::CollisionObjectd sphere(bare);
  EXPECT_THROW(fcl::collide(&sphere, &object, fcl::CollisionRequestd(), result), Error);
  fcl::ContinuousCollisionResultd moving;
  EXPECT_THROW(fcl::continuousCollide(&object, at(1, 0, 0), &object, at(0, 0, 0),
                                      fcl::ContinuousCollisionRequestd(), moving),
               Error);
}

TEST(FclQueries, ModelsNeedSpheres) {
  EXPECT_THROW(api::SphereModeld(std::shared_ptr<const SphereTree>()), Error);
  auto part = test::covered_model("cube", true)->part();
  part.spheres = row_of_spheres<double>(3)->part().spheres;
  EXPECT_THROW(api::SphereModeld{part}, Error);
  EXPECT_THROW(api::cover_part({}), Error);
  EXPECT_THROW(api::cover_part(test::fcl_test_mesh("cube"), {.fit = {.max_error = -1.0}}), Error);
}

}  // namespace
}  // namespace spherule
