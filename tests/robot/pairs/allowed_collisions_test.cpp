// SPDX-License-Identifier: BSD-3-Clause
#include "robot/pairs/allowed_collisions.h"

#include "base/error.h"
#include "robot/check/robot_collision.h"
#include "robot/check/robot_scene.h"
#include "robot/pairs/srdf_judgement.h"
#include "tests/robot/box_robots.h"
#include "tests/robot/robots.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

// base - (turns) - a - (turns) - flange, without spheres - (fixed) - tool - (turns) - finger, and
// base - (fixed) - plate.
RobotModel arm() {
  RobotModel robot("base");
  robot.add_link("plate", "base", {});
  robot.add_link("a", "base", turning(-3.0, 3.0));
  robot.add_link("flange", "a", turning(-3.0, 3.0));
  robot.add_link("tool", "flange", {});
  robot.add_link("finger", "tool", turning(-3.0, 3.0));
  for (const char* link : {"base", "plate", "a", "tool", "finger"}) {
    robot.attach(link, one_sphere_tree({0, 0, 0}, 0.1));
  }
  return robot;
}

TEST(AllowedCollisions, GivenByName) {
  AllowedCollisions allowed(arm());
  const std::vector<DisabledPair> pairs = {{"plate", "a", ""}, {"a", "base", "Never"}};
  allowed.allow(pairs);
  EXPECT_TRUE(allowed.allows("plate", "a"));
  EXPECT_EQ(allowed.reason(1, 2), AllowedReason::kGiven);
  EXPECT_EQ(allowed.reason(0, 2), AllowedReason::kAdjacent) << "keeps its reason";
  allowed.forbid("a", "plate");
  allowed.forbid("a", "base");
  EXPECT_FALSE(allowed.allows("plate", "a"));
  EXPECT_FALSE(allowed.allows(0, 2));

  const AllowedCollisions before = allowed;
  const std::vector<DisabledPair> half_known = {{"plate", "finger", ""}, {"a", "nose", ""}};
  EXPECT_THROW(allowed.allow(half_known), Error);
  EXPECT_FALSE(allowed.allows("plate", "finger")) << "nothing is taken of a list that is refused";
  EXPECT_EQ(allowed.pairs().size(), before.pairs().size());
  EXPECT_THROW(allowed.allow("a", "nose"), Error);
  EXPECT_THROW(allowed.forbid("nose", "a"), Error);
  EXPECT_THROW(allowed.forbid("a", "a"), Error);
  EXPECT_THROW((void)allowed.allows("nose", "a"), Error);
  EXPECT_THROW(allowed.allow(0, 6, AllowedReason::kNever), Error);
  EXPECT_THROW(allowed.allow(-1, 0, AllowedReason::kNever), Error);
  EXPECT_THROW(allowed.allow(1, 2, AllowedReason::kTested), Error);
  EXPECT_THROW(allowed.allow(1, 2, AllowedReason::kProvedNever), Error);
}

// Bits beyond the first word, and no pair is another's.
TEST(AllowedCollisions, BitsEqualNames) {
  Random random(61);
  RobotModel robot("link_0");
  std::set<std::pair<int, int>> expected;
  for (int i = 1; i < 40; ++i) {
    const std::string link = "link_" + std::to_string(i);
    const int parent = random.whole(0, i - 1);
    robot.add_link(link, "link_" + std::to_string(parent), turning(-1.0, 1.0));
    robot.attach(link, one_sphere_tree({0, 0, 0}, 0.1));
    expected.emplace(parent, i);
  }
  AllowedCollisions allowed(robot);
  // Siblings below the first link, which has no spheres, are two joints apart.
  for (int n = 0; n < 600; ++n) {
    const auto [i, k] = std::minmax({random.whole(0, 39), random.whole(0, 39)});
    if (i == k) continue;
    const std::string first = "link_" + std::to_string(i);
    const std::string second = "link_" + std::to_string(k);
    if (random.coin()) {
      allowed.allow(first, second);
      expected.emplace(i, k);
    } else {
      allowed.forbid(second, first);
      expected.erase({i, k});
    }
  }
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < 40; ++k) {
      EXPECT_EQ(allowed.allows(i, k), i == k || expected.contains(std::minmax(i, k)))
          << i << ' ' << k;
    }
  }
}

