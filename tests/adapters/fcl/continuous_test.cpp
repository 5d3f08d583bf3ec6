// SPDX-License-Identifier: BSD-3-Clause
#include "adapters/fcl/collide.h"
#include "base/error.h"
#include "collide/collide.h"
#include "collide/motion/motion.h"
#include "tests/adapters/fcl/models.h"
#include "tests/support/effort.h"
#include "tests/support/fcl_solid.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

#include <fcl/narrowphase/continuous_collision.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

namespace spherule {
namespace {

namespace api = fcl_api;

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
  fcl::Transform3d turned = still;
  turned.linear() = Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto subject = [&](const fcl::Transform3d& end,
                           const api::ContinuousCollisionRequestd& request) -> std::string {
    api::ContinuousCollisionResultd result;
    try {
      api::continuousCollide(probe.get(), still, end, probe.get(), still, still, request, result);
    } catch (const Error& error) {
      return error.subject();
    }
    return "none";
  };
  const auto request = [](fcl::CCDMotionType type, double toc_err) {
    return api::ContinuousCollisionRequestd(10, toc_err, type);
  };
  EXPECT_EQ(subject(turned, request(fcl::CCDM_LINEAR, 1e-4)), "none");
  EXPECT_EQ(subject(turned, request(fcl::CCDM_TRANS, 1e-4)), "ccd_motion_type");
  EXPECT_EQ(subject(still, request(fcl::CCDM_SCREW, 1e-4)), "ccd_motion_type");
  EXPECT_EQ(subject(still, request(fcl::CCDM_SPLINE, 1e-4)), "ccd_motion_type");
  EXPECT_EQ(subject(still, request(fcl::CCDM_LINEAR, 0.0)), "toc_err");
  EXPECT_EQ(subject(still, request(fcl::CCDM_LINEAR, std::nan(""))), "toc_err");
  EXPECT_EQ(subject(still, request(fcl::CCDM_LINEAR, 1e-30)), "none");
  turned.linear() *= 2.0;
  EXPECT_EQ(subject(turned, request(fcl::CCDM_LINEAR, 1e-4)), "tf1_end");
}

}  // namespace
}  // namespace spherule
