// SPDX-License-Identifier: BSD-3-Clause
// What is proved of pairs of links, against the separating axes of their boxes.

#include "robot/pairs/link_pairs.h"

#include "base/error.h"
#include "robot/model/kinematics.h"
#include "robot/pairs/link_pieces.h"
#include "robot/pairs/pair_search.h"
#include "tests/robot/box_robots.h"
#include "tests/robot/robots.h"
#include "tests/support/effort.h"
#include "tests/support/random_scene.h"
#include "tests/support/rounding_mode.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

using Configuration = std::vector<double>;
using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr double kTurn = 2.0 * std::numbers::pi;

AlignedBox3d box(const Vector3d& low, const Vector3d& high) {
  return {low, high};
}

class LinkPairsOfBoxes : public testing::Test {
 protected:
  void check_configuration(const BoxRobot& robot, const LinkPairs& pairs, const Configuration& q) {
    forward_kinematics(robot.model, q, poses_);
    for (const LinkPair& pair : pairs.pairs()) {
      const bool proved = pairs.is_free(pair.second, pair.first, q);
      const bool touch = boxes_touch(robot, pair.first, pair.second, poses_);
      ASSERT_FALSE(proved && touch) << pair.first << " " << pair.second;
      proved_ += proved ? 1 : 0;
      free_ += touch ? 0 : 1;
    }
  }

  void check_edge(Random& random, const BoxRobot& robot, const LinkPairs& pairs) {
    const Configuration from = random_in_ranges(random, robot.model);
    Configuration to = from;
    const double size = random.whole(0, 1) == 0 ? 0.2 : 2.0;
    for (double& value : to) value += random.between(-size, size);
    for (const LinkPair& pair : pairs.pairs()) {
      if (!pairs.is_edge_free(pair.first, pair.second, from, to)) continue;
      ++edges_;
      Configuration q = from;
      for (int n = 0; n <= 20; ++n) {
        for (std::size_t i = 0; i < q.size(); ++i) {
          q[i] = from[i] + (to[i] - from[i]) * (n / 20.0);
        }
        forward_kinematics(robot.model, q, poses_);
        ASSERT_FALSE(boxes_touch(robot, pair.first, pair.second, poses_));
      }
    }
  }

  std::vector<Pose> poses_;
  std::size_t proved_ = 0;
  std::size_t free_ = 0;
  std::size_t edges_ = 0;
};

TEST_F(LinkPairsOfBoxes, NoneTouchesWhereItIsProvedFree) {
  Random random(41);
  std::array<int, 3> verdicts{};
  for (int n = 0; n < effort(60, 6); ++n) {
    const BoxRobot robot = random_box_robot(random, random.whole(1, 5), n % 2 == 0, n % 3 == 0);
    const LinkPairs pairs = prove_link_pairs(
        robot.model, robot.bodies, {.boxes = 400, .undecided_boxes = 2000, .samples = 60});
    for (const LinkPair& pair : pairs.pairs()) {
      ++verdicts[static_cast<std::size_t>(pair.verdict)];
      EXPECT_TRUE(pair.verdict != PairVerdict::kNever || pair.boxes.is_all_free());
      EXPECT_TRUE(pair.verdict != PairVerdict::kTouching || !pair.boxes.is_all_free());
      if (pair.verdict != PairVerdict::kTouching) continue;
      forward_kinematics(robot.model, pair.witness, poses_);
      EXPECT_TRUE(boxes_touch(robot, pair.first, pair.second, poses_, -1e-9));
      EXPECT_FALSE(pairs.is_free(pair.first, pair.second, pair.witness));
    }
    for (int k = 0; k < 400; ++k) {
      check_configuration(robot, pairs, random_in_ranges(random, robot.model));
      check_edge(random, robot, pairs);
      if (HasFatalFailure()) return;
    }
  }
  EXPECT_GT(verdicts[0], 20 / (kSanitized ? 10 : 1));
  EXPECT_GT(verdicts[1], 20 / (kSanitized ? 10 : 1));
  EXPECT_GT(proved_, free_ / 2);
  EXPECT_GT(edges_, proved_ / 10);
}

// The angle a < 0 at which a post and a bar, turned about z, touch. The post's corner (0.9, -0.1)
// is 0.9 sin(-a) - 0.1 cos(a) = hypot(0.9, 0.1) sin(-a - atan2(0.1, 0.9)) from the bar's middle
// line; no other corner is nearer. They touch where that is 0.02.
const double kContact = -(std::asin(0.02 / std::hypot(0.9, 0.1)) + std::atan2(0.1, 0.9));

