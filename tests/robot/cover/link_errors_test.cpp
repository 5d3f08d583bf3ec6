// SPDX-License-Identifier: BSD-3-Clause
#include "robot/cover/link_errors.h"

#include "base/error.h"
#include "robot/cover/false_alarms.h"
#include "robot/cover/goal_cover.h"
#include "robot/model/robot_model.h"
#include "spheretree/sphere_tree.h"
#include "tests/robot/box_robots.h"
#include "tests/robot/robots.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace spherule::test::link_errors_test {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

// Cells no sphere of which protrudes by more than the error.
std::shared_ptr<const SphereTree> cover_box(const AlignedBox3d& box, double max_error) {
  const double side = 2.0 * max_error / std::sqrt(3.0);
  const Eigen::Vector3i count = (box.sizes() / side).array().ceil().max(1.0).matrix().cast<int>();
  const Vector3d cell = box.sizes().cwiseQuotient(count.cast<double>());
  std::vector<Sphere> spheres;
  for (int x = 0; x < count.x(); ++x) {
    for (int y = 0; y < count.y(); ++y) {
      for (int z = 0; z < count.z(); ++z) {
        const Vector3d place = Vector3d(x, y, z) + Vector3d::Constant(0.5);
        spheres.push_back({box.min() + cell.cwiseProduct(place), 0.5 * cell.norm() + 1e-9});
      }
    }
  }
  return std::make_shared<const SphereTree>(build_tree(spheres));
}

// A post, a bar that turns beside it, and at its end a hand that slides along the post. The bar and
// the hand pass the post; a mast, far from everything, does not matter.
class ThreeLinks : public testing::Test {
 protected:
  ThreeLinks() {
    const auto add = [&](const char* name, const char* parent, Joint joint, const Vector3d& low,
                         const Vector3d& high) {
      const int link = robot_.model.add_link(name, parent, std::move(joint));
      robot_.add_boxes(link, {AlignedBox3d(low, high)});
    };
    robot_.add_boxes(0, {AlignedBox3d(Vector3d(0.9, -0.1, -0.5), Vector3d(1.1, 0.1, 0.5))});
    add("bar", "post", turning(-0.6, 0.6), {0.0, -0.05, -0.05}, {0.6, 0.05, 0.05});
    add("hand", "bar", sliding(0.0, 0.5), {0.3, -0.1, -0.1}, {0.5, 0.1, 0.1});
    Joint mast = turning(-1.0, 1.0);
    mast.parent_from_joint = Pose::from_translation({-5.0, 0.0, 0.0});
    add("mast", "post", mast, {-0.1, -0.1, 0.0}, {0.1, 0.1, 1.0});
    allowed_ = std::make_unique<AllowedCollisions>(with_errors({0.1, 0.1, 0.1, 0.1}));
    cover_ = [this](std::span<const LinkError> errors) { return cover(errors, 1.0); };
  }

  std::vector<std::shared_ptr<const SphereTree>> cover(std::span<const LinkError> errors,
                                                       double factor) const {
    std::vector<std::shared_ptr<const SphereTree>> result;
    for (const LinkError& error : errors) {
      result.push_back(cover_box(robot_.boxes[static_cast<std::size_t>(error.link)][0],
                                 factor * error.max_error));
    }
    return result;
  }

  std::size_t spheres_of(int link, double max_error) const {
    return cover_box(robot_.boxes[static_cast<std::size_t>(link)][0], max_error)->spheres().size();
  }

  RobotModel with_errors(const std::vector<double>& errors) const {
    RobotModel model = robot_.model;
    for (std::size_t link = 0; link < errors.size(); ++link) {
      model.attach(model.links()[link].name, cover_box(robot_.boxes[link][0], errors[link]));
    }
    return model;
  }

  FalseAlarms measure(const std::vector<double>& errors, const FalseAlarmOptions& options) const {
    return measure_false_alarms(with_errors(errors), robot_.bodies, *allowed_, nullptr, options);
  }

  LinkErrorChoice choose(const LinkErrorOptions& options, const CoverLinks& last = {}) const {
    return choose_link_errors(robot_.model, robot_.bodies, *allowed_, nullptr, cover_, last,
                              options);
  }

  static LinkErrorOptions options(double goal) {
    return {.goal = goal,
            .coarsest_error = 0.2,
            .finest_error = 0.0125,
            .sample = {.postures = 4000, .seed = 3}};
  }

