// SPDX-License-Identifier: BSD-3-Clause
// False alarms counted one by one, against separating axes of boxes and distances of centres.

#include "robot/cover/false_alarms.h"

#include "base/error.h"
#include "robot/cover/alarm_sample.h"
#include "robot/model/kinematics.h"
#include "spheretree/sphere_tree.h"
#include "tests/robot/box_robots.h"
#include "tests/robot/robots.h"
#include "tests/support/effort.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

// Each box gets the sphere through its corners, a little larger.
Sphere sphere_around(const AlignedBox3d& box) {
  return {box.center(), 0.5 * box.diagonal().norm() + 1e-9};
}

void cover_boxes(BoxRobot& robot) {
  for (std::size_t link = 0; link < robot.boxes.size(); ++link) {
    std::vector<Sphere> spheres;
    for (const AlignedBox3d& box : robot.boxes[link]) spheres.push_back(sphere_around(box));
    if (spheres.empty()) continue;
    robot.model.attach(robot.model.links()[link].name,
                       std::make_shared<const SphereTree>(build_tree(spheres)));
  }
}

// A unit cube that ends at x = 0, and one that starts at x = q: they touch up to q = 0.
class TwoCubes : public testing::Test {
 protected:
  static constexpr double kLower = -0.5;
  static constexpr double kUpper = 3.5;

  TwoCubes() {
    robot_.model.add_link("slider", "post", sliding(kLower, kUpper));
    robot_.add_boxes(0, {AlignedBox3d(Vector3d(-1, 0, 0), Vector3d(0, 1, 1))});
    robot_.add_boxes(1, {AlignedBox3d(Vector3d(0, 0, 0), Vector3d(1, 1, 1))});
    cover_boxes(robot_);
    allowed_ = std::make_unique<AllowedCollisions>(robot_.model);
    allowed_->forbid("post", "slider");
  }

  FalseAlarms measure(const FalseAlarmOptions& options, const LinkPairs* proofs = nullptr) const {
    return measure_false_alarms(robot_.model, robot_.bodies, *allowed_, proofs, options);
  }
  // Their spheres touch up to there.
  static double reach() { return std::sqrt(3.0) - 1.0; }

  BoxRobot robot_{RobotModel("post")};
  std::unique_ptr<AllowedCollisions> allowed_;
};

TEST_F(TwoCubes, ShareIsThatOfLengths) {
  const FalseAlarms alarms = measure({.postures = 20000});
  const double share = reach() / kUpper;
  const auto free = static_cast<double>(alarms.free);
  EXPECT_EQ(alarms.postures, 20000U);
  EXPECT_NEAR(free / 20000.0, kUpper / (kUpper - kLower), 0.012);
  EXPECT_NEAR(alarms.refused_share().share(), share, 4.0 * std::sqrt(share * (1 - share) / free));
  EXPECT_GT(alarms.refused_share().upper_bound(0.9999), share);
  EXPECT_LT(alarms.refused_share().upper_bound(), share * 1.1);
  ASSERT_EQ(alarms.pairs.size(), 1U);
  EXPECT_EQ(alarms.pairs[0].refused, alarms.refused_share().refused);
  EXPECT_EQ(alarms.pairs[0].refused_alone, alarms.refused_share().refused);
  EXPECT_GT(alarms.pairs[0].median_gap, 0.25 * reach());
  EXPECT_LT(alarms.pairs[0].median_gap, 0.75 * reach());
}

TEST_F(TwoCubes, GapIsThatOfTheMeshes) {
  const FalseAlarms alarms = measure_false_alarms(robot_.model, robot_.bodies, *allowed_, nullptr,
                                                  std::vector{0.1, 0.35, 0.5, -0.2, 3.0});
  EXPECT_EQ(alarms.free, 4U);
  ASSERT_EQ(alarms.pairs.size(), 1U);
  EXPECT_EQ(alarms.pairs[0].refused, 3U);
  EXPECT_NEAR(alarms.pairs[0].median_gap, 0.35, 0.035);
}

TEST_F(TwoCubes, ProofsSpareTests) {
  const LinkPairs proofs =
      prove_link_pairs(robot_.model, robot_.bodies, {.boxes = 400, .samples = 20});
  const FalseAlarms alarms = measure({.postures = 2000}, &proofs);
  EXPECT_GT(alarms.refused_share(PairProofs::kNone).share(), 0.15);
  EXPECT_EQ(alarms.refused[0], alarms.refused[1]);  // the two can touch
  EXPECT_LT(alarms.refused_share().share(), 0.01);
}