TEST(TwoBars, LimitsShortOfContactAreProved) {
  const double angle = kContact;
  const BoxRobot robot = post_and_bar(turning(-2.0, angle - 1e-4));
  const LinkPairs pairs = prove_link_pairs(robot.model, robot.bodies);
  ASSERT_EQ(pairs.pairs().size(), 1U);
  EXPECT_EQ(pairs.pairs()[0].verdict, PairVerdict::kNever);
  EXPECT_TRUE(pairs.is_free(0, 1, Configuration{angle - 1e-4}));
  EXPECT_FALSE(pairs.is_free(0, 1, Configuration{angle - 0.5e-4}));
  EXPECT_TRUE(pairs.is_edge_free(0, 1, Configuration{-2.0}, Configuration{angle - 1e-4}));
  EXPECT_FALSE(pairs.is_edge_free(0, 1, Configuration{-2.0}, Configuration{angle}));
}

TEST(TwoBars, ContactAtTheLimitAloneIsFound) {
  const double angle = kContact;
  BoxRobot robot = post_and_bar(turning(-2.0, angle + 1e-6));
  robot.model.add_link("lamp", "post", turning(0.1, 0.2));
  robot.add_boxes(2, {box({0, 0, 5}, {1, 1, 6})});
  const LinkPairs pairs = prove_link_pairs(robot.model, robot.bodies);
  ASSERT_EQ(pairs.pairs()[0].verdict, PairVerdict::kTouching);
  EXPECT_GE(pairs.pairs()[0].witness[0], angle - 1e-9);
  EXPECT_EQ(pairs.pairs()[0].witness[1], 0.1);  // which has nothing to do with it
  EXPECT_EQ(pairs.pairs()[0].smallest_gap, 0.0);
  EXPECT_TRUE(pairs.is_free(0, 1, Configuration{angle - 0.01, 0.1}));
}

TEST(TwoBars, AProofThatIsNearGoesOnBeyondTheBoxesOfOthers) {
  const BoxRobot robot = post_and_bar(turning(-2.0, kContact - 1e-4));
  const LinkPairs pairs = prove_link_pairs(robot.model, robot.bodies, {.boxes = 6});
  EXPECT_EQ(pairs.pairs()[0].verdict, PairVerdict::kNever);
  EXPECT_GT(pairs.pairs()[0].searched_boxes, 6U);
  EXPECT_EQ(pairs.pairs()[0].smallest_gap, std::numeric_limits<double>::infinity());
}

// An arm of eight turning links whose end comes near its base only where all of them turn as far as
// they can.
TEST(LinkPairs, AProofThatIsFarEndsWithTheBoxesOfOthers) {
  BoxRobot robot{RobotModel("base")};
  robot.add_boxes(0, {cube_at({0, 0, 0})});
  std::string parent = "base";
  for (int i = 1; i <= 8; ++i) {
    Joint joint = turning(-0.75, 0.75);
    joint.parent_from_joint = Pose::from_translation({i == 1 ? 0.0 : 1.0, 0, 0});
    const std::string link = "link" + std::to_string(i);
    robot.model.add_link(link, parent, joint);
    parent = link;
  }
  robot.add_boxes(8, {cube_at({1, 0, 0})});
  const LinkPairs pairs = prove_link_pairs(robot.model, robot.bodies, {.boxes = 20, .samples = 0});
  ASSERT_EQ(pairs.pairs().size(), 1U);
  EXPECT_EQ(pairs.pairs()[0].verdict, PairVerdict::kUnknown);
  EXPECT_EQ(pairs.pairs()[0].searched_boxes, 20U);
}

// A part that slides along an axis of its base; neither has a body yet.
BoxRobot with_sliding_part(double lower, double upper, const Vector3d& axis = Vector3d::UnitX()) {
  BoxRobot robot{RobotModel("base")};
  robot.model.add_link("part", "base", sliding(lower, upper, "slide", axis));
  return robot;
}

TEST(LinkPairs, APartInsideAClosedOneTouchesIt) {
  BoxRobot robot = with_sliding_part(-0.5, 3.0);
  robot.add_boxes(0, {box({-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0})});
  robot.add_boxes(1, {cube_at({0, 0, 0})});
  const LinkPairs pairs = prove_link_pairs(robot.model, robot.bodies);
  ASSERT_EQ(pairs.pairs()[0].verdict, PairVerdict::kTouching);
  for (double x = -0.5; x <= 1.1; x += 0.01) EXPECT_FALSE(pairs.is_free(0, 1, Configuration{x}));
  for (double x = 1.12; x <= 3.0; x += 0.01) EXPECT_TRUE(pairs.is_free(0, 1, Configuration{x}));
}

