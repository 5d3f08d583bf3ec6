// SPDX-License-Identifier: BSD-3-Clause
// Disabled pairs of an SRDF, judged on a robot whose links are known to touch or not.

#include "robot/pairs/srdf_judgement.h"

#include "base/error.h"
#include "robot/check/robot_scene.h"
#include "robot/pairs/allowed_collisions.h"
#include "tests/robot/box_robots.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace spherule::test::srdf_judgement_test {
namespace {

// On a rail: a block, a cart beside it that reaches it at 0.2, a lid fixed to the cart, a bare
// link, and a shelf out of reach of both, on a rail of its own.
BoxRobot rail(double upper = 1.0) {
  BoxRobot robot{RobotModel("block")};
  const auto slide = [=](const char* name, const Eigen::Vector3d& from, double lower) {
    return Joint{.name = name,
                 .type = JointType::kPrismatic,
                 .parent_from_joint = Pose::from_translation(from),
                 .axis = Eigen::Vector3d::UnitX(),
                 .lower = lower,
                 .upper = upper};
  };
  robot.model.add_link("bare", "block", slide("lift", {0, 0, 0}, 0.0));
  robot.model.add_link("cart", "bare", slide("drive", {0, 0, 0}, 0.1));
  robot.model.add_link("lid", "cart", {.name = "fixed"});
  robot.model.add_link("shelf", "block", slide("pull", {0, 2, 0}, 0.0));
  for (const char* const link : {"block", "cart", "lid", "shelf"}) {
    robot.add_boxes(robot.model.find_link(link),
                    {{Eigen::Vector3d::Constant(-0.1), Eigen::Vector3d::Constant(0.1)}});
  }
  return robot;
}

class SrdfJudged : public testing::Test {
 protected:
  SrdfJudgement judge(const std::vector<DisabledPair>& pairs) const {
    SemanticDescription semantics;
    semantics.disabled_pairs = pairs;
    return judge_srdf(robot_.model, semantics, proofs_);
  }
  JudgedPair judge(const char* a, const char* b, const char* reason) const {
    return judge(std::vector<DisabledPair>{{a, b, reason}}).pairs.front();
  }

  BoxRobot robot_ = rail();
  LinkPairs proofs_ = prove_link_pairs(robot_.model, robot_.bodies);
};

TEST_F(SrdfJudged, WhatTouchesIsWrongUnlessItIsADecision) {
  for (const char* const reason : {"Never", "", "Sampled", "Adjacent"}) {
    const JudgedPair judged = judge("lid", "block", reason);
    EXPECT_EQ(judged.verdict, DisabledVerdict::kTouches);
    EXPECT_TRUE(judged.is_wrong) << reason;
    ASSERT_EQ(judged.witness.size(), 3U);
    EXPECT_LE(judged.witness[0] + judged.witness[1], 0.2 + 1e-9);
  }
  for (const char* const reason : {"Default", "Always", "User"}) {
    EXPECT_FALSE(judge("lid", "block", reason).is_wrong) << reason;
  }
}

TEST_F(SrdfJudged, OthersAreToldApart) {
  EXPECT_EQ(judge("cart", "lid", "Never").verdict, DisabledVerdict::kRigid);
  EXPECT_EQ(judge("shelf", "cart", "Never").verdict, DisabledVerdict::kNever);
  EXPECT_EQ(judge("bare", "shelf", "Never").verdict, DisabledVerdict::kNoBody);
  EXPECT_EQ(judge("block", "nobody", "Never").verdict, DisabledVerdict::kOtherRobot);
  EXPECT_EQ(judge("block", "shelf", "Adjacent").verdict, DisabledVerdict::kNever);
  for (const char* const link : {"lid", "shelf", "bare", "nobody"}) {
    EXPECT_FALSE(judge("cart", link, "Never").is_wrong) << link;
  }
}

TEST_F(SrdfJudged, NeighboursAreMeantToTouch) {
  BoxRobot robot{RobotModel("base")};
  robot.model.add_link("arm", "base",
                       {.name = "turn", .type = JointType::kRevolute, .lower = -1, .upper = 1});
  for (const int link : {0, 1}) {
    robot.add_boxes(link, {{Eigen::Vector3d::Constant(-0.1), Eigen::Vector3d::Constant(0.1)}});
  }
  SemanticDescription semantics;
  semantics.disabled_pairs = {{"base", "arm", "Never"}};
  const SrdfJudgement judged =
      judge_srdf(robot.model, semantics, prove_link_pairs(robot.model, robot.bodies));
  EXPECT_EQ(judged.pairs.front().verdict, DisabledVerdict::kAdjacent);
  EXPECT_FALSE(judged.pairs.front().is_wrong);
}

// What is proved of a tool alone, of other limits or another robot says nothing of these links.
TEST_F(SrdfJudged, ProofsThatDoNotHoldForTheLinksAreRefused) {
  const auto expect_refused = [&](const LinkPairs& proofs) {
    EXPECT_THROW(judge_srdf(robot_.model, {}, proofs), Error);
    EXPECT_THROW(pairs_proved_never(robot_.model, proofs), Error);
    AllowedCollisions allowed(robot_.model);
    EXPECT_THROW(allowed.allow(proofs), Error);
    EXPECT_FALSE(allowed.allows("cart", "shelf"));
  };
  BoxRobot tool{robot_.model};
  tool.add_boxes(robot_.model.find_link("cart"),
                 {{Eigen::Vector3d(0, 0, 5), Eigen::Vector3d(0.1, 0.1, 5.1)}});
  expect_refused(prove_attached_pairs(robot_.model, robot_.bodies, tool.bodies.front()));
  const BoxRobot shorter = rail(0.9);
  expect_refused(prove_link_pairs(shorter.model, shorter.bodies));
  BoxRobot other = rail();
  other.model.mimic("pull", "lift");
  expect_refused(prove_link_pairs(other.model, other.bodies));

  AllowedCollisions allowed(robot_.model);
  allowed.allow(proofs_);
  EXPECT_EQ(allowed.reason(robot_.model.find_link("cart"), robot_.model.find_link("shelf")),
            AllowedReason::kProvedNever);
  EXPECT_NO_THROW(RobotScene(robot_.model).set_allowed_collisions(allowed));
  EXPECT_NO_THROW(RobotScene(shorter.model).set_allowed_collisions(allowed));
  EXPECT_THROW(RobotScene(rail(1.1).model).set_allowed_collisions(allowed), Error);
  EXPECT_THROW(RobotScene(other.model).set_allowed_collisions(allowed), Error);
}

TEST_F(SrdfJudged, WhatIsProvedAndMissingCouldBeAdded) {
  using Pairs = std::vector<std::pair<int, int>>;
  const int cart = robot_.model.find_link("cart");
  const int lid = robot_.model.find_link("lid");
  const int shelf = robot_.model.find_link("shelf");
  EXPECT_EQ(judge({{"shelf", "cart", "Never"}}).could_be_added, (Pairs{{0, shelf}, {lid, shelf}}));
  EXPECT_EQ(judge({{"shelf", "lid", "Never"}, {"block", "shelf", "Never"}}).could_be_added,
            (Pairs{{cart, shelf}}));
}

}  // namespace
}  // namespace spherule::test::srdf_judgement_test