  static std::vector<double> errors_of(const LinkErrorChoice& choice) {
    std::vector<double> result;
    for (const ChosenError& link : choice.links) result.push_back(link.max_error);
    return result;
  }

  BoxRobot robot_{RobotModel("post")};
  std::unique_ptr<AllowedCollisions> allowed_;
  CoverLinks cover_;
};

TEST_F(ThreeLinks, ReachesTheGoalWithFewerSpheresThanOneErrorForAll) {
  const double goal = 0.05;
  const LinkErrorChoice choice = choose(options(goal));
  ASSERT_TRUE(choice.is_reached);
  EXPECT_LE(choice.upper_bound, goal);
  ASSERT_EQ(choice.links.size(), 4U);
  EXPECT_EQ(choice.links[3].max_error, 0.2);  // the mast does not matter
  EXPECT_LT(choice.links[0].max_error, 0.1);
  std::size_t spheres = 0;
  for (const ChosenError& link : choice.links) {
    EXPECT_EQ(link.spheres, spheres_of(link.link, link.max_error));
    spheres += link.spheres;
  }
  EXPECT_EQ(choice.spheres, spheres);
  EXPECT_EQ(choice.verified.postures, LinkErrorChoice::kVerification * 4000);
  const FalseAlarms coarsest = measure({0.2, 0.2, 0.2, 0.2}, {.postures = 4000, .seed = 3});
  EXPECT_EQ(choice.coarsest.refused, coarsest.refused);
  EXPECT_EQ(choice.coarsest.free, coarsest.free);
  EXPECT_LT(choice.coarsest_spheres, choice.spheres);

  // Postures that nothing was chosen or verified by.
  const FalseAlarms fresh = measure(errors_of(choice), {.postures = 20000, .seed = 99});
  EXPECT_LE(fresh.refused_share().share(), goal);
  EXPECT_GT(fresh.refused_share().share(), 0.5 * goal);

  // The coarsest E for all that does as well as what is promised.
  std::size_t uniform = 0;
  for (double error = 0.2; uniform == 0; error *= 0.93) {
    ASSERT_GT(error, 0.01);
    const std::vector<double> errors(4, error);
    if (measure(errors, {.postures = 20000, .seed = 99}).refused_share().share() > 0.95 * goal)
      continue;
    for (int link = 0; link < 4; ++link) uniform += spheres_of(link, error);
  }
  EXPECT_LT(choice.spheres, uniform);
}

TEST_F(ThreeLinks, CoarsestCoversDoForAWeakGoal) {
  const LinkErrorChoice choice = choose(options(0.9));
  EXPECT_TRUE(choice.is_reached);
  EXPECT_EQ(errors_of(choice), std::vector<double>(4, 0.2));
  EXPECT_EQ(choice.covers, 4U);
  EXPECT_EQ(choice.spheres, choice.coarsest_spheres);
  // Verified by the postures of the seeds that follow that of the search, 3.
  std::size_t free = 0;
  std::size_t refused = 0;
  for (std::uint64_t seed = 4; seed < 4 + LinkErrorChoice::kVerification; ++seed) {
    const FalseAlarms part = measure({0.2, 0.2, 0.2, 0.2}, {.postures = 4000, .seed = seed});
    free += part.free;
    refused += part.refused_share().refused;
  }
  EXPECT_EQ(choice.verified.free, free);
  EXPECT_EQ(choice.verified.refused_share().refused, refused);
}

TEST_F(ThreeLinks, SaysThatAGoalIsOutOfReach) {
  LinkErrorOptions hard = options(0.001);
  hard.finest_error = 0.1;
  const LinkErrorChoice choice = choose(hard);
  EXPECT_FALSE(choice.is_reached);
  EXPECT_GT(choice.upper_bound, 0.001);
  EXPECT_NEAR(choice.links[0].max_error, 0.1, 1e-12);
  EXPECT_FALSE(choice.verified.pairs.empty());
}

