// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/goal_cover.h"

#include "base/error.h"
#include "robot/model/link_spheres.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace spherule::test::goal_cover_test {
namespace {

// Two blocks that slide towards each other on two rails, 0.02 m apart at least.
RobotDescription two_blocks() {
  RobotDescription robot{.name = "rails", .model = RobotModel("left"), .links = {}};
  Joint slide{.name = "slide", .type = JointType::kPrismatic, .lower = 0.0, .upper = 0.2};
  slide.axis = Eigen::Vector3d::UnitX();
  slide.parent_from_joint = Pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.22, 0, 0));
  robot.model.add_link("rail", "left", slide);
  slide.name = "slide_2";
  slide.parent_from_joint = Pose();
  robot.model.add_link("right", "rail", slide);
  for (const char* name : {"left", "rail", "right"}) robot.links.push_back({.name = name});
  for (const std::size_t link : {0U, 2U}) {
    robot.links[link].collision.push_back(
        {.name = {}, .geometry = Primitive(Box{Eigen::Vector3d::Constant(0.2)})});
  }
  return robot;
}

TEST(CoveredBodies, AreGrownByTheirOwnPadding) {
  RobotCoverOptions options{.padding = 0.01};
  options.links["right"].padding = 0.02;
  const std::vector<LinkBody> bodies = covered_bodies(two_blocks(), options);
  ASSERT_EQ(bodies.size(), 2U);
  EXPECT_EQ(bodies[0].link, 0);
  EXPECT_EQ(bodies[1].link, 2);
  EXPECT_NEAR(bodies[0].mesh->inflation(), 0.01, 1e-9);
  EXPECT_NEAR(bodies[1].mesh->inflation(), 0.02, 1e-9);
  options.geometry = LinkGeometry::kVisual;
  EXPECT_TRUE(covered_bodies(two_blocks(), options).empty());
}

class GoalOfBlocks : public testing::Test {
 protected:
  GoalCover cover(const RobotCoverOptions& options, double goal,
                  const std::vector<std::pair<std::string, std::string>>& disabled = {}) const {
    return cover_robot_to_goal(
        robot_, covered_bodies(robot_, options), disabled, nullptr, options,
        {.goal = goal, .coarsest_error = 0.1, .finest_error = 0.02, .sample = {.postures = 4000}});
  }
  const RobotDescription robot_ = two_blocks();
};

TEST_F(GoalOfBlocks, HandsOutTheCoversThatWereVerified) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  const GoalCover result = cover({.effort = 1}, 0.2);
  EXPECT_TRUE(result.choice.is_reached);
  EXPECT_GT(result.choice.coarsest.refused_share().share(), 0.2);
  ASSERT_EQ(result.cover.links.size(), 3U);
  EXPECT_TRUE(links_not_proved(result.cover).empty());
  EXPECT_TRUE(result.cover.links[1].spheres.empty());
  for (const ChosenError& chosen : result.choice.links) {
    const LinkCover& link = result.cover.links[static_cast<std::size_t>(chosen.link)];
    EXPECT_EQ(link.spheres.size(), chosen.spheres);
    ASSERT_TRUE(link.fit);
    EXPECT_EQ(link.fit->options.max_error, chosen.max_error);
    EXPECT_EQ(link.fit->options.effort, 1);
  }
  const RobotModel model = with_spheres(robot_.model, robot_spheres(robot_, result.cover).links);
  EXPECT_EQ(model.links()[0].trees.size(), 1U);
  EXPECT_TRUE(model.links()[1].trees.empty());
  const FalseAlarms fresh =
      measure_false_alarms(model, covered_bodies(robot_, {}), AllowedCollisions(model), nullptr,
                           {.postures = 20000, .seed = 77});
  EXPECT_LE(fresh.refused_share().share(), 0.2);
}

TEST_F(GoalOfBlocks, DisabledPairsAndFixedLinksCount) {
  RobotCoverOptions options{.effort = 0};
  options.links["left"].max_error = 0.05;
  const GoalCover result = cover(options, 0.1, {{"left", "right"}});
  EXPECT_TRUE(result.choice.is_reached);
  EXPECT_EQ(result.choice.verified.refused[0], 0U);
  EXPECT_EQ(result.choice.links[0].max_error, 0.05);
  EXPECT_EQ(result.choice.links[1].max_error, 0.1);
  EXPECT_THROW(cover(options, 0.1, {{"left", "nobody"}}), Error);
}

}  // namespace
}  // namespace spherule::test::goal_cover_test