TEST_F(TwoCubes, WhatIsProvedWithinLimitsMayTouchBeyondThem) {
  BoxRobot robot{RobotModel("post")};
  robot.model.add_link("slider", "post", sliding(0.1, 3.5));
  for (const int link : {0, 1}) robot.add_boxes(link, robot_.boxes[static_cast<std::size_t>(link)]);
  cover_boxes(robot);
  AllowedCollisions allowed(robot.model);
  allowed.forbid("post", "slider");
  const LinkPairs proofs = prove_link_pairs(robot.model, robot.bodies);
  ASSERT_EQ(proofs.pairs().front().verdict, PairVerdict::kNever);
  const FalseAlarms alarms = measure_false_alarms(robot.model, robot.bodies, allowed, &proofs,
                                                  std::vector{0.5, -0.2, 0.05});
  EXPECT_EQ(alarms.free, 2U);
  EXPECT_EQ(alarms.refused, (std::array<std::size_t, 3>{2, 0, 1}));
}

TEST_F(TwoCubes, AllowedPairsRefuseNothing) {
  allowed_->allow("post", "slider");
  const FalseAlarms alarms = measure({.postures = 100});
  EXPECT_EQ(alarms.free, 100U);
  EXPECT_TRUE(alarms.pairs.empty());
}

TEST_F(TwoCubes, PairsThatAlwaysTouchAreNamedAndLeftOut) {
  const FalseAlarms without = measure({});
  EXPECT_TRUE(without.always_touching.empty());
  // A sleeve around the slider's whole way.
  robot_.model.add_link("sleeve", "post", {.name = "weld", .type = JointType::kFixed});
  robot_.add_boxes(2, {AlignedBox3d(Vector3d(-9, 0, 0), Vector3d(9, 1, 1))});
  const Sphere around = sphere_around(robot_.boxes[2][0]);
  robot_.model.attach("sleeve", one_sphere_tree(around.center, around.radius));
  AllowedCollisions allowed(robot_.model);
  allowed.forbid("post", "slider");
  allowed.forbid("sleeve", "slider");
  const FalseAlarms alarms = measure_false_alarms(robot_.model, robot_.bodies, allowed, nullptr);
  EXPECT_EQ(alarms.always_touching, (std::vector{std::pair(1, 2)}));
  EXPECT_EQ(alarms.free, without.free);
  EXPECT_EQ(alarms.refused, without.refused);
}

TEST_F(TwoCubes, RefusesBadInput) {
  EXPECT_THROW(measure({.postures = 0}), Error);
  EXPECT_THROW(measure_false_alarms(robot_.model, robot_.bodies, *allowed_, nullptr,
                                    std::span<const double>()),
               Error);
  const std::span first(robot_.bodies.data(), 1);
  EXPECT_THROW(measure_false_alarms(robot_.model, first, *allowed_, nullptr), Error);
  const LinkPairs of_others = prove_link_pairs(robot_.model, first, {.boxes = 1, .samples = 1});
  EXPECT_THROW(measure({}, &of_others), Error);
  std::vector<LinkBody> bodies = robot_.bodies;
  bodies[0].link = 2;
  EXPECT_THROW(measure_false_alarms(robot_.model, bodies, *allowed_, nullptr), Error);
  bodies[0] = {.link = 0};
  EXPECT_THROW(measure_false_alarms(robot_.model, bodies, *allowed_, nullptr), Error);
}

// Counts by brute force.
struct Counts {
  std::size_t free = 0;
  std::array<std::size_t, 3> refused{};
  std::map<std::pair<int, int>, std::pair<std::size_t, std::size_t>> pairs;  // all, and alone
};

bool spheres_overlap(const BoxRobot& robot, int first, int second, std::span<const Pose> poses) {
  for (const AlignedBox3d& a : robot.boxes[static_cast<std::size_t>(first)]) {
    for (const AlignedBox3d& b : robot.boxes[static_cast<std::size_t>(second)]) {
      const Sphere of_a = sphere_around(a);
      const Sphere of_b = sphere_around(b);
      const double distance = (poses[static_cast<std::size_t>(first)] * of_a.center -
                               poses[static_cast<std::size_t>(second)] * of_b.center)
                                  .norm();
      if (distance <= of_a.radius + of_b.radius) return true;
    }
  }
  return false;
}

