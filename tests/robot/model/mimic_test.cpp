// SPDX-License-Identifier: BSD-3-Clause
// Joints that follow others: the model, and every check of a robot, by the exact queries under the
// poses of forward_kinematics().

#include "base/error.h"
#include "robot/model/kinematics.h"
#include "spheretree/build.h"
#include "tests/robot/check/checked_scene.h"
#include "tests/robot/robots.h"
#include "tests/support/counting_new.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

// Joints a, b, c, d that turn one behind the other, and f that is fixed.
RobotModel chain() {
  RobotModel robot("0");
  robot.add_link("1", "0", {.name = "a", .type = JointType::kRevolute});
  robot.add_link("2", "1", {.name = "b", .type = JointType::kContinuous});
  robot.add_link("3", "2", {.name = "f"});
  robot.add_link("4", "3", {.name = "c", .type = JointType::kPrismatic});
  robot.add_link("5", "4", {.name = "d", .type = JointType::kRevolute});
  return robot;
}

TEST(Mimic, ChainsAreMultipliedOutInAnyOrder) {
  RobotModel robot = chain();
  EXPECT_FALSE(robot.has_mimics());
  EXPECT_EQ(robot.variable_joints(), (std::vector<int>{0, 1, 3, 4}));
  robot.mimic("a", "c", 2.0, 1.0);
  EXPECT_EQ(robot.variable_joints(), (std::vector<int>{1, 3, 4}));
  robot.mimic("c", "d", -3.0, 5.0);
  EXPECT_TRUE(robot.has_mimics());
  EXPECT_EQ(robot.variable_joints(), (std::vector<int>{1, 4}));
  const Joint& a = robot.joints()[0];
  EXPECT_EQ(a.mimics, 3);
  EXPECT_EQ(a.variable, 1);
  EXPECT_EQ(a.multiplier, -6.0);
  EXPECT_EQ(a.offset, 11.0);
  const std::vector<double> configuration = {0.25, 2.0};
  EXPECT_EQ(a.position(configuration), -1.0);
  EXPECT_EQ(robot.joints()[1].position(configuration), 0.25);
  EXPECT_EQ(robot.joints()[2].position(configuration), 0.0);
  EXPECT_EQ(robot.joints()[3].position(configuration), -1.0);
  EXPECT_EQ(robot.joints()[4].position(configuration), 2.0);
  robot.add_link("6", "0", {.name = "e", .type = JointType::kRevolute});
  EXPECT_EQ(robot.variable_joints(), (std::vector<int>{1, 4, 5}));
  EXPECT_EQ(robot.joints()[0].multiplier, -6.0);
}

TEST(Mimic, RefusesWhatIsNoMimic) {
  RobotModel robot = chain();
  robot.mimic("a", "b");
  robot.mimic("b", "c");
  EXPECT_THROW(robot.mimic("c", "a"), Error) << "a cycle";
  EXPECT_THROW(robot.mimic("d", "d"), Error);
  EXPECT_THROW(robot.mimic("a", "c"), Error) << "twice";
  EXPECT_THROW(robot.mimic("x", "c"), Error);
  EXPECT_THROW(robot.mimic("d", "x"), Error);
  EXPECT_THROW(robot.mimic("d", ""), Error);
  EXPECT_THROW(robot.mimic("f", "c"), Error) << "it is fixed";
  EXPECT_THROW(robot.mimic("d", "f"), Error);
  EXPECT_THROW(robot.mimic("d", "c", std::nan("")), Error);
  EXPECT_THROW(robot.mimic("d", "c", 1.0, std::numeric_limits<double>::infinity()), Error);
  robot.mimic("d", "a", 1e200);
  EXPECT_THROW(robot.mimic("c", "x"), Error);
  RobotModel large = chain();
  large.mimic("a", "b", 1e200);
  EXPECT_THROW(large.mimic("b", "c", 1e200), Error) << "an infinite factor";
  EXPECT_EQ(large.variable_count(), 3) << "what is refused changes nothing";
  EXPECT_EQ(large.joints()[0].multiplier, 1e200);
}

