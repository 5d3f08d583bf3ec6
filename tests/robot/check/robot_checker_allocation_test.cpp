// SPDX-License-Identifier: BSD-3-Clause
// Which queries of a robot's checker allocate.

#include "spheretree/sphere_tree.h"
#include "tests/robot/check/checked.h"
#include "tests/robot/robots.h"
#include "tests/support/counting_new.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

namespace spherule::test {
namespace {

TEST(RobotCheckerAllocation, WarmQueriesAllocateNothing) {
  Random random(91);
  RobotModel robot = random_robot(random, 6, false);
  add_random_mimics(random, robot, 0.25);
  const auto spheres = [&](int count, double size) {
    return std::make_shared<const SphereTree>(
        build_tree(random_spheres(random, count, size, 0.1 * size)));
  };
  for (const Link& link : std::vector<Link>(robot.links())) {
    robot.attach(link.name, spheres(60, 0.2));
  }
  const auto mesh = covered_tetrahedron(random, 0.2);
  robot.attach("link_4", cover_of(mesh));
  RobotScene scene(robot);
  scene.add("tree", spheres(200, 0.5), Pose::from_translation({1, 0, 0}));
  scene.add("box", Primitive(Box{{0.1, 0.1, 0.1}}), Pose::from_translation({0, 2, 0}));
  scene.set_padding("link_3", 0.01);
  scene.attach("tool", "link_6", spheres(30, 0.1));
  Checked checked(scene, {.enforce_limits = true, .meshes = {mesh}});
  std::vector<std::vector<double>> points;
  for (int i = 0; i < 60; ++i) points.push_back(random_configuration(random, robot, 1.0));
  std::vector<double> all;
  for (const auto& point : points) all.insert(all.end(), point.begin(), point.end());
  std::vector<std::uint8_t> free(points.size());
  int collisions = 0;
  int proved = 0;
  const auto query = [&] {
    for (std::size_t i = 1; i < points.size(); ++i) {
      collisions += checked.free(points[i]) ? 0 : 1;
      const EdgeResult edge =
          checked.edge(points[i - 1], points[i], {.resolution = 1e-2, .first = i % 2 == 0});
      checked.checker.within(points[i], 0.1, checked.scratch);
      proved += edge.free_until > 0.0 ? 1 : 0;
    }
    checked.checker.check_configs(all, checked.scratch, free);
  };
  query();
  const int before = allocations;
  query();
  EXPECT_EQ(allocations, before);
  EXPECT_GT(collisions, 0);
  EXPECT_LT(collisions, 2 * static_cast<int>(points.size()) - 4);
  EXPECT_GT(proved, 0);
}

TEST(RobotCheckerAllocation, NorDoTurnsByTheShorterWay) {
  RobotScene scene(one_arm(wheel("swing"), {1.0, 0.0, 0.0}, 0.01));
  scene.add("post", one_sphere_tree({1.0, 0.0, 0.0}, 0.01));
  Checked checked(scene);
  const Configuration from = {3.0};
  const Configuration to = {-3.0};
  const EdgeRequest request{.continuous = ContinuousMotion::kShortest};
  EXPECT_EQ(checked.edge(from, to, request).verdict, Verdict::kFree);
  const int before = allocations;
  EXPECT_EQ(checked.edge(from, to, request).verdict, Verdict::kFree);
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace spherule::test
