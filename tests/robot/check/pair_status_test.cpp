// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "robot/check/robot_collision.h"
#include "spheretree/build.h"
#include "tests/robot/box_robots.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

namespace spherule::test::pair_status_test {
namespace {

// Boxes that slide along x: a sled on the floor, on it a cart that can reach the floor's box, a
// bumper fixed to that, and a bird that is 5 m above.
BoxRobot slides() {
  BoxRobot robot{RobotModel("floor")};
  const auto slide = [](const char* name, double lower) {
    return Joint{.name = name,
                 .type = JointType::kPrismatic,
                 .axis = Eigen::Vector3d::UnitX(),
                 .lower = lower,
                 .upper = 1.0};
  };
  robot.model.add_link("sled", "floor", slide("push", 0.5));
  robot.model.add_link("cart", "sled", slide("pull", -1.0));
  robot.model.add_link("bumper", "cart", {.name = "screw", .type = JointType::kFixed});
  robot.model.add_link("bird", "cart", slide("fly", 0.0));
  for (const char* const name : {"floor", "sled", "cart", "bumper", "bird"}) {
    const int link = robot.model.find_link(name);
    const Eigen::Vector3d center(0, 0, std::string(name) == "bird" ? 5.0 : 0.0);
    robot.add_boxes(link, {{center.array() - 0.1, center.array() + 0.1}});
    robot.model.attach(
        name, std::make_shared<const SphereTree>(build_tree(std::vector<Sphere>{{center, 0.2}})));
  }
  return robot;
}

std::string kind(const RobotModel& robot, const std::vector<PairStatus>& pairs, const char* a,
                 const char* b) {
  const int first = robot.find_link(a);
  const int second = robot.find_link(b);
  for (const PairStatus& pair : pairs) {
    if (pair.first == first && pair.second == second) return std::string(kind_of(pair));
  }
  return "missing";
}

TEST(PairStatus, KindsAreToldApart) {
  const BoxRobot robot = slides();
  const auto proofs =
      std::make_shared<const LinkPairs>(prove_link_pairs(robot.model, robot.bodies));
  AllowedCollisions allowed(robot.model);
  allowed.allow("floor", "bumper");
  const std::vector<PairStatus> pairs = pair_statuses(robot.model, allowed, proofs);
  ASSERT_EQ(pairs.size(), 10U);
  EXPECT_EQ(kind(robot.model, pairs, "cart", "bumper"), "rigid");
  EXPECT_EQ(kind(robot.model, pairs, "floor", "sled"), "adjacent");
  EXPECT_EQ(kind(robot.model, pairs, "floor", "bumper"), "given");
  EXPECT_EQ(kind(robot.model, pairs, "floor", "cart"), "free in boxes");
  EXPECT_EQ(kind(robot.model, pairs, "floor", "bird"), "proved never");
  for (const PairStatus& pair : pairs) {
    EXPECT_EQ(pair.verdict.has_value(), pair.reason != AllowedReason::kRigid);
    EXPECT_EQ(pair.free_share == 1.0, pair.verdict == PairVerdict::kNever);
  }

  const std::vector<PairStatus> unproved = pair_statuses(robot.model, allowed, nullptr);
  EXPECT_EQ(kind(robot.model, unproved, "floor", "cart"), "tested");
  EXPECT_EQ(kind(robot.model, unproved, "floor", "bumper"), "given");
  EXPECT_THROW(pair_statuses(RobotModel("floor"), allowed, proofs), Error);
}

TEST(PairStatus, WhereNoBoxIsFreeTheVerdictIsTheKind) {
  PairStatus status;
  EXPECT_EQ(kind_of(status), "tested");
  status.verdict = PairVerdict::kTouching;
  EXPECT_EQ(kind_of(status), "can touch");
  status.verdict = PairVerdict::kUnknown;
  EXPECT_EQ(kind_of(status), "unknown");
}

}  // namespace
}  // namespace spherule::test::pair_status_test
