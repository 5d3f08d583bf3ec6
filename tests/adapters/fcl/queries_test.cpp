// SPDX-License-Identifier: BSD-3-Clause
#include "adapters/fcl/collide.h"
#include "base/error.h"
#include "collide/collide.h"
#include "collide/motion/motion.h"
#include "geometry/point_triangle.h"
#include "spheretree/sphere_tree.h"
#include "tests/adapters/fcl/models.h"
#include "tests/support/effort.h"
#include "tests/support/fcl_solid.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/continuous_collision.h>
#include <fcl/narrowphase/distance.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <iostream>
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

using fcl_api::from_fcl;
using fcl_api::to_fcl;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

// What the call throws says `text`; "none" for a call that is to throw nothing.
void expect_refusal(const std::string& text, const std::function<void()>& call) {
  std::string said = "none";
  try {
    call();
  } catch (const Error& error) {
    said = error.what();
  }
  EXPECT_NE(said.find(text), said.npos) << text << ", not " << said;
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
  const fcl::Transform3d id = fcl::Transform3d::Identity(), bad = at(0.0, kNan, 0.0);
  const api::CollisionRequestd any, none(0), costs(1, false, 1, true);
  struct Case {
    const fcl::CollisionGeometryd* o1;
    fcl::Transform3d tf1;
    const fcl::CollisionGeometryd* o2;
    fcl::Transform3d tf2;
    const api::CollisionRequestd& request;
    std::string subject;
  };
  api::CollisionResultd result;
  for (const Case& c : {Case{bare.get(), id, row.get(), id, any, "o1:"},
                        Case{row.get(), id, bare.get(), id, any, "o2:"},
                        Case{row.get(), id, nullptr, id, any, "o2:"},
                        Case{row.get(), bad, row.get(), id, any, "tf1:"},
                        Case{row.get(), id, row.get(), bad, any, "tf2:"},
                        Case{row.get(), id, row.get(), id, none, "num_max_contacts:"},
                        Case{row.get(), id, row.get(), id, costs, "enable_cost:"},
                        Case{row.get(), id, row.get(), id, any, "none"}}) {
    expect_refusal(c.subject, [&] { api::collide(c.o1, c.tf1, c.o2, c.tf2, c.request, result); });
  }
  const api::CollisionObjectd object(row);
  expect_refusal("o2:", [&] { api::collide<double>(&object, nullptr, any, result); });
  using Request = api::DistanceRequestd;
  for (const auto& c : {std::pair(Request(true, true), "enable_signed_distance:"),
                        std::pair(Request(true, false, 0.0, -1.0), "abs_err:"),
                        std::pair(Request(true, false, 0.0, kInfinity), "abs_err:"),
                        std::pair(Request(), "none")}) {
    api::DistanceResultd distance;
    expect_refusal(c.second, [&] { api::distance(&object, &object, c.first, distance); });
  }
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

template <class S>
void expect_there_and_back(std::uint64_t seed, double error) {
  test::Random random(seed);
  for (int i = 0; i < 200; ++i) {
    const fcl::Transform3d exact = test::random_transform(random, 10.0);
    const fcl::Transform3<S> transform = exact.cast<S>();
    const Pose pose = from_fcl(transform);
    const fcl::Transform3<S> back = to_fcl<S>(pose);
    EXPECT_LE((pose.matrix() - exact.linear()).cwiseAbs().maxCoeff(), error);
    EXPECT_EQ(pose.translation(), transform.translation().template cast<double>());
    EXPECT_LE((back.linear() - transform.linear()).cwiseAbs().maxCoeff(), S(error));
    EXPECT_EQ(back.translation(), transform.translation());
  }
}

TEST(FclConversions, TransformsGoThereAndBack) {
  expect_there_and_back<double>(1, 1e-14);
  expect_there_and_back<float>(2, 3e-7);
}

TEST(FclConversions, WhatIsNoTransformIsAnError) {
  const auto expect_error = [](const auto& spoil) {
    fcl::Transform3d transform = fcl::Transform3d::Identity();
    spoil(transform);
    EXPECT_THROW((void)from_fcl(transform), Error);
    EXPECT_THROW((void)from_fcl(fcl::Transform3f(transform.cast<float>())), Error);
  };
  expect_error([&](fcl::Transform3d& t) { t.linear()(1, 2) = kNan; });
  expect_error([&](fcl::Transform3d& t) { t.translation()[0] = kNan; });
  expect_error([&](fcl::Transform3d& t) { t.translation()[2] = kInfinity; });
  expect_error([&](fcl::Transform3d& t) { t.translation()[2] = 1e16; });
  expect_error([&](fcl::Transform3d& t) { t.linear() *= 1.001; });
  expect_error([&](fcl::Transform3d& t) { t.linear()(0, 1) = 0.001; });
  expect_error([&](fcl::Transform3d& t) { t.linear()(0, 0) = -1.0; });
  expect_error([&](fcl::Transform3d& t) { t.linear().setZero(); });
}

template <class BV>
void expect_mesh(const TriangleMesh& mesh) {
  using S = typename BV::S;
  const TriangleMesh read = from_fcl(*test::fcl_model<BV>(mesh));
  ASSERT_EQ(read.triangles.size(), mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d corner = mesh.vertices[static_cast<std::size_t>(mesh.triangles[i][k])];
      EXPECT_EQ(read.vertices[static_cast<std::size_t>(read.triangles[i][k])],
                corner.cast<S>().template cast<double>());
    }
  }
}

