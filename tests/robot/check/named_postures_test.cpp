// SPDX-License-Identifier: BSD-3-Clause
// Postures of a robot by name, what touches in them, and lists of ignored pairs.

#include "robot/check/scene_setup.h"
#include "robot/pairs/allowed_collisions.h"
#include "spheretree/build.h"
#include "tests/robot/box_robots.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace spherule::test::named_postures_test {
namespace {

// A block that slides towards another one on the x axis: they touch where the slide is below 0.2.
BoxRobot slide(double lower) {
  BoxRobot robot{RobotModel("block")};
  robot.model.add_link("slider", "block",
                       {.name = "slide",
                        .type = JointType::kPrismatic,
                        .axis = Eigen::Vector3d::UnitX(),
                        .lower = lower,
                        .upper = 1.0});
  for (const int link : {0, 1}) {
    robot.add_boxes(link, {{Eigen::Vector3d::Constant(-0.1), Eigen::Vector3d::Constant(0.1)}});
    const std::vector<Sphere> sphere = {{Eigen::Vector3d::Zero(), 0.18}};
    robot.model.attach(robot.model.links()[static_cast<std::size_t>(link)].name,
                       std::make_shared<const SphereTree>(build_tree(sphere)));
  }
  return robot;
}

TEST(NamedPostures, ZeroIsTheNearestLimitWhereItIsBeyond) {
  EXPECT_EQ(zero_posture(slide(-1.0).model).configuration, std::vector<double>{0.0});
  EXPECT_EQ(zero_posture(slide(0.3).model).configuration, std::vector<double>{0.3});
}

TEST(NamedPostures, RestIsAtZeroOrInTheMiddleWhereThatIsCloseToALimit) {
  EXPECT_EQ(rest_posture(slide(-1.0).model).configuration, std::vector<double>{0.0});
  EXPECT_EQ(rest_posture(slide(-0.12).model).configuration, std::vector<double>{0.0});
  EXPECT_EQ(rest_posture(slide(-0.1).model).configuration, std::vector<double>{0.45});
  EXPECT_EQ(rest_posture(slide(0.3).model).configuration, std::vector<double>{0.65});
}

TEST(NamedPostures, StatesOfGroupsPassOverWhatIsNotThere) {
  SemanticDescription semantics;
  semantics.group_states = {
      {"home", "arm", {{"slide", {0.5}}, {"nobody", {7.0}}}},
      {"odd", "arm", {{"slide", {0.5, 0.6}}}},
  };
  const std::vector<NamedPosture> postures = group_postures(slide(-1.0).model, semantics);
  ASSERT_EQ(postures.size(), 2U);
  EXPECT_EQ(postures[0].name, "arm/home");
  EXPECT_EQ(postures[0].configuration, std::vector<double>{0.5});
  EXPECT_EQ(postures[1].configuration, std::vector<double>{0.0});
}

TEST(NamedPostures, ContactsTellSpheresFromMeshes) {
  const BoxRobot robot = slide(-0.5);
  AllowedCollisions allowed(robot.model);
  allowed.forbid("block", "slider");
  const std::vector<NamedPosture> postures = {{"in", {0.1}}, {"near", {0.3}}, {"far", {0.5}}};
  const auto plain = contacts_in(postures, robot.model, robot.bodies, allowed, nullptr);
  ASSERT_EQ(plain.size(), 2U);
  EXPECT_EQ(plain[0].posture, "in");
  EXPECT_TRUE(plain[0].do_meshes_touch);
  EXPECT_NEAR(plain[0].overlap_depth, 0.26, 1e-6);
  EXPECT_EQ(plain[1].posture, "near");
  EXPECT_FALSE(plain[1].do_meshes_touch);
  EXPECT_FALSE(plain[1].is_proved_free);
  const auto pairs = std::make_shared<const LinkPairs>(prove_link_pairs(robot.model, robot.bodies));
  const auto proved = contacts_in(postures, robot.model, robot.bodies, allowed, pairs);
  ASSERT_EQ(proved.size(), 2U);
  EXPECT_TRUE(proved[0].do_meshes_touch);
  EXPECT_FALSE(proved[0].is_proved_free);
  EXPECT_TRUE(proved[1].is_proved_free);
}

TEST(IgnoredPairs, AreAddedOnceInEitherOrder) {
  const RobotModel robot = slide(0.3).model;
  std::vector<DisabledPair> known = {{"slider", "block", "User"}};
  const std::vector<DisabledPair> more = {{"block", "slider", "Never"}, {"block", "nobody", ""}};
  add_missing_pairs(more, robot, known);
  ASSERT_EQ(known.size(), 1U);
  EXPECT_EQ(known[0].reason, "User");
  known.clear();
  add_missing_pairs(more, robot, known);
  ASSERT_EQ(known.size(), 1U);
  EXPECT_EQ(known[0].reason, "Never");
}

TEST(IgnoredPairs, AreThoseProvedNeverToTouch) {
  const auto never = [](double lower) {
    const BoxRobot robot = slide(lower);
    return pairs_proved_never(robot.model, prove_link_pairs(robot.model, robot.bodies));
  };
  EXPECT_TRUE(never(0.1).empty());
  const std::vector<DisabledPair> found = never(0.3);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].link_a, "block");
  EXPECT_EQ(found[0].link_b, "slider");
  EXPECT_EQ(found[0].reason, kProvedNeverReason);
}

}  // namespace
}  // namespace spherule::test::named_postures_test
