// SPDX-License-Identifier: BSD-3-Clause
// RobotChecker against every pair of spheres in extended precision.

#include "robot/check/robot_checker.h"

#include "robot/model/kinematics.h"
#include "tests/robot/check/checked.h"
#include "tests/robot/check/checked_scene.h"
#include "tests/robot/check/scene_oracle.h"
#include "tests/robot/robots.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace spherule::test {
namespace {

// What the canonical tests may call touching: a bound of their slack in these scenes.
constexpr long double kSlack = 1e-12L;

TEST(RobotChecker, AnswersAsAllPairsOfSpheresDo) {
  Random random(seeded(71));
  int hits = 0;
  int free = 0;
  int self_hits = 0;
  for (int n = 0; n < scaled(150, 30); ++n) {
    const auto [scene, oracle] = random_scene(random);
    Checked checked(scene);
    for (int i = 0; i < 4; ++i) {
      const std::vector<double> q = random_configuration(random, oracle.robot, 3.0);
      std::size_t nearest = 0;
      const auto gap = oracle.gap(q, &nearest);
      const bool is_free = checked.free(q);
      if (gap && *gap <= 0.0L) {
        EXPECT_FALSE(is_free) << "missed, by " << static_cast<double>(*gap);
      }
      if (is_free) {
        ++free;
      } else {
        ASSERT_TRUE(gap);
        EXPECT_LE(*gap, kSlack);
        ++hits;
        self_hits += oracle.bodies[oracle.pairs[nearest].second].link >= 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(hits, effort(60, 6));
  EXPECT_GT(self_hits, effort(40, 4));
  EXPECT_GT(free, effort(150, 20));
}

// The padding is such that the nearest pair just touches, or just not.
TEST(RobotChecker, PaddingIsGrownSpheresToTheLastDigits) {
  Random random(seeded(72));
  int touching = 0;
  int apart = 0;
  for (int n = 0; n < scaled(200, 40); ++n) {
    auto [scene, oracle] = random_scene(random);
    const std::vector<double> q = random_configuration(random, oracle.robot, 3.0);
    std::size_t nearest = 0;
    const auto gap = oracle.gap(q, &nearest);
    if (!gap || *gap <= 0.0L) continue;
    const OraclePair& pair = oracle.pairs[nearest];
    const OracleBody& body = oracle.bodies[pair.first];
    const bool touches = random.whole(0, 1) == 0;
    const double more = touches ? std::nextafter(static_cast<double>(*gap), 1e9)
                                : static_cast<double>(*gap - 2 * kSlack);
    if (more < 0.0) continue;
    if (n % 3 == 0) {
      scene.set_padding(body.name, static_cast<double>(body.padding) + more);
    } else {
      scene.set_padding(body.name, oracle.bodies[pair.second].name,
                        static_cast<double>(pair.padding) + more);
    }
    Checked checked(scene);
    if (touches) {
      EXPECT_FALSE(checked.free(q));
      ++touching;
    } else if (n % 3 != 0) {
      EXPECT_TRUE(checked.free(q)) << more;
      ++apart;
    }
  }
  EXPECT_GT(touching, effort(30, 3));
  EXPECT_GT(apart, effort(20, 2));
}

TEST(RobotChecker, ClearanceIsNeverAboveTheLeastGap) {
  Random random(seeded(73));
  int above_zero = 0;
  for (int n = 0; n < scaled(150, 30); ++n) {
    const auto [scene, oracle] = random_scene(random);
    Checked checked(scene);
    const std::vector<double> q = random_configuration(random, oracle.robot, 3.0);
    const auto gap = oracle.gap(q);
    const RobotClearance clearance = checked.clearance(q);
    // Anywhere, or as near the gap as single precision cannot tell, or can just.
    for (int k = 0; k < 6; ++k) {
      const double off = random.sign() * std::pow(10.0, random.between(-16.0, -4.0));
      const double least = gap ? static_cast<double>(*gap) : 0.0;
      const double within = std::max(0.0, k == 0 ? random.between(0.0, 1.0) : least + off);
      for (const InstructionSet set : instruction_sets()) {
        Checked other(scene, {.instructions = set});
        const bool is_within = other.checker.within(q, within, other.scratch);
        ASSERT_TRUE(is_within || !gap || *gap > within) << "missed, by " << within - least;
        ASSERT_TRUE(!is_within || (gap && *gap <= within + kSlack)) << within - least;
      }
    }
    if (!gap) {
      EXPECT_EQ(clearance.lower, std::numeric_limits<double>::infinity());
      EXPECT_TRUE(clearance.first.name.empty());
      continue;
    }
    EXPECT_LE(clearance.lower, std::max(0.0L, *gap));
    EXPECT_GE(clearance.upper, *gap);
    if (*gap < 1e-9L) continue;
    ++above_zero;
    EXPECT_NEAR(clearance.lower, static_cast<double>(*gap), 1e-8);
    EXPECT_NEAR(clearance.upper, static_cast<double>(*gap), 1e-10);
    EXPECT_TRUE(checked.free(q));
    // The two that are named are that far apart.
    bool found = false;
    std::vector<Pose> poses;
    forward_kinematics(oracle.robot, q, poses, oracle.world_from_root);
    for (const OraclePair& pair : oracle.pairs) {
      const std::set<std::string> names = {oracle.bodies[pair.first].name,
                                           oracle.bodies[pair.second].name};
      if (names != std::set<std::string>{clearance.first.name, clearance.second.name}) continue;
      found = true;
      EXPECT_NEAR(static_cast<double>(oracle.gap_of(pair, poses)), clearance.upper, 1e-10);
    }
    EXPECT_TRUE(found);
  }
  EXPECT_GT(above_zero, effort(30, 4));
}

TEST(RobotChecker, ExplainsEveryPairThatTouches) {
  Random random(seeded(74));
  int contacts = 0;
  for (int n = 0; n < scaled(250, 80); ++n) {
    const auto [scene, oracle] = random_scene(random);
    Checked checked(scene);
    const std::vector<double> q = random_configuration(random, oracle.robot, 3.0);
    std::vector<Pose> poses;
    forward_kinematics(oracle.robot, q, poses, oracle.world_from_root);
    const std::vector<CheckedContact> found = checked.explain(q);
    EXPECT_EQ(found.empty(), checked.free(q));
    std::size_t touching = 0;
    for (const OraclePair& pair : oracle.pairs) {
      const long double gap = oracle.gap_of(pair, poses);
      const std::set<std::string> names = {oracle.bodies[pair.first].name,
                                           oracle.bodies[pair.second].name};
      for (const CheckedContact& contact : found) {
        if (names != std::set<std::string>{contact.first.name, contact.second.name}) continue;
        ++touching;
        for (const CheckedBody* body : {&contact.first, &contact.second}) {
          EXPECT_EQ(body->kind, body->name.starts_with("link")     ? CheckedBody::Kind::kLink
                                : body->name.starts_with("object") ? CheckedBody::Kind::kAttached
                                                                   : CheckedBody::Kind::kObstacle);
        }
        EXPECT_LE(gap, kSlack);
        EXPECT_LE(contact.overlap_depth, -gap);
        EXPECT_NEAR(contact.overlap_depth, static_cast<double>(-gap), 1e-10) << "the deepest";
        const long double padding =
            pair.padding + oracle.bodies[pair.first].padding + oracle.bodies[pair.second].padding;
        EXPECT_NEAR(contact.padding, static_cast<double>(padding), 1e-12);
        // The named spheres, alone, overlap that deep, and the point is between them.
        const bool swapped = contact.first.name != oracle.bodies[pair.first].name;
        OracleScene alone = oracle;
        const auto leave = [&](OracleBody& body, const CheckedBody& told) {
          const Sphere sphere = body.trees[told.tree][static_cast<std::size_t>(told.sphere)];
          body.trees = {{sphere}};
        };
        leave(alone.bodies[pair.first], swapped ? contact.second : contact.first);
        leave(alone.bodies[pair.second], swapped ? contact.first : contact.second);
        const OraclePair spheres{pair.first, pair.second, pair.padding, {}};
        EXPECT_NEAR(static_cast<double>(-alone.gap_of(spheres, poses)), contact.overlap_depth,
                    1e-10);
        alone.bodies.push_back(
            {"point", -1, Pose::from_translation(contact.world_point), {{Sphere{{0, 0, 0}, 0.0}}}});
        for (const std::size_t side : {pair.first, pair.second}) {
          EXPECT_LE(alone.gap_of({side, alone.bodies.size() - 1, padding, {}}, poses), 1e-9L);
        }
        ++contacts;
      }
      if (gap <= 0.0L) --touching;
    }
    EXPECT_EQ(touching, 0U) << "each pair that touches once";
    const auto one = checked.explain(q, {.max_contacts = 1});
    EXPECT_EQ(one.size(), std::min<std::size_t>(found.size(), 1));
  }
  EXPECT_GT(contacts, effort(20, 3));
}

// Axes that point nearly backwards, and trees far from their frames, whose offsets cancel.
TEST(RobotChecker, AnswersAsTheExactQueriesDoForOddFrames) {
  Random random(seeded(23));
  int hits = 0;
  for (int i = 0; i < scaled(4000, 300); ++i) {
    RobotModel robot("base");
    const double far = std::pow(10.0, random.between(0.0, 8.0));
    std::string parent = "base";
    for (int k = 0; k < 6; ++k) {
      Joint joint = turning(0.0, 0.0);
      const double off = std::pow(10.0, random.between(-8.5, -5.5));
      joint.axis = {off * random.between(-1.0, 1.0), off * random.between(-1.0, 1.0), -1.0};
      joint.parent_from_joint = random.pose(0.3);
      const std::string link = "link_" + std::to_string(k);
      robot.add_link(link, parent, joint);
      parent = link;
    }
    // A link that leads the tree's offset back to the joint.
    const Eigen::Vector3d offset = far * random.point(1.0);
    robot.add_link("tool", parent,
                   {.name = "bolt", .parent_from_joint = Pose::from_translation(-offset)});
    const Sphere sphere{offset + random.point(0.2), 0.1};
    robot.attach("tool", one_sphere_tree(sphere.center, sphere.radius));
    const std::vector<double> configuration = random_configuration(random, robot, 3.2);
    std::vector<Pose> world_from_link;
    forward_kinematics(robot, configuration, world_from_link);
    const double gap =
        (random.whole(0, 1) == 0 ? 1.0 : -1.0) * std::pow(10.0, random.between(-9.0, -5.0));
    const Eigen::Vector3d away = far * random.point(1.0);
    const Eigen::Vector3d center = world_from_link.back() * sphere.center +
                                   (sphere.radius + 0.2 + gap) * random.point(1.0).normalized();
    const std::vector<PlacedTree> obstacles = {
        {one_sphere_tree(away, 0.2), Pose::from_translation(center - away)}};
    SCOPED_TRACE(testing::Message() << i << ' ' << far);
    const bool expected = answer(robot, obstacles, configuration);
    for (const InstructionSet set : instruction_sets()) {
      Checked checked(obstacle_checker(robot, obstacles, {.instructions = set}));
      EXPECT_EQ(checked.free(configuration), !expected);
    }
    hits += expected ? 1 : 0;
    if (HasFailure()) return;
  }
  EXPECT_GT(hits, effort(1000, 100));
}

// Two spheres at the ends of arms that turn about the same axis.
RobotScene two_arms() {
  RobotModel robot = one_arm(wheel(), {1, 0, 0}, 0.1);
  robot.add_link("b", "base", wheel());
  robot.attach("b", one_sphere_tree({1, 0, 0}, 0.1));
  return RobotScene(robot);
}

TEST(RobotChecker, TellsNoLessPaddingThanIsAskedFor) {
  RobotScene scene = two_arms();
  scene.set_padding("arm", 0.1);
  scene.set_padding("b", 0.7);
  ASSERT_LT(static_cast<long double>(0.1 + 0.7), 0.1L + 0.7L - 1e-18L);
  const auto told = Checked(scene).explain(Configuration{0.0, 0.5});
  ASSERT_EQ(told.size(), 1U);
  EXPECT_GE(static_cast<long double>(told[0].padding),
            static_cast<long double>(0.1) + static_cast<long double>(0.7));
}

TEST(RobotChecker, NoClearanceIsPromisedWhereNoErrorIsKnown) {
  Checked checked(two_arms());
  const RobotClearance usual = checked.clearance(Configuration{99.0, 97.0});
  EXPECT_GT(usual.lower, 1.0);
  const RobotClearance beyond = checked.clearance(Configuration{101.0, 99.0});
  EXPECT_EQ(beyond.lower, 0.0);
  EXPECT_NEAR(beyond.upper, usual.upper, 1e-9);
}

}  // namespace
}  // namespace spherule::test