TEST(FclConversions, TrianglesAreThoseOfTheModel) {
  const TriangleMesh mesh = test::fcl_test_mesh("cylinder");
  expect_mesh<fcl::OBBRSSd>(mesh);
  expect_mesh<fcl::OBBd>(mesh);
  expect_mesh<fcl::AABBd>(mesh);
  expect_mesh<fcl::OBBf>(mesh);
}

TEST(FclConversions, ModelsThatAreNoMeshAreErrors) {
  fcl::BVHModel<fcl::OBBRSSd> model, points;
  const auto expect = [](const std::string& text, const fcl::BVHModel<fcl::OBBRSSd>& given) {
    expect_refusal(text, [&] { from_fcl(given); });
  };
  expect("FCL model: it is not finished, endModel()", model);
  model.beginModel();
  model.addTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  expect("endModel", model);
  model.endModel();
  expect("none", model);
  for (const std::size_t index : {std::size_t{3}, std::numeric_limits<std::size_t>::max()}) {
    model.tri_indices[0][2] = index;
    expect("out of range", model);
  }
  model.tri_indices[0][2] = 2;
  model.vertices[1][0] = kNan;
  expect("not finite", model);
  points.beginModel();
  points.addSubModel({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  points.endModel();
  expect("no triangles", points);
}

TEST(FclContinuous, FreeIsFreeAllTheWay) {
  const auto bracket = test::covered_model("bracket"), probe = test::covered_model("probe");
  const FclSolid solid_bracket(test::fcl_test_mesh("bracket")),
      solid_probe(test::fcl_test_mesh("probe"));
  const int steps = test::effort(200, 40);
  api::ContinuousCollisionRequestd request;
  request.ccd_motion_type = fcl::CCDM_LINEAR;
  test::Random random(1);
  int free = 0, collisions = 0;
  for (int i = 0; i < test::effort(150, 20); ++i) {
    const fcl::Transform3d bracket_from = test::random_transform(random, 50.0);
    const fcl::Transform3d bracket_to = test::random_transform(random, 50.0);
    const fcl::Transform3d probe_from = test::random_transform(random, 300.0);
    const fcl::Transform3d probe_to = test::random_transform(random, 300.0);
    api::ContinuousCollisionResultd result;
    const double until = api::continuousCollide(bracket.get(), bracket_from, bracket_to,
                                                probe.get(), probe_from, probe_to, request, result);
    EXPECT_EQ(until, result.time_of_contact);
    const Motion motion_a = Motion::between(api::from_fcl(bracket_from), api::from_fcl(bracket_to));
    const Motion motion_b = Motion::between(api::from_fcl(probe_from), api::from_fcl(probe_to));
    double first = 2.0;
    for (int k = 0; k <= steps && first > 1.0; ++k) {
      const double t = static_cast<double>(k) / steps;
      if (touch(solid_bracket, motion_a.pose_at(t), solid_probe, motion_b.pose_at(t))) first = t;
    }
    if (result.is_collide) {
      ++collisions;
      EXPECT_LT(until, 1.0);
      EXPECT_LE(until, first);
    } else {
      ++free;
      EXPECT_EQ(until, 1.0);
      EXPECT_GT(first, 1.0);
    }
  }
  std::cout << free << " free, " << collisions << " not\n";
  EXPECT_GT(free, 0);
  EXPECT_GT(collisions, 0);
}

// The contact's transforms are ones at which the spheres touch.
TEST(FclContinuous, FindsAThinWallThatSamplesMiss) {
  const TriangleMesh wall_mesh = make_box({1, 200, 200});
  const auto wall = api::sphere_model(*test::fcl_model<fcl::OBBRSSd>(wall_mesh),
                                      {.fit = {.max_error = 10.0, .effort = 0}});
  const auto probe = test::covered_model("probe");
  const auto fcl_wall = test::fcl_model<fcl::OBBRSSd>(wall_mesh);
  const auto fcl_probe = test::fcl_model<fcl::OBBRSSd>(test::fcl_test_mesh("probe"));
  const fcl::Transform3d still = fcl::Transform3d::Identity();
  fcl::Transform3d from = still, to = still;
  from.translation()[0] = -1000.0;
  to.translation()[0] = 1000.0;
  const api::ContinuousCollisionRequestd request;
  fcl::ContinuousCollisionResultd sampled;
  fcl::continuousCollide<double>(fcl_wall.get(), still, still, fcl_probe.get(), from, to, request,
                                 sampled);
  EXPECT_FALSE(sampled.is_collide);

  api::ContinuousCollisionResultd result;
  const api::CollisionObjectd o1(wall, still), o2(probe, from);
  const double until = api::continuousCollide(&o1, still, &o2, to, request, result);
  EXPECT_TRUE(result.is_collide);
  EXPECT_LE(until, 0.49725);  // where the meshes meet
  EXPECT_GE(until, 0.48);
  EXPECT_TRUE(collides(*wall->part().spheres, api::from_fcl(result.contact_tf1),
                       *probe->part().spheres, api::from_fcl(result.contact_tf2)));
}

TEST(FclContinuous, WhatCannotBeProvedIsAnError) {
  const auto probe = test::covered_model("probe");
  const fcl::Transform3d still = fcl::Transform3d::Identity();
  fcl::Transform3d turned = still, scaled = still;
  turned.linear() = Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  scaled.linear() *= 2.0;
  struct Case {
    const fcl::Transform3d& end;
    fcl::CCDMotionType type;
    double toc_err;
    std::string subject;
  };
  for (const Case& c : {Case{turned, fcl::CCDM_LINEAR, 1e-4, "none"},
                        Case{turned, fcl::CCDM_TRANS, 1e-4, "ccd_motion_type:"},
                        Case{still, fcl::CCDM_SCREW, 1e-4, "ccd_motion_type:"},
                        Case{still, fcl::CCDM_SPLINE, 1e-4, "ccd_motion_type:"},
                        Case{still, fcl::CCDM_LINEAR, 0.0, "toc_err:"},
                        Case{still, fcl::CCDM_LINEAR, kNan, "toc_err:"},
                        Case{still, fcl::CCDM_LINEAR, 1e-30, "none"},
                        Case{scaled, fcl::CCDM_LINEAR, 1e-4, "tf1_end:"}}) {
    api::ContinuousCollisionResultd result;
    const api::ContinuousCollisionRequestd request(10, c.toc_err, c.type);
    expect_refusal(c.subject, [&] {
      api::continuousCollide(probe.get(), still, c.end, probe.get(), still, still, request, result);
    });
  }
}

// One object against all that a manager holds: as asking each.
TEST(FclBroadphase, AnswersAsAskingEveryPair) {
  test::Random random(1);
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
  fcl::DynamicAABBTreeCollisionManagerd manager;
  for (int i = 0; i < 40; ++i) {
    const auto model = test::covered_model(random.index(2) == 0 ? "cube" : "bracket");
    objects.push_back(
        std::make_unique<fcl::CollisionObjectd>(model, test::random_transform(random, 1000.0)));
    manager.registerObject(objects.back().get());
  }
  manager.setup();
  int collisions = 0;
  for (int i = 0; i < 60; ++i) {
    fcl::CollisionObjectd probe(test::covered_model("probe"),
                                test::random_transform(random, 1200.0));
    std::size_t contacts = 0;
    double nearest = kInfinity;
    for (const auto& object : objects) {
      api::CollisionResultd result;
      contacts += api::collide(object.get(), &probe, api::CollisionRequestd(1000), result);
      api::DistanceResultd distance;
      nearest =
          std::min(nearest, api::distance(object.get(), &probe, api::DistanceRequestd(), distance));
    }
    api::DefaultCollisionData<double> all, any;
    all.request.num_max_contacts = 100000;
    manager.collide(&probe, &all, api::DefaultCollisionFunction<double>);
    EXPECT_EQ(all.result.numContacts(), contacts);
    EXPECT_FALSE(all.done);
    manager.collide(&probe, &any, api::DefaultCollisionFunction<double>);
    EXPECT_EQ(any.result.numContacts(), contacts > 0 ? 1u : 0u);
    EXPECT_EQ(any.done, contacts > 0);
    api::DefaultDistanceData<double> distance;
    manager.distance(&probe, &distance, api::DefaultDistanceFunction<double>);
    EXPECT_EQ(distance.result.min_distance, nearest);
    collisions += contacts > 0;
  }
  EXPECT_GT(collisions, 2);
  EXPECT_LT(collisions, 50);

  fcl::CollisionObjectd bare(test::fcl_model<fcl::OBBRSSd>(test::fcl_test_mesh("probe")),
                             objects.front()->getTransform());
  api::DefaultCollisionData<double> data;
  EXPECT_THROW(manager.collide(&bare, &data, api::DefaultCollisionFunction<double>), Error);
  api::DefaultDistanceData<double> distance;
  EXPECT_THROW(manager.distance(&bare, &distance, api::DefaultDistanceFunction<double>), Error);
}

}  // namespace
}  // namespace spherule