TEST_F(ThreeLinks, GivenPosturesCountToo) {
  LinkErrorOptions with_given = options(0.5);
  // The hand at full reach beside the post: some millimetres to 0.2 m apart.
  for (int i = 0; i < 50; ++i) {
    with_given.given.insert(with_given.given.end(), {0.235 + 0.004 * i, 0.5, 0.0});
  }
  const FalseAlarms before = measure_false_alarms(with_errors({0.2, 0.2, 0.2, 0.2}), robot_.bodies,
                                                  *allowed_, nullptr, with_given.given);
  ASSERT_GT(before.refused_share().share(), 0.5);
  const LinkErrorChoice choice = choose(with_given);
  EXPECT_TRUE(choice.is_reached);
  EXPECT_LE(choice.given.refused_share().share(), 0.5);
  EXPECT_EQ(choice.given.free, before.free);
  EXPECT_GT(choice.spheres, choice.coarsest_spheres);
}

TEST_F(ThreeLinks, FixedLinksKeepTheirError) {
  LinkErrorOptions fixed = options(0.05);
  fixed.fixed = {{.link = 0, .max_error = 0.017}};
  const LinkErrorChoice choice = choose(fixed);
  EXPECT_EQ(choice.links[0].max_error, 0.017);
  EXPECT_TRUE(choice.is_reached);
}

TEST_F(ThreeLinks, ThreadsChangeNothing) {
  LinkErrorOptions one = options(0.05);
  one.sample.threads = 1;
  LinkErrorOptions three = one;
  three.sample.threads = 3;
  const LinkErrorChoice a = choose(one);
  const LinkErrorChoice b = choose(three);
  EXPECT_EQ(errors_of(a), errors_of(b));
  EXPECT_EQ(a.verified.refused, b.verified.refused);
  EXPECT_EQ(a.upper_bound, b.upper_bound);
}

// What is promised is promised of the covers that are handed out.
TEST_F(ThreeLinks, FinalCoversAreVerified) {
  const CoverLinks worse = [this](std::span<const LinkError> errors) { return cover(errors, 1.1); };
  const LinkErrorChoice choice = choose(options(0.05), worse);
  std::vector<double> errors = errors_of(choice);
  for (std::size_t link = 0; link < 4; ++link) {
    errors[link] *= 1.1;
    EXPECT_EQ(choice.links[link].spheres, spheres_of(static_cast<int>(link), errors[link]));
  }
  const FalseAlarms fresh = measure(errors, {.postures = 20000, .seed = 99});
  EXPECT_NEAR(choice.verified.refused_share().share(), fresh.refused_share().share(), 0.005);
  EXPECT_EQ(choice.is_reached, choice.upper_bound <= 0.05);
  EXPECT_TRUE(choice.is_reached);
}

TEST_F(ThreeLinks, RefusesBadOptions) {
  for (const double goal : {0.0, 1.0, -0.1, std::nan("")}) {
    EXPECT_THROW(choose({.goal = goal}), Error);
  }
  EXPECT_THROW(choose({.coarsest_error = 0.1, .finest_error = 0.2}), Error);
  EXPECT_THROW(choose({.finest_error = 0.0}), Error);
  EXPECT_THROW(choose({.sample = {.postures = 0}}), Error);
  EXPECT_THROW(choose({.fixed = {{.link = 4, .max_error = 0.1}}}), Error);
  LinkErrorOptions broken = options(0.05);
  broken.given = {1.0};
  EXPECT_THROW(choose(broken), Error);
}

}  // namespace
}  // namespace spherule::test::link_errors_test

namespace spherule::test::goal_cover_test {
namespace {

// Two blocks that slide towards each other on two rails, 0.02 m apart at least.
RobotDescription two_blocks() {
  RobotDescription robot{.name = "rails", .model = RobotModel("left"), .links = {}};
  Joint slide = sliding(0.0, 0.2);
  slide.parent_from_joint = Pose::from_translation({0.22, 0, 0});
  robot.model.add_link("rail", "left", slide);
  robot.model.add_link("right", "rail", sliding(0.0, 0.2));
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
                  const std::vector<DisabledPair>& disabled = {}) const {
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
  const GoalCover result = cover(options, 0.1, {{"left", "right", ""}});
  EXPECT_TRUE(result.choice.is_reached);
  EXPECT_EQ(result.choice.verified.refused[0], 0U);
  EXPECT_EQ(result.choice.links[0].max_error, 0.05);
  EXPECT_EQ(result.choice.links[1].max_error, 0.1);
  EXPECT_THROW(cover(options, 0.1, {{"left", "nobody", ""}}), Error);
}

}  // namespace
}  // namespace spherule::test::goal_cover_test