// Two interleaved combs that slide by a little more than the gaps between their teeth: near its
// ends the range is halved on and on, and each box takes thousands of tests.
TEST(LinkPairs, ASearchEndsWhereItsBoxesTakeManyTests) {
  BoxRobot robot = with_sliding_part(-0.0015, 0.0015, Vector3d::UnitY());
  std::vector<AlignedBox3d> teeth, others;
  for (int i = 0; i < 60; ++i) {
    const double y = 0.02 * i;
    teeth.push_back(box({-1.0, y, 0.0}, {1.0, y + 0.009, 1.0}));
    others.push_back(box({-1.0, y + 0.01, 0.0}, {1.0, y + 0.019, 1.0}));
  }
  robot.add_boxes(0, teeth);
  robot.add_boxes(1, others);
  const LinkPairs pairs = prove_link_pairs(robot.model, robot.bodies,
                                           {.boxes = 50, .samples = 0, .smallest_motion = 1e-9});
  EXPECT_GT(pairs.pairs()[0].searched_boxes, 0U);
  EXPECT_LT(pairs.pairs()[0].searched_boxes, 50U);
}

// A part between the two prongs of a fork, whose hull it is in: only the pieces tell.
TEST(LinkPairs, PiecesProveWhatHullsDoNot) {
  BoxRobot robot = with_sliding_part(-0.5, 0.5);
  robot.add_boxes(
      0, {box({-1.0, 0.2, -0.1}, {1.0, 0.3, 0.1}), box({-1.0, -0.3, -0.1}, {1.0, -0.2, 0.1})});
  robot.add_boxes(1, {cube_at({0, 0, 0})});
  const LinkPairs pairs = prove_link_pairs(robot.model, robot.bodies);
  EXPECT_EQ(pairs.pairs()[0].verdict, PairVerdict::kNever);
}

// Two finely tessellated spheres pass each other, vertex at vertex. Few vertices are kept of the
// convex hull of the first one, and this vertex is none of them.
TEST(LinkPairs, CornersThatAreNotKeptCount) {
  constexpr double kRadius = 0.1;
  const TriangleMesh unit = icosphere(4);
  const auto sphere = [&](int link, const Vector3d& center) {
    TriangleMesh mesh = unit;
    for (Vector3d& vertex : mesh.vertices) vertex = kRadius * vertex + center;
    return LinkBody{.link = link, .mesh = std::make_shared<const SolidMesh>(mesh)};
  };
  const std::vector<LinkBody> first{sphere(0, Vector3d::Zero())};
  const internal::LinkPieces pieces = internal::make_link_pieces(first);
  EXPECT_LT(pieces.hull.size(), unit.vertices.size());
  EXPECT_GT(pieces.hull_radius, 1e-5);
  const auto left_out =
      std::find_if(unit.vertices.begin(), unit.vertices.end(), [&](const Vector3d& vertex) {
        return std::abs(vertex.x()) < 0.5 && std::ranges::none_of(pieces.hull, [&](const auto& p) {
                 return (p - kRadius * vertex).norm() < 1e-9;
               });
      });
  ASSERT_NE(left_out, unit.vertices.end());
  for (const double gap : {0.0015, -2e-5}) {
    BoxRobot robot = with_sliding_part(-0.5, 0.5);
    robot.bodies = {first.front(), sphere(1, (2.0 * kRadius + gap) * left_out->normalized())};
    const LinkPairs pairs = prove_link_pairs(robot.model, robot.bodies);
    EXPECT_EQ(pairs.pairs()[0].verdict == PairVerdict::kNever, gap > 0.0);
    EXPECT_EQ(pairs.is_free(0, 1, Configuration{0.0}), gap > 0.0);
  }
}

TEST(LinkPairs, ContinuousJointsTakeEveryTurn) {
  const BoxRobot robot = post_and_bar(wheel());
  const LinkPairs pairs = prove_link_pairs(robot.model, robot.bodies);
  for (int turns = -3; turns <= 3; ++turns) {
    EXPECT_TRUE(pairs.is_free(0, 1, Configuration{1.0 + kTurn * turns}));
    EXPECT_TRUE(pairs.is_free(0, 1, Configuration{std::numbers::pi + kTurn * turns}));
    EXPECT_FALSE(pairs.is_free(0, 1, Configuration{kTurn * turns}));
    EXPECT_TRUE(pairs.is_edge_free(0, 1, Configuration{1.0 + kTurn * turns},
                                   Configuration{3.0 + kTurn * turns}));
    EXPECT_FALSE(pairs.is_edge_free(0, 1, Configuration{-1.0 + kTurn * turns},
                                    Configuration{1.0 + kTurn * turns}));
  }
  EXPECT_FALSE(pairs.is_free(0, 1, Configuration{1e9}));
  EXPECT_FALSE(pairs.is_free(0, 1, Configuration{std::nan("")}));
}

