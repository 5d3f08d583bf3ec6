// SPDX-License-Identifier: BSD-3-Clause
#include "adapters/fcl/conversions.h"

#include "base/error.h"
#include "tests/adapters/fcl/models.h"
#include "tests/support/random.h"

#include <fcl/math/bv/OBBRSS.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace spherule {
namespace {

using fcl_api::from_fcl;
using fcl_api::to_fcl;

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
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  expect_error([&](fcl::Transform3d& t) { t.linear()(1, 2) = nan; });
  expect_error([&](fcl::Transform3d& t) { t.translation()[0] = nan; });
  expect_error([&](fcl::Transform3d& t) { t.translation()[2] = infinite; });
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

std::string reason(const fcl::BVHModel<fcl::OBBRSSd>& model) {
  try {
    from_fcl(model);
  } catch (const Error& error) {
    EXPECT_EQ(error.subject(), "FCL model");
    return error.reason();
  }
  return {};
}

TEST(FclConversions, ModelsThatAreNoMeshAreErrors) {
  fcl::BVHModel<fcl::OBBRSSd> model;
  EXPECT_NE(reason(model).find("endModel"), std::string::npos);
  model.beginModel();
  model.addTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_NE(reason(model).find("endModel"), std::string::npos);
  model.endModel();
  EXPECT_EQ(reason(model), "");
  model.tri_indices[0][2] = 3;
  EXPECT_NE(reason(model).find("out of range"), std::string::npos);
  model.tri_indices[0][2] = std::numeric_limits<std::size_t>::max();
  EXPECT_NE(reason(model).find("out of range"), std::string::npos);
  model.tri_indices[0][2] = 2;
  model.vertices[1][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(reason(model).find("not finite"), std::string::npos);

  fcl::BVHModel<fcl::OBBRSSd> points;
  points.beginModel();
  points.addSubModel({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  points.endModel();
  EXPECT_NE(reason(points).find("no triangles"), std::string::npos);
}

}  // namespace
}  // namespace spherule
