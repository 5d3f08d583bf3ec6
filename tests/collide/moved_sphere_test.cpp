// SPDX-License-Identifier: BSD-3-Clause
// How far points of a sphere move, against where they are.

#include "collide/mechanism/coherence_cache.h"
#include "tests/collide/scene_random.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::KernelFrame;
using internal::KernelPose;
using internal::MovedSphere;

// A chain or a tree of frames; two may share a variable.
std::vector<KernelFrame> random_frames(SceneRandom& random, int count) {
  std::vector<KernelFrame> frames;
  for (int i = 0; i < count; ++i) {
    KernelFrame frame = {};
    const Eigen::Matrix3d rotation = random.quaternion().normalized().toRotationMatrix();
    const Vector3d origin = random.point(random.whole(0, 2) == 0 ? 0.0 : 1.0);
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) frame.rotation[j][k] = rotation(k, j);
      frame.origin[j] = origin[j];
    }
    frame.parent = random.whole(0, 3) == 0 ? random.whole(-1, i - 1) : i - 1;
    frame.variable = random.whole(0, 9) == 0 ? 0 : i;
    frame.prismatic = random.whole(0, 3) == 0;
    frames.push_back(frame);
  }
  return frames;
}

std::vector<KernelPose> placed(const std::vector<KernelFrame>& frames,
                               const std::vector<double>& at) {
  std::vector<Eigen::Isometry3d> poses;
  std::vector<KernelPose> result;
  for (const KernelFrame& frame : frames) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (int j = 0; j < 3; ++j) {
      for (int k = 0; k < 3; ++k) pose.linear()(k, j) = frame.rotation[j][k];
      pose.translation()[j] = frame.origin[j];
    }
    const double variable = at[static_cast<std::size_t>(frame.variable)];
    if (frame.prismatic) {
      pose.translate(Vector3d(0, 0, variable));
    } else {
      pose.rotate(Eigen::AngleAxisd(variable, Vector3d::UnitZ()));
    }
    if (frame.parent >= 0) pose = poses[static_cast<std::size_t>(frame.parent)] * pose;
    poses.push_back(pose);
    KernelPose& columns = result.emplace_back();
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 3; ++k) columns.columns[j][k] = pose.matrix()(k, j);
    }
  }
  return result;
}

Vector3d image(const KernelPose& pose, const Vector3d& p) {
  Vector3d result;
  for (int k = 0; k < 3; ++k) {
    result[k] = pose.columns[0][k] * p.x() + pose.columns[1][k] * p.y() +
                pose.columns[2][k] * p.z() + pose.columns[3][k];
  }
  return result;
}

// Of the frames: how many of them share a variable at most.
double most_uses(const std::vector<KernelFrame>& frames) {
  std::vector<int> uses(frames.size(), 0);
  for (const KernelFrame& frame : frames) ++uses[static_cast<std::size_t>(frame.variable)];
  return *std::max_element(uses.begin(), uses.end());
}

// Of the sphere's points from the joints that carry it, and at least one.
double reach(const std::vector<KernelFrame>& frames, const std::vector<KernelPose>& poses,
             int frame, const Vector3d& center, double radius) {
  const Vector3d c = image(poses[static_cast<std::size_t>(frame)], center);
  double result = 1.0;
  for (int f = frame; f >= 0; f = frames[static_cast<std::size_t>(f)].parent) {
    const Vector3d origin = image(poses[static_cast<std::size_t>(f)], Vector3d::Zero());
    result = std::max(result, (c - origin).norm() + radius);
  }
  return result;
}

// To first order the sphere's centre goes by v and all is turned by w: said is |v| + |w| radius,
// and some point goes by the root of the sum of their squares, of which 60 points miss little. The
// rest is in the squares of the changes, for what is said and for what is true.
TEST(MovedSphere, NoPointGoesFurtherThanIsSaid) {
  SceneRandom random(71);
  int known = 0, tight = 0, curved = 0;
  for (int i = 0; i < 4000; ++i) {
    const int count = random.whole(1, 7);
    const std::vector<KernelFrame> frames = random_frames(random, count);
    std::vector<double> from(static_cast<std::size_t>(count)), to(from);
    const double size = std::pow(10.0, random.uniform(-9.0, 0.3));
    for (std::size_t k = 0; k < from.size(); ++k) {
      from[k] = random.uniform(-3.0, 3.0);
      to[k] = from[k] + (random.whole(0, 2) == 0 ? 0.0 : size * random.uniform(-1.0, 1.0));
    }
    const std::vector<KernelPose> before = placed(frames, from), after = placed(frames, to);
    const int frame = random.whole(0, count - 1);
    const Vector3d center = random.point(1.0);
    const double radius = random.whole(0, 4) == 0 ? 0.0 : random.uniform(0.0, 1.0);
    MovedSphere sphere(frames.data(), frames.size(), 1e-11);
    EXPECT_EQ(sphere.way_to(from.data()), std::numeric_limits<double>::infinity());
    sphere.place(frame, center.data(), radius, before.data(), from.data());
    const double said = sphere.way_to(to.data());
    if (std::isinf(said)) {
      EXPECT_GT(size, 0.01);
      continue;
    }
    const auto f = static_cast<std::size_t>(frame);
    double farthest = 0.0;
    for (int k = 0; k < 60; ++k) {
      const Vector3d p = center + radius * random.point(1.0).normalized();
      farthest = std::max(farthest, (image(after[f], p) - image(before[f], p)).norm());
    }
    ASSERT_LE(farthest, said + 1e-14) << i;
    double changes = 0.0;
    for (std::size_t k = 0; k < from.size(); ++k) changes += std::abs(to[k] - from[k]);
    // A variable that moves several frames counts for each.
    changes *= most_uses(frames);
    const double bent = changes * changes * reach(frames, before, frame, center, radius);
    ASSERT_LE(said, 1.5 * farthest + 4.0 * bent + 2e-11 * changes + 1e-14) << i;
    ++known;
    tight += farthest > 0.9 * said;
    curved += size > 0.05;
  }
  EXPECT_GT(known, 2500);
  EXPECT_GT(tight, 800);
  EXPECT_GT(curved, 100);
}

TEST(MovedSphere, CountsTheCurvatureOfTheWay) {
  // Two hinges with parallel axes, one metre between them and another to the tip.
  KernelFrame hinge = {};
  for (int k = 0; k < 3; ++k) hinge.rotation[k][k] = 1.0;
  hinge.parent = -1;
  KernelFrame second = hinge;
  second.parent = 0;
  second.variable = 1;
  second.origin[0] = 1.0;
  const std::vector<KernelFrame> frames = {hinge, second};
  const std::vector<double> from = {0.0, 0.0};
  const Vector3d tip(1.0, 0.0, 0.0);
  MovedSphere sphere(frames.data(), 2, 0.0);
  const std::vector<KernelPose> before = placed(frames, from);
  sphere.place(1, tip.data(), 0.0, before.data(), from.data());
  // First order: the tip moves by 2 a - 2 a = 0.
  const std::vector<double> to = {0.05, -0.1};
  const std::vector<KernelPose> after = placed(frames, to);
  const double moved = (image(after[1], tip) - image(before[1], tip)).norm();
  const double said = sphere.way_to(to.data());
  EXPECT_GT(moved, 0.002);
  EXPECT_LE(moved, said);
  // Terms of second order alone, their lengths a quarter of the reach too large.
  EXPECT_LT(said, 0.02);
}

}  // namespace
}  // namespace spherule::test