RobotModel random_follower(Random& random, double size) {
  RobotModel robot = random_robot_with_trees(random, size);
  add_random_mimics(random, robot, 3.0);
  return robot;
}

// In time that grows with the square of their length, whichever joint is told first.
TEST(Mimic, ChainsMayBeLong) {
  constexpr int kJoints = 1500;
  const auto name = [](int i) { return "j" + std::to_string(i); };
  for (const bool is_leader_first : {true, false}) {
    RobotModel robot("0");
    for (int i = 0; i < kJoints; ++i) {
      robot.add_link(std::to_string(i + 1), std::to_string(i),
                     {.name = name(i), .type = JointType::kRevolute});
    }
    for (int i = 1; i < kJoints; ++i) {
      const int joint = is_leader_first ? i : kJoints - i;
      robot.mimic(name(joint), name(joint - 1), -1.0, 0.5);
    }
    EXPECT_EQ(robot.variable_count(), 1);
    EXPECT_EQ(robot.joints().back().multiplier, -1.0);
    EXPECT_EQ(robot.joints().back().offset, 0.5);
    EXPECT_EQ(robot.joints()[kJoints - 2].offset, 0.0);
  }
}

TEST(Mimic, ObstacleCheckerAnswersAsThePairsDo) {
  Random random(81);
  int hits = 0;
  int all = 0;
  for (int i = 0; i < effort(150, 15); ++i) {
    const RobotModel robot = random_follower(random, 0.3);
    const std::vector<PlacedTree> obstacles = random_obstacles(random);
    ObstacleOptions options{.world_from_root = i % 2 == 0 ? Pose() : random_root(random, 3.0)};
    const double clearance = random.between(0.0, 0.2);
    for (const InstructionSet set : instruction_sets()) {
      options.instructions = set;
      const ObstacleChecker checker(robot, obstacles, options);
      RobotChecker::Scratch scratch(checker);
      std::vector<double> configurations;
      std::vector<std::uint8_t> expected;
      Random steps(static_cast<std::uint64_t>(i));  // the same on every set
      std::vector<double> q = random_configuration(steps, robot, 3.0);
      for (int k = 0; k < 50; ++k) {
        // Along a path, then jumping, and some beyond the range of the fast check.
        const double step = k < 30 ? 0.02 : k < 45 ? 3.0 : 150.0;
        const std::vector<double> change = random_configuration(steps, robot, step);
        for (std::size_t n = 0; n < q.size(); ++n) q[n] += change[n];
        expected.push_back(answer(robot, obstacles, q, options) ? 1 : 0);
        configurations.insert(configurations.end(), q.begin(), q.end());
        ASSERT_EQ(checker.collides(q, scratch), expected.back() == 1);
        ASSERT_EQ(checker.explain(q, scratch).empty(), expected.back() == 0);
        ASSERT_TRUE(checker.within(q, clearance, scratch) || expected.back() == 0);
        ASSERT_EQ(checker.within(q, 0.0, scratch), expected.back() == 1);
        hits += expected.back();
        ++all;
      }
      std::vector<std::uint8_t> verdicts(expected.size());
      checker.collides(configurations, scratch, verdicts);
      ASSERT_EQ(verdicts, expected);
    }
  }
  EXPECT_GT(hits, all / effort(20, 40));
  EXPECT_LT(hits, all - all / 20);
}

TEST(Mimic, ConfigurationsAreSharedAmongThreads) {
  Random random(82);
  const RobotModel robot = random_follower(random, 0.3);
  const std::vector<PlacedTree> obstacles = random_obstacles(random);
  const ObstacleChecker checker(robot, obstacles);
  const std::size_t count = 4096 + 7;
  std::vector<double> configurations;
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<double> q = random_configuration(random, robot, 3.0);
    configurations.insert(configurations.end(), q.begin(), q.end());
  }
  std::vector<RobotChecker::Scratch> scratches;
  for (int i = 0; i < 3; ++i) scratches.emplace_back(checker);
  std::vector<std::uint8_t> alone(count);
  std::vector<std::uint8_t> shared(count);
  checker.collides(configurations, scratches.front(), alone);
  checker.collides(configurations, scratches, shared);
  EXPECT_EQ(alone, shared);
}

