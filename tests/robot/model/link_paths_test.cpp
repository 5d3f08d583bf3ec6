// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model/link_paths.h"

#include "base/error.h"
#include "robot/pairs/allowed_collisions.h"
#include "tests/robot/robots.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace spherule::test::link_paths_test {
namespace {

using internal::Joined;
using internal::LinkRelations;

// From the joints between two links, one after the other.
LinkRelations::Relation relation(const RobotModel& robot, int first, int second,
                                 const std::vector<bool>& has_spheres) {
  LinkRelations::Relation result;
  int moving = 0;
  int link = first;
  for (const int index : internal::joints_between(robot, first, second)) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(index)];
    if (link != first && has_spheres[static_cast<std::size_t>(link)]) result.are_neighbours = false;
    link = joint.child_link == link ? joint.parent_link : joint.child_link;
    moving += joint.moves() ? 1 : 0;
  }
  EXPECT_EQ(link, second);
  if (moving > 0) {
    result.joined = moving == 1 && result.are_neighbours ? Joined::kByOneJoint : Joined::kFurther;
  }
  return result;
}

TEST(LinkRelations, AreThoseOfTheJointsBetween) {
  Random random(401);
  std::vector<int> counts(3);
  int apart = 0;
  for (int n = 0; n < 100; ++n) {
    const RobotModel robot = random_robot(random, random.whole(0, 12), n % 4 != 0);
    std::vector<bool> has_spheres;
    for (std::size_t i = 0; i < robot.links().size(); ++i) {
      has_spheres.push_back(random.whole(0, 1) == 0);
    }
    const LinkRelations relations(robot);
    for (int first = 0; first < static_cast<int>(robot.links().size()); ++first) {
      const auto related = relations.of(
          first, [&](int link) { return has_spheres[static_cast<std::size_t>(link)]; });
      ASSERT_EQ(related.size(), robot.links().size());
      for (int second = 0; second < static_cast<int>(related.size()); ++second) {
        const LinkRelations::Relation& found = related[static_cast<std::size_t>(second)];
        const LinkRelations::Relation expected = relation(robot, first, second, has_spheres);
        ASSERT_EQ(found.joined, expected.joined) << n << ": " << first << " and " << second;
        ASSERT_EQ(found.are_neighbours, expected.are_neighbours) << n << ": " << first;
        ++counts[static_cast<std::size_t>(found.joined)];
        apart += found.are_neighbours ? 0 : 1;
      }
    }
  }
  EXPECT_GT(*std::min_element(counts.begin(), counts.end()), 300);
  EXPECT_GT(apart, 300);
}

// By paths for each pair, these are 9 billion joints.
TEST(LinkRelations, OfALongChainAreQuadraticInIt) {
  RobotModel robot("link_0");
  for (int i = 1; i < 3000; ++i) {
    robot.add_link("link_" + std::to_string(i), "link_" + std::to_string(i - 1),
                   {.type = JointType::kContinuous});
  }
  const AllowedCollisions allowed(robot);
  EXPECT_EQ(allowed.reason(1500, 1501), AllowedReason::kAdjacent);
  EXPECT_EQ(allowed.reason(0, 2999), AllowedReason::kTested);
}

TEST(AllowedCollisions, RefuseARobotOfTooManyLinks) {
  RobotModel robot("link_0");
  for (std::size_t i = 1; i <= AllowedCollisions::kMaxLinks; ++i) {
    robot.add_link("link_" + std::to_string(i), "link_0", {});
  }
  EXPECT_THROW(AllowedCollisions{robot}, Error);
}

}  // namespace
}  // namespace spherule::test::link_paths_test
