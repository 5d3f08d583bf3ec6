// SPDX-License-Identifier: BSD-3-Clause
// RobotChecker against every pair of spheres in extended precision.

#include "robot/check/robot_checker.h"

#include "base/error.h"
#include "robot/model/kinematics.h"
#include "spheretree/build.h"
#include "tests/robot/check/scene_oracle.h"
#include "tests/robot/robots.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

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
    const RobotChecker checker = scene.snapshot();
    RobotChecker::Scratch scratch(checker);
    for (int i = 0; i < 4; ++i) {
      const std::vector<double> q = random_configuration(random, oracle.robot, 3.0);
      std::size_t nearest = 0;
      const auto gap = oracle.gap(q, &nearest);
      const bool is_free = checker.check_config(q, scratch);
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
    const RobotChecker checker = scene.snapshot();
    RobotChecker::Scratch scratch(checker);
    if (touches) {
      EXPECT_FALSE(checker.check_config(q, scratch));
      ++touching;
    } else if (n % 3 != 0) {
      EXPECT_TRUE(checker.check_config(q, scratch)) << more;
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
    const RobotChecker checker = scene.snapshot();
    RobotChecker::Scratch scratch(checker);
    const std::vector<double> q = random_configuration(random, oracle.robot, 3.0);
    const auto gap = oracle.gap(q);
    const RobotClearance clearance = checker.clearance(q, scratch);
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
    EXPECT_TRUE(checker.check_config(q, scratch));
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
  for (int n = 0; n < scaled(150, 30); ++n) {
    const auto [scene, oracle] = random_scene(random);
    const RobotChecker checker = scene.snapshot();
    RobotChecker::Scratch scratch(checker);
    const std::vector<double> q = random_configuration(random, oracle.robot, 3.0);
    std::vector<Pose> poses;
    forward_kinematics(oracle.robot, q, poses, oracle.world_from_root);
    const std::vector<CheckedContact> found = checker.explain(q, scratch);
    EXPECT_EQ(found.empty(), checker.check_config(q, scratch));
    std::size_t touching = 0;
    for (const OraclePair& pair : oracle.pairs) {
      const long double gap = oracle.gap_of(pair, poses);
      const std::set<std::string> names = {oracle.bodies[pair.first].name,
                                           oracle.bodies[pair.second].name};
      for (const CheckedContact& contact : found) {
        if (names != std::set<std::string>{contact.first.name, contact.second.name}) continue;
        ++touching;
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
    const auto one = checker.explain(q, scratch, {.max_contacts = 1});
    EXPECT_EQ(one.size(), std::min<std::size_t>(found.size(), 1));
  }
  EXPECT_GT(contacts, effort(20, 3));
}

// An attached object is tested as the same tree on a link of its own that stands in its link.
TEST(RobotChecker, AttachedObjectsAreLinks) {
  Random random(seeded(75));
  int hits = 0;
  for (int n = 0; n < scaled(150, 20); ++n) {
    RobotModel robot = random_robot(random, 4, false);
    for (const auto& link : {"link_0", "link_1", "link_2", "link_3", "link_4"}) {
      robot.attach(link, std::make_shared<const SphereTree>(
                             build_tree(random_spheres(random, 10, 0.25, 0.1))));
    }
    const auto tool =
        std::make_shared<const SphereTree>(build_tree(random_spheres(random, 20, 0.4, 0.06)));
    const auto wall =
        std::make_shared<const SphereTree>(build_tree(random_spheres(random, 30, 1.0, 0.1)));
    const Pose pose = random.pose(0.3);
    RobotScene attached(robot);
    RobotModel with_link = robot;
    with_link.add_link("tool", "link_4", {.parent_from_joint = pose});
    with_link.attach("tool", tool);
    AllowedCollisions allowed(with_link);
    for (const auto& link : robot.links()) {
      const auto reason =
          allowed.reason(with_link.find_link(link.name), with_link.find_link("tool"));
      if (reason != AllowedReason::kRigid && reason != AllowedReason::kTested) {
        allowed.forbid(link.name, "tool");
      }
    }
    RobotScene linked(with_link);
    linked.set_allowed_collisions(allowed);
    attached.attach("tool", "link_4", tool, pose);
    for (RobotScene* scene : {&attached, &linked}) scene->add("wall", wall, Pose());
    const RobotChecker a = attached.snapshot();
    const RobotChecker b = linked.snapshot();
    RobotChecker::Scratch scratch_a(a);
    RobotChecker::Scratch scratch_b(b);
    for (int i = 0; i < 10; ++i) {
      const std::vector<double> q = random_configuration(random, robot, 3.0);
      EXPECT_EQ(a.check_config(q, scratch_a), b.check_config(q, scratch_b));
      const auto told_a = a.explain(q, scratch_a);
      const auto told_b = b.explain(q, scratch_b);
      ASSERT_EQ(told_a.size(), told_b.size());
      for (std::size_t k = 0; k < told_a.size(); ++k) {
        EXPECT_EQ(told_a[k].first.name, told_b[k].first.name);
        EXPECT_EQ(told_a[k].first.sphere, told_b[k].first.sphere);
        EXPECT_EQ(told_a[k].overlap_depth, told_b[k].overlap_depth);
        if (told_a[k].first.name == "tool") {
          EXPECT_EQ(told_a[k].first.kind, CheckedBody::Kind::kAttached);
          EXPECT_EQ(told_b[k].first.kind, CheckedBody::Kind::kLink);
          ++hits;
        }
      }
    }
    attached.detach("tool");
    const RobotChecker bare = attached.snapshot();
    RobotChecker::Scratch scratch(bare);
    const std::vector<double> q = random_configuration(random, robot, 3.0);
    for (const CheckedContact& contact : bare.explain(q, scratch)) {
      EXPECT_NE(contact.first.name, "tool");
    }
  }
  EXPECT_GT(hits, effort(30, 2));
}

TEST(RobotChecker, ManyAndThreadsAnswerAsOne) {
  Random random(seeded(76));
  for (int n = 0; n < scaled(20, 4); ++n) {
    const auto [scene, oracle] = random_scene(random);
    for (const bool enforce : {false, true}) {
      const RobotChecker checker = scene.snapshot({.enforce_limits = enforce});
      const auto variables = static_cast<std::size_t>(oracle.robot.variable_count());
      const std::size_t count = static_cast<std::size_t>(effort(1500, 600));
      std::vector<double> configurations;
      std::vector<std::uint8_t> expected;
      RobotChecker::Scratch scratch(checker);
      for (std::size_t i = 0; i < count; ++i) {
        const double size = i % 50 == 0 ? 150.0 : 3.0;
        const std::vector<double> q = random_configuration(random, oracle.robot, size);
        configurations.insert(configurations.end(), q.begin(), q.end());
        expected.push_back(checker.check_config(q, scratch) ? 1 : 0);
      }
      std::vector<std::uint8_t> free(count, 7);
      checker.check_configs(configurations, scratch, free);
      EXPECT_EQ(free, expected);
      std::vector<RobotChecker::Scratch> scratches;
      for (int i = 0; i < 3; ++i) scratches.emplace_back(checker);
      std::fill(free.begin(), free.end(), std::uint8_t{7});
      checker.check_configs(configurations, scratches, free);
      EXPECT_EQ(free, expected);
      if (variables == 0) continue;
      configurations[(count - 1) * variables] = std::numeric_limits<double>::quiet_NaN();
      EXPECT_THROW(checker.check_configs(configurations, scratches, free), Error);
      EXPECT_THROW(checker.check_configs(configurations, scratch, free), Error);
    }
  }
}

// Two spheres at the ends of arms that turn about the same axis.
RobotScene two_arms() {
  RobotModel robot("base");
  robot.add_link("a", "base", {.type = JointType::kContinuous});
  robot.add_link("b", "base", {.type = JointType::kContinuous});
  robot.attach("a", one_sphere_tree({1, 0, 0}, 0.1));
  robot.attach("b", one_sphere_tree({1, 0, 0}, 0.1));
  return RobotScene(robot);
}

TEST(RobotChecker, TellsNoLessPaddingThanIsAskedFor) {
  RobotScene scene = two_arms();
  scene.set_padding("a", 0.1);
  scene.set_padding("b", 0.7);
  ASSERT_LT(static_cast<long double>(0.1 + 0.7), 0.1L + 0.7L - 1e-18L);
  const RobotChecker checker = scene.snapshot();
  RobotChecker::Scratch scratch(checker);
  const auto told = checker.explain(std::vector<double>{0.0, 0.5}, scratch);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_GE(static_cast<long double>(told[0].padding),
            static_cast<long double>(0.1) + static_cast<long double>(0.7));
}

TEST(RobotChecker, NoClearanceIsPromisedWhereNoErrorIsKnown) {
  const RobotChecker checker = two_arms().snapshot();
  RobotChecker::Scratch scratch(checker);
  const RobotClearance usual = checker.clearance(std::vector<double>{99.0, 97.0}, scratch);
  EXPECT_GT(usual.lower, 1.0);
  const RobotClearance beyond = checker.clearance(std::vector<double>{101.0, 99.0}, scratch);
  EXPECT_EQ(beyond.lower, 0.0);
  EXPECT_NEAR(beyond.upper, usual.upper, 1e-9);
}

}  // namespace
}  // namespace spherule::test