TEST(Mimic, MeshesAmongSpheresAreJudgedAsThePairsAre) {
  Random random(83);
  const auto mesh =
      covered_surface({{{0, 0, 0}, {0.6, 0, 0}, {0, 0.6, 0}, {0, 0, 0.6}}, {{0, 1, 2}, {0, 2, 3}}});
  int hits = 0;
  int all = 0;
  for (int i = 0; i < effort(100, 40); ++i) {
    const bool branching = random.whole(0, 1) == 1;
    RobotModel robot = random_robot(random, random.whole(1, 8), branching);
    for (const Link& link : std::vector<Link>(robot.links())) {
      robot.attach(link.name, cover_of(mesh));
    }
    add_random_mimics(random, robot, 3.0);
    const std::vector<PlacedTree> obstacles = random_obstacles(random);
    const ObstacleChecker checker(robot, obstacles, {.meshes = {mesh}});
    RobotChecker::Scratch scratch(checker);
    std::vector<Pose> poses;
    for (int k = 0; k < 20; ++k) {
      const std::vector<double> q = random_configuration(random, robot, k < 18 ? 3.0 : 200.0);
      forward_kinematics(robot, q, poses);
      const bool expected = std::any_of(poses.begin(), poses.end(), [&](const Pose& pose) {
        return std::any_of(obstacles.begin(), obstacles.end(), [&](const PlacedTree& o) {
          return collides(*o.tree, o.world_from_tree, mesh->mesh(), pose);
        });
      });
      ASSERT_EQ(checker.collides(q, scratch), expected);
      hits += expected ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GT(hits, all / 20);
  EXPECT_LT(hits, all - all / 20);
}

std::vector<double> between(const std::vector<double>& from, const std::vector<double>& to,
                            double t) {
  std::vector<double> at;
  for (std::size_t i = 0; i < from.size(); ++i) at.push_back((1.0 - t) * from[i] + t * to[i]);
  return at;
}

TEST(Mimic, EdgesThatAreProvedFreeAreFree) {
  Random random(84);
  int free = 0;
  int hits = 0;
  int unknown = 0;
  for (int i = 0; i < effort(400, 30); ++i) {
    const RobotModel robot = random_follower(random, 0.2);
    const ObstacleChecker checker(robot, random_obstacles(random));
    RobotChecker::Scratch scratch(checker);
    const double size = std::pow(10.0, random.between(-3.0, 1.0));
    const std::vector<double> from = random_configuration(random, robot, 3.0);
    std::vector<double> to = random_configuration(random, robot, size);
    for (std::size_t k = 0; k < to.size(); ++k) to[k] += from[k];
    const EdgeResult result =
        checker.check_edge(from, to, scratch, {.resolution = 1e-3, .first = i % 3 == 0});
    RobotChecker::Scratch other(checker);
    const auto collides_at = [&](double t) {
      return checker.collides(between(from, to, t), other);
    };
    const int steps = effort(1000, 200);
    for (int k = 0; k < steps && result.free_until > 0.0; ++k) {
      ASSERT_FALSE(collides_at(result.free_until * (static_cast<double>(k) / steps)));
    }
    ASSERT_FALSE(result.verdict == Verdict::kFree && collides_at(1.0));
    ASSERT_TRUE(result.verdict != Verdict::kCollision || collides_at(result.contact_at));
    (result.verdict == Verdict::kFree        ? free
     : result.verdict == Verdict::kCollision ? hits
                                             : unknown) += 1;
  }
  EXPECT_GT(free, effort(40, 3));
  EXPECT_GT(hits, effort(40, 1));
  EXPECT_LT(unknown, (free + hits) / 10);
}

// A base that carries a handle without spheres, and an arm of ten metres that turns with it at
// multiplier * handle + offset: a small obstacle stands where the arm gets on the way.
TEST(Mimic, FastFollowersDoNotPassThrough) {
  Random random(85);
  for (int i = 0; i < effort(300, 30); ++i) {
    const double angle = random.between(-3.0, 3.0);
    const Eigen::Vector3d center(10.0 * std::cos(angle), 10.0 * std::sin(angle), 0.0);
    // From nearly standing to many turns while the handle moves a little, with offsets that cancel.
    const double multiplier = std::pow(10.0, random.between(-1.0, 4.0));
    const double handle = random.between(-90.0, 90.0);
    const double offset = angle - multiplier * handle;
    RobotModel robot("base");
    robot.add_link("arm", "base", {.name = "arm", .type = JointType::kContinuous});
    robot.add_link("handle", "base",
                   {.name = "handle", .type = JointType::kPrismatic, .lower = -99, .upper = 99});
    robot.attach("arm", one_sphere_tree({10, 0, 0}, 1e-3));
    robot.mimic("arm", "handle", multiplier, offset);
    const double size = std::pow(10.0, random.between(-6.0, -2.0));
    const ObstacleChecker checker(robot, {{one_sphere_tree(center, size), Pose()}});
    RobotChecker::Scratch scratch(checker);
    const double reach = std::min(5.0, 30.0 / multiplier);
    const double before = random.between(0.01, 1.0) * reach;
    const double after = random.between(0.01, 1.0) * reach;
    const std::vector<double> from = {handle - before};
    const std::vector<double> to = {handle + after};
    const EdgeResult result = checker.check_edge(from, to, scratch, {.first = true});
    ASSERT_NE(result.verdict, Verdict::kFree);
    // The first of many turns.
    const double swept = multiplier * before;
    const double turn = 2.0 * std::numbers::pi;
    const double met = (swept - std::floor(swept / turn) * turn) / (multiplier * (before + after));
    const double near = (1e-3 + size + 1e-4) / (multiplier * (before + after)) + 1e-9;
    EXPECT_LE(result.free_until, met + near);
    EXPECT_GE(result.free_until, met - near);
  }
}

// In the middle of the motion the arm touches by so little that single precision is uncertain: for
// the configuration there, of which the arm's position comes first among the positions.
TEST(Mimic, DoubtsOnEdgesAreSettledWhereTheyAre) {
  Random random(88);
  for (int i = 0; i < effort(100, 20); ++i) {
    const double handle = random.between(-3.0, 3.0);
    const double multiplier = random.between(1.0, 3.0);
    const double angle = random.between(-3.0, 3.0);
    RobotModel robot("base");
    robot.add_link("arm", "base", {.name = "arm", .type = JointType::kContinuous});
    robot.add_link("handle", "base", {.name = "handle", .type = JointType::kPrismatic});
    robot.attach("arm", one_sphere_tree({10, 0, 0}, 1e-3));
    robot.mimic("arm", "handle", multiplier, angle - multiplier * handle);
    const Eigen::Vector3d center(10.0 * std::cos(angle), 10.0 * std::sin(angle), 3e-3 - 1e-9);
    const ObstacleChecker checker(robot, {{one_sphere_tree(center, 2e-3), Pose()}});
    RobotChecker::Scratch scratch(checker);
    const double before = random.between(0.01, 0.5);
    const EdgeResult result =
        checker.check_edge(std::vector<double>{handle - before},
                           std::vector<double>{handle + before}, scratch, {.resolution = 1e-2});
    ASSERT_EQ(result.verdict, Verdict::kCollision);
    ASSERT_EQ(result.contact_at, 0.5);
  }
}

// A sphere that two followers move along a line, with multipliers and offsets so large that the
// computed positions are up to a millimetre beside it, where obstacles stand.
TEST(Mimic, RoundingDoesNotHideContactsOnEdges) {
  Random random(87);
  int free = 0;
  int beside = 0;
  for (int i = 0; i < effort(200, 20); ++i) {
    const double gap = random.between(0.0, i % 2 == 0 ? 3e-3 : 0.2);
    RobotModel robot("base");
    robot.add_link("handle", "base", {.name = "handle", .type = JointType::kPrismatic});
    robot.add_link("x", "base",
                   {.name = "x", .type = JointType::kPrismatic, .axis = {1.0, 0.0, 0.0}});
    robot.add_link("y", "x", {.name = "y", .type = JointType::kPrismatic, .axis = {0.0, 1.0, 0.0}});
    robot.attach("y", one_sphere_tree({0, 0, 0}, 0.01));
    const double handle = random.between(9.0, 15.0);
    const double to_x = random.between(0.5e12, 1e12);
    const double to_y = random.between(-1e12, 1e12);
    robot.mimic("x", "handle", to_x, -to_x * handle);
    robot.mimic("y", "handle", to_y, -to_y * handle);
    const Eigen::Vector3d beside_line = Eigen::Vector3d(-to_y, to_x, 0.0).normalized();
    const ObstacleChecker checker(robot,
                                  {{one_sphere_tree(beside_line * (0.51 + gap), 0.5), Pose()}});
    RobotChecker::Scratch scratch(checker);
    const std::vector<double> from = {handle - 1e-12};
    const std::vector<double> to = {handle + 1e-12};
    const bool is_free =
        checker.check_edge(from, to, scratch, {.resolution = 1e-5}).verdict == Verdict::kFree;
    bool collides = false;
    for (double q = from[0]; q <= to[0]; q = std::nextafter(q, 100.0)) {
      collides = collides || checker.collides(std::vector<double>{q}, scratch);
    }
    ASSERT_FALSE(is_free && collides) << gap;
    free += is_free ? 1 : 0;
    beside += collides && gap > 3e-4 ? 1 : 0;
  }
  EXPECT_GT(beside, 0) << "contacts that the straight line is clear of, beyond single precision";
  EXPECT_GT(free, 0);
}

TEST(Mimic, PositionsBeyondTheRangeAreRefusedOnEdges) {
  RobotModel robot("base");
  robot.add_link("a", "base", {.name = "a", .type = JointType::kRevolute});
  robot.add_link("b", "a", {.name = "b", .type = JointType::kRevolute});
  robot.attach("b", one_sphere_tree({1, 0, 0}, 0.1));
  robot.mimic("b", "a", 10.0);
  const ObstacleChecker checker(robot, {{one_sphere_tree({9, 0, 0}, 0.1), Pose()}});
  RobotChecker::Scratch scratch(checker);
  const auto edge = [&](double to) {
    return checker.check_edge(std::vector<double>{0.0}, std::vector<double>{to}, scratch).verdict;
  };
  EXPECT_EQ(edge(9.9), Verdict::kFree);
  EXPECT_THROW(edge(10.1), Error);
  EXPECT_FALSE(checker.collides(std::vector<double>{90.0}, scratch));
  EXPECT_THROW(checker.collides(std::vector<double>{std::nan("")}, scratch), Error);
  EXPECT_THROW(checker.collides(std::vector<double>{1.0, 2.0}, scratch), Error);
}

TEST(Mimic, AQueryTakesNoMemory) {
  Random random(86);
  RobotModel robot = chain();
  robot.mimic("a", "c", 0.5, 0.25);
  robot.mimic("d", "b", -2.0);
  for (const char* link : {"1", "3", "5"}) robot.attach(link, random_tree(random, 0.4));
  const ObstacleChecker checker(robot, random_obstacles(random));
  RobotChecker::Scratch scratch(checker);
  const auto variables = static_cast<std::size_t>(robot.variable_count());
  std::vector<double> many;
  for (int i = 0; i < 100; ++i) {
    const std::vector<double> q = random_configuration(random, robot, 3.0);
    many.insert(many.end(), q.begin(), q.end());
  }
  std::vector<std::uint8_t> verdicts(100);
  int before = 0;
  for (int round = 0; round < 2; ++round) {
    if (round == 1) before = allocations;
    checker.collides(many, scratch, verdicts);
    for (std::size_t i = 0; i < 99; ++i) {
      const std::span<const double> q = std::span(many).subspan(i * variables, variables);
      const std::span<const double> next = std::span(many).subspan((i + 1) * variables, variables);
      checker.collides(q, scratch);
      checker.within(q, 0.1, scratch);
      checker.check_edge(q, next, scratch);
    }
  }
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace spherule::test