// A lever that follows a wheel at a tenth of its angle comes to the post after two turns.
TEST(LinkPairs, WhatFollowsAContinuousJointIsProvedForOneTurn) {
  BoxRobot robot{RobotModel("post")};
  robot.model.add_link("wheel", "post", wheel("turn"));
  robot.model.add_link("lever", "post", wheel("follow"));
  robot.model.mimic("follow", "turn", 0.1);
  robot.add_boxes(0, {cube_at({0, 1, 0})});
  robot.add_boxes(2, {box({0.0, -0.02, -0.05}, {2.0, 0.02, 0.05})});
  const LinkPairs pairs = prove_link_pairs(robot.model, robot.bodies);
  ASSERT_EQ(pairs.pairs().size(), 1U);
  EXPECT_EQ(pairs.pairs()[0].verdict, PairVerdict::kUnknown);
  EXPECT_TRUE(pairs.pairs()[0].witness.empty());
  EXPECT_TRUE(pairs.is_free(0, 2, Configuration{std::numbers::pi}));
  std::vector<Pose> poses;
  const Configuration touching{5.0 * std::numbers::pi};
  forward_kinematics(robot.model, touching, poses);
  EXPECT_TRUE(boxes_touch(robot, 0, 2, poses));
  EXPECT_FALSE(pairs.is_free(0, 2, touching));
}

TEST(LinkPairs, SpheresCountAsSolid) {
  RobotModel robot("base");
  robot.add_link("arm", "base", sliding(0.0, 2.0));
  const auto sphere = one_sphere_tree(Vector3d::Zero(), 0.5);
  const std::vector<LinkBody> bodies{{.link = 0, .spheres = sphere},
                                     {.link = 1, .spheres = sphere}};
  const LinkPairs pairs = prove_link_pairs(robot, bodies);
  EXPECT_EQ(pairs.pairs()[0].verdict, PairVerdict::kTouching);
  EXPECT_FALSE(pairs.is_free(0, 1, Configuration{1.0}));
  EXPECT_TRUE(pairs.is_free(0, 1, Configuration{1.01}));
}

TEST(LinkPairs, ThreadsChangeNothing) {
  Random random(5);
  const BoxRobot robot = random_box_robot(random, 5, true, true);
  double last = 0.0;
  const LinkPairs one = prove_link_pairs(robot.model, robot.bodies,
                                         {.boxes = 300,
                                          .undecided_boxes = 300,
                                          .threads = 1,
                                          .progress = [&](double share, const char*) {
                                            EXPECT_GT(share, last);
                                            last = share;
                                          }});
  EXPECT_EQ(last, 1.0);
  const LinkPairs many = prove_link_pairs(robot.model, robot.bodies,
                                          {.boxes = 300, .undecided_boxes = 300, .threads = 4});
  ASSERT_EQ(one.pairs().size(), many.pairs().size());
  for (std::size_t i = 0; i < one.pairs().size(); ++i) {
    EXPECT_EQ(one.pairs()[i].boxes.nodes(), many.pairs()[i].boxes.nodes());
    EXPECT_EQ(one.pairs()[i].witness, many.pairs()[i].witness);
  }
}

TEST(LinkPairs, RefusesWhatItCannotUse) {
  const RobotModel robot("base");
  const std::vector<LinkBody> nothing{{.link = 0}};
  EXPECT_THROW(prove_link_pairs(robot, nothing), Error);
  const std::vector<LinkBody> beyond{{.link = 1}};
  EXPECT_THROW(prove_link_pairs(robot, beyond), Error);
  EXPECT_THROW(prove_link_pairs(robot, {}, {.seconds = -1.0}), Error);
  EXPECT_TRUE(prove_link_pairs(robot, {}).pairs().empty());
  expect_rounding_to_nearest_is_needed([&] { prove_link_pairs(robot, {}); }, "prove_link_pairs");
  const LinkBody held{.link = 0, .spheres = one_sphere_tree({0, 0, 0}, 1.0)};
  expect_rounding_to_nearest_is_needed([&] { prove_attached_pairs(robot, {}, held); }, "tool");
}

}  // namespace
}  // namespace spherule::test