void count_posture(const BoxRobot& robot, const AllowedCollisions& allowed, const LinkPairs& proofs,
                   PairProofs blamed_with, std::span<const double> q, Counts& counts) {
  std::vector<Pose> poses;
  forward_kinematics(robot.model, q, poses);
  std::array<std::vector<std::pair<int, int>>, 3> alarms;
  const int links = static_cast<int>(robot.boxes.size());
  for (int first = 0; first < links; ++first) {
    for (int second = first + 1; second < links; ++second) {
      if (allowed.allows(first, second)) continue;
      if (boxes_touch(robot, first, second, poses)) return;
      if (!spheres_overlap(robot, first, second, poses)) continue;
      alarms[0].emplace_back(first, second);
      const LinkPair* const proof = proofs.find(first, second);
      const bool is_never = proof != nullptr && proof->verdict == PairVerdict::kNever;
      if (!is_never) alarms[1].emplace_back(first, second);
      if (proof == nullptr || !proof->boxes.contains(q)) alarms[2].emplace_back(first, second);
    }
  }
  ++counts.free;
  for (std::size_t i = 0; i < 3; ++i) counts.refused[i] += alarms[i].empty() ? 0 : 1;
  const auto& blamed = alarms[static_cast<std::size_t>(blamed_with)];
  for (const auto& pair : blamed) {
    ++counts.pairs[pair].first;
    counts.pairs[pair].second += blamed.size() == 1 ? 1 : 0;
  }
}

TEST(FalseAlarmsOfBoxes, CountsAreThoseOfBruteForce) {
  Random random(7);
  std::size_t refused = 0;
  std::size_t spared = 0;
  std::size_t shared = 0;
  for (int n = 0; n < effort(24, 4); ++n) {
    BoxRobot robot = random_box_robot(random, random.whole(2, 5), n % 2 == 0, n % 3 == 0);
    if (robot.model.variable_count() == 0) continue;
    robot.boxes.resize(robot.model.links().size());
    cover_boxes(robot);
    const AllowedCollisions allowed(robot.model);
    const LinkPairs proofs = prove_link_pairs(
        robot.model, robot.bodies, {.boxes = 200, .undecided_boxes = 500, .samples = 20});
    std::vector<double> postures;
    for (int k = 0; k < 300; ++k) {
      for (const int j : robot.model.variable_joints()) {
        const Joint& joint = robot.model.joints()[static_cast<std::size_t>(j)];
        // Beyond the limits, too.
        const double beyond = k % 3 == 0 ? 0.5 : 0.0;
        postures.push_back(random.between(joint.lower - beyond, joint.upper + beyond));
      }
    }
    const auto with = static_cast<PairProofs>(n % 3);
    Counts counts;
    const auto width = static_cast<std::size_t>(robot.model.variable_count());
    for (std::size_t at = 0; at < postures.size(); at += width) {
      count_posture(robot, allowed, proofs, with, std::span(postures).subspan(at, width), counts);
    }
    for (const int threads : {1, 3}) {
      const FalseAlarms alarms =
          measure_false_alarms(robot.model, robot.bodies, allowed, &proofs, postures,
                               {.proofs = with, .gaps = 1, .threads = threads});
      EXPECT_EQ(alarms.free, counts.free);
      EXPECT_EQ(alarms.refused, counts.refused);
      EXPECT_EQ(alarms.refused_share().refused, counts.refused[static_cast<std::size_t>(with)]);
      ASSERT_EQ(alarms.pairs.size(), counts.pairs.size());
      for (const PairAlarms& pair : alarms.pairs) {
        const auto& [all, alone] = counts.pairs.at({pair.first, pair.second});
        EXPECT_EQ(pair.refused, all);
        EXPECT_EQ(pair.refused_alone, alone);
        shared += all - alone;
      }
    }
    refused += counts.refused[2];
    spared += counts.refused[0] - counts.refused[2];
  }
  EXPECT_GT(refused, 50U);
  EXPECT_GT(spared, 50U);
  EXPECT_GT(shared, 10U);
}

TEST(ShareUpperBound, LeavesSoFewHitsTheirProbability) {
  EXPECT_EQ(internal::share_upper_bound(0, 0, 0.95), 1.0);
  EXPECT_EQ(internal::share_upper_bound(7, 7, 0.95), 1.0);
  // (1 - p)^n = 0.05.
  EXPECT_NEAR(internal::share_upper_bound(0, 60, 0.95), 1.0 - std::pow(0.05, 1.0 / 60.0), 1e-12);
  // The published two-sided interval of 90 % for 10 of 100.
  EXPECT_NEAR(internal::share_upper_bound(10, 100, 0.95), 0.16372, 1e-4);
  for (const auto& [hits, trials] : {std::pair(3U, 40U), std::pair(200U, 1000U)}) {
    const double share = internal::share_upper_bound(hits, trials, 0.99);
    long double term = std::pow(1.0L - share, static_cast<long double>(trials));
    long double sum = term;
    for (unsigned i = 0; i < hits; ++i) {
      term *= static_cast<long double>(trials - i) / (i + 1) * share / (1.0L - share);
      sum += term;
    }
    EXPECT_NEAR(static_cast<double>(sum), 0.01, 1e-9);
  }
  // 0.99^100000 is far below the least double.
  const double large = internal::share_upper_bound(1000, 100000, 0.95);
  EXPECT_GT(large, 0.0105);
  EXPECT_LT(large, 0.0106);
}

}  // namespace
}  // namespace spherule::test