// A finger that reaches the plate in some configurations; a chin that always touches the plate.
TEST(AllowedCollisions, Sampled) {
  RobotModel robot = arm();
  robot.add_link("long", "finger", sliding(0.0, 1.0));
  robot.attach("long", one_sphere_tree({0, 0, 0}, 0.05));
  robot.add_link("far", "a", {.type = JointType::kPrismatic, .lower = 5.0, .upper = 6.0});
  robot.attach("far", one_sphere_tree({0, 0, 0}, 0.05));
  AllowedCollisions allowed(robot);
  const SampledCollisions sampled =
      sample_collisions(robot, allowed, {.configurations = 500, .seed = 7});
  EXPECT_EQ(sampled.configurations, 500U);
  std::map<std::pair<std::string, std::string>, SampledPair> by_name;
  const auto& links = robot.links();
  for (const SampledPair& pair : sampled.pairs) {
    EXPECT_FALSE(allowed.allows(pair.first, pair.second));
    by_name[{links[static_cast<std::size_t>(pair.first)].name,
             links[static_cast<std::size_t>(pair.second)].name}] = pair;
  }
  EXPECT_EQ((by_name[{"plate", "a"}].reason), AllowedReason::kAlways);
  EXPECT_EQ((by_name[{"plate", "a"}].touched), 500U);
  EXPECT_EQ((by_name[{"plate", "far"}].reason), AllowedReason::kNever);
  const SampledPair& sometimes = by_name[{"plate", "long"}];
  EXPECT_EQ(sometimes.reason, AllowedReason::kTested);
  EXPECT_NEAR(static_cast<double>(sometimes.touched) / 500.0, 0.15, 0.06);
  EXPECT_EQ(by_name.count({"plate", "flange"}), 0U) << "there are no spheres on it";

  allow_sampled(sampled, allowed);
  EXPECT_EQ(allowed.reason(robot.find_link("plate"), robot.find_link("a")), AllowedReason::kAlways);
  EXPECT_EQ(allowed.reason(robot.find_link("plate"), robot.find_link("far")),
            AllowedReason::kNever);
  EXPECT_FALSE(allowed.allows("plate", "long"));
  EXPECT_NE(name_of(AllowedReason::kNever).find("sample"), std::string_view::npos);

  const SampledCollisions again =
      sample_collisions(robot, AllowedCollisions(robot), {.configurations = 500, .seed = 7});
  ASSERT_EQ(again.pairs.size(), sampled.pairs.size());
  for (std::size_t i = 0; i < again.pairs.size(); ++i) {
    EXPECT_EQ(again.pairs[i].touched, sampled.pairs[i].touched);
  }
  EXPECT_THROW((void)sample_collisions(robot, allowed, {.configurations = 0}), Error);
}

}  // namespace
}  // namespace spherule::test

// Disabled pairs of an SRDF, judged on a robot whose links are known to touch or not.

namespace spherule::test::srdf_judgement_test {
namespace {

// On a rail: a block, a cart beside it that reaches it at 0.2, a lid fixed to the cart, a bare
// link, and a shelf out of reach of both, on a rail of its own.
BoxRobot rail(double upper = 1.0) {
  BoxRobot robot{RobotModel("block")};
  robot.model.add_link("bare", "block", sliding(0.0, upper, "lift"));
  robot.model.add_link("cart", "bare", sliding(0.1, upper, "drive"));
  robot.model.add_link("lid", "cart", {.name = "fixed"});
  Joint pull = sliding(0.0, upper, "pull");
  pull.parent_from_joint = Pose::from_translation({0, 2, 0});
  robot.model.add_link("shelf", "block", pull);
  for (const char* const link : {"block", "cart", "lid", "shelf"}) {
    robot.add_boxes(robot.model.find_link(link), {cube_at({0, 0, 0})});
  }
  return robot;
}

TEST(AllowedBySrdf, DefaultsThenWhatIsEnabledThenWhatIsDisabled) {
  RobotModel robot("base");
  robot.add_link("mount", "base", {.name = "fix"});
  robot.add_link("arm", "base", turning(-1, 1));
  Joint wrist = turning(-1, 1);
  wrist.name = "wrist";
  robot.add_link("hand", "arm", wrist);
  AllowedCollisions allowed(robot);
  EXPECT_FALSE(allowed.allows("mount", "hand"));
  SemanticDescription semantics;
  semantics.links_disabled_by_default = {"mount", "nobody"};
  semantics.enabled_pairs = {
      {"arm", "mount"}, {"arm", "base"}, {"nobody", "arm"}, {"base", "mount"}};
  semantics.disabled_pairs = {{"mount", "base", "Adjacent"}, {"nobody", "arm", "Never"}};
  allowed.apply(semantics);
  EXPECT_EQ(allowed.reason(1, 3), AllowedReason::kGiven);
  EXPECT_FALSE(allowed.allows("mount", "arm")) << "enabled";
  EXPECT_FALSE(allowed.allows("base", "arm")) << "enabled, though neighbours";
  EXPECT_TRUE(allowed.allows("base", "mount")) << "disabled as well";
  EXPECT_FALSE(allowed.allows("base", "hand"));
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

// Of links with bodies alone; that the pairs touch is somebody's decision.
TEST_F(SrdfJudged, DefaultsOfLinksAreDecisions) {
  SemanticDescription semantics;
  semantics.links_disabled_by_default = {"lid", "bare"};
  semantics.enabled_pairs = {{"shelf", "lid"}};
  const SrdfJudgement judged = judge_srdf(robot_.model, semantics, proofs_);
  ASSERT_EQ(judged.pairs.size(), 2U);
  EXPECT_EQ(judged.pairs[0].pair.link_b, "block");
  EXPECT_EQ(judged.pairs[0].verdict, DisabledVerdict::kTouches);
  EXPECT_FALSE(judged.pairs[0].is_wrong);
  EXPECT_EQ(judged.pairs[1].pair.link_b, "cart");
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
  robot.model.add_link("arm", "base", turning(-1, 1));
  for (const int link : {0, 1}) robot.add_boxes(link, {cube_at({0, 0, 0})});
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
