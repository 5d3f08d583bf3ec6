// SPDX-License-Identifier: BSD-3-Clause
// A robot whose contacts are confirmed on triangles: the answers of collides() of covered meshes,
// or of meshes and spheres.

#include "base/error.h"
#include "robot/model/kinematics.h"
#include "tests/robot/check/checked_scene.h"
#include "tests/robot/robots.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

// One call for all, and a call for each, on every instruction set; explain() agrees.
void expect_verdicts_on_every_set(const RobotModel& robot, const std::vector<PlacedTree>& obstacles,
                                  ObstacleOptions options, std::span<const double> path,
                                  const std::vector<std::uint8_t>& expected, int round) {
  const auto variables = static_cast<std::size_t>(robot.variable_count());
  for (const InstructionSet set : instruction_sets()) {
    options.instructions = set;
    const ObstacleChecker checker(robot, obstacles, options);
    RobotChecker::Scratch scratch(checker);
    std::vector<std::uint8_t> verdicts(expected.size());
    checker.collides(path, scratch, verdicts);
    EXPECT_EQ(verdicts, expected) << round;
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const auto at = path.subspan(k * variables, variables);
      ASSERT_EQ(checker.collides(at, scratch), expected[k] != 0) << round << ' ' << k;
      ASSERT_EQ(checker.explain(at, scratch).empty(), expected[k] == 0) << round << ' ' << k;
    }
  }
}

TEST(RobotMesh, AnswersAsTheCoveredMeshesDo) {
  Random random(seeded(61));
  int hits = 0;
  int removed = 0;
  int free = 0;
  for (int i = 0; i < scaled(60, 8); ++i) {
    RobotModel robot = random_robot(random, random.whole(1, 6), i % 2 == 1);
    ObstacleOptions options{.world_from_root = random_root(random, 1.0)};
    std::vector<std::pair<std::size_t, std::shared_ptr<const CoveredMesh>>> bodies;
    for (std::size_t link = 0; link < robot.links().size(); ++link) {
      const auto mesh = covered_tetrahedron(random, random.between(0.05, 0.4));
      robot.attach(robot.links()[link].name, cover_of(mesh));
      options.meshes.push_back(mesh);
      bodies.emplace_back(link, mesh);
    }
    std::vector<PlacedTree> obstacles;
    std::vector<std::shared_ptr<const CoveredMesh>> obstacle_meshes;
    for (int k = 0; k < 3; ++k) {
      const auto mesh = covered_tetrahedron(random, random.between(0.05, 1.5));
      obstacles.push_back({cover_of(mesh), random.pose(1.5)});
      options.meshes.push_back(mesh);
      obstacle_meshes.push_back(mesh);
    }
    std::vector<double> path;
    std::vector<std::uint8_t> expected;
    for (int k = 0; k < 60; ++k) {
      const std::vector<double> at = random_configuration(random, robot, k % 20 == 0 ? 300.0 : 3.2);
      path.insert(path.end(), at.begin(), at.end());
      std::vector<Pose> poses;
      forward_kinematics(robot, at, poses, options.world_from_root);
      bool spheres = false;
      bool hit = false;
      for (const auto& [link, mesh] : bodies) {
        for (std::size_t o = 0; o < obstacles.size(); ++o) {
          spheres = spheres || collides(mesh->cover(), poses[link], *obstacles[o].tree,
                                        obstacles[o].world_from_tree);
          hit = hit ||
                collides(*mesh, poses[link], *obstacle_meshes[o], obstacles[o].world_from_tree);
        }
      }
      expected.push_back(hit ? 1 : 0);
      (hit ? hits : spheres ? removed : free) += 1;
    }
    expect_verdicts_on_every_set(robot, obstacles, options, path, expected, i);
  }
  EXPECT_GT(hits, effort(300, 20));
  EXPECT_GT(removed, effort(300, 20));
  EXPECT_GT(free, effort(50, 5));
}

// Up to 40 triangles within `size`, or a closed tetrahedron.
std::shared_ptr<const CoveredMesh> random_body(Random& random, double size) {
  if (random.whole(0, 2) == 0) return covered_tetrahedron(random, size);
  TriangleMesh mesh;
  for (int i = random.whole(1, 40); i > 0; --i) {
    const Eigen::Vector3d a = random.point(size);
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(),
                         {a, a + random.point(0.3 * size), a + random.point(0.3 * size)});
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return covered_surface(mesh);
}

bool is_untested(const ObstacleOptions& options, std::size_t link, std::size_t obstacle) {
  return std::any_of(options.untested.begin(), options.untested.end(), [&](const auto& pair) {
    return static_cast<std::size_t>(pair.link) == link && pair.obstacle == obstacle;
  });
}

// One side of every pair is a mesh, the other one spheres: those of the obstacles, but for every
// fifth robot.
TEST(RobotMesh, AnswersAsMeshesAmongSpheresDoOnEveryInstructionSet) {
  Random random(seeded(71));
  int hits = 0;
  int removed = 0;
  int free = 0;
  for (int i = 0; i < scaled(100, 20); ++i) {
    RobotModel robot = random_robot(random, random.whole(1, 6), i % 2 == 1);
    ObstacleOptions options{.world_from_root = random_root(random, 1.0)};
    std::vector<std::pair<std::size_t, std::shared_ptr<const CoveredMesh>>> bodies;
    for (std::size_t link = 0; link < robot.links().size(); ++link) {
      if (random.whole(0, 3) == 0) continue;
      bodies.emplace_back(link, random_body(random, 0.3));
      robot.attach(robot.links()[link].name, cover_of(bodies.back().second));
    }
    std::vector<PlacedTree> obstacles;
    for (int k = random.whole(1, 3); k > 0; --k) {
      obstacles.push_back({random_tree(random, 0.8), random.pose(1.0)});
    }
    std::vector<std::shared_ptr<const CoveredMesh>> others(obstacles.size());
    for (std::size_t o = 0; i % 5 == 4 && o < obstacles.size(); ++o) {
      others[o] = random_body(random, 0.5);
      obstacles[o].tree = cover_of(others[o]);
      options.meshes.push_back(others[o]);
    }
    if (i % 5 != 4) {
      for (const auto& [link, mesh] : bodies) options.meshes.push_back(mesh);
    }
    if (i % 3 == 0) {
      options.untested.push_back({0, 0});
      options.untested.push_back({static_cast<int>(robot.links().size()) - 1, 0});
    }
    std::vector<double> path;
    std::vector<std::uint8_t> expected;
    for (int k = 0; k < 40; ++k) {
      // The last ones are far out of the kernels' range.
      const std::vector<double> at = random_configuration(random, robot, k < 36 ? 2.0 : 300.0);
      path.insert(path.end(), at.begin(), at.end());
      std::vector<Pose> poses;
      forward_kinematics(robot, at, poses, options.world_from_root);
      bool spheres = false;
      bool hit = false;
      for (const auto& [link, mesh] : bodies) {
        for (std::size_t o = 0; o < obstacles.size(); ++o) {
          const auto& [tree, world_from_tree] = obstacles[o];
          if (is_untested(options, link, o)) continue;
          if (!collides(mesh->cover(), poses[link], *tree, world_from_tree)) continue;
          spheres = true;
          hit = hit || (others[o] ? collides(mesh->cover(), poses[link], others[o]->solid(),
                                             world_from_tree)
                                  : collides(*tree, world_from_tree, mesh->solid(), poses[link]));
        }
      }
      expected.push_back(hit ? 1 : 0);
      (hit ? hits : spheres ? removed : free) += 1;
    }
    expect_verdicts_on_every_set(robot, obstacles, options, path, expected, i);
  }
  EXPECT_GT(hits, effort(400, 80));
  EXPECT_GT(removed, effort(50, 10));
  EXPECT_GT(free, effort(400, 80));
}

using Meshes = std::vector<std::shared_ptr<const CoveredMesh>>;

// Of all, of the robot alone, of the two obstacles alone, which are the last, of none.
Meshes some_of(const Meshes& meshes, int which) {
  Meshes some;
  if (which < 2) some.assign(meshes.begin(), meshes.end() - 2);
  if (which % 2 == 0) some.insert(some.end(), meshes.end() - 2, meshes.end());
  return some;
}

// Sometimes another query: of a block, a motion, or a clearance.
void query_in_between(Random& random, const ObstacleChecker& checker, const std::vector<double>& at,
                      const std::vector<double>& elsewhere, RobotChecker::Scratch& scratch) {
  std::uint8_t verdict = 0;
  switch (random.whole(0, 40)) {
    case 0:
      checker.collides(elsewhere, scratch, std::span(&verdict, 1));
      break;
    case 1:
      checker.check_edge(elsewhere, at, scratch, {.resolution = 0.05});
      break;
    case 2:
      checker.within(at, random.between(0.0, 0.1), scratch);
      break;
    default:
      break;
  }
}

// Along paths, with steps of any size, stops and jumps, what is remembered changes no answer:
// neither of those before, nor of a block or a motion that was requested in between.
TEST(RobotMesh, AnswersAlongAPathAsWithoutMemory) {
  Random random(seeded(63));
  int hits = 0;
  int free = 0;
  int changes = 0;
  for (int i = 0; i < scaled(60, 10); ++i) {
    RobotModel robot = random_robot(random, random.whole(1, 6), i % 2 == 1);
    ObstacleOptions options{.world_from_root = random_root(random, 1.0)};
    std::vector<std::shared_ptr<const CoveredMesh>> meshes;
    // What stands with the root would touch always or never.
    for (const Joint& joint : std::vector<Joint>(robot.joints())) {
      const Link& link = robot.links()[static_cast<std::size_t>(joint.child_link)];
      meshes.push_back(covered_tetrahedron(random, random.between(0.05, 0.4)));
      robot.attach(std::string(link.name), cover_of(meshes.back()));
    }
    std::vector<PlacedTree> obstacles;
    // Obstacles stand where links come to, and the paths begin there.
    const std::vector<double> home = random_configuration(random, robot, 3.2);
    std::vector<Pose> links;
    forward_kinematics(robot, home, links, options.world_from_root);
    for (int k = 0; k < 2; ++k) {
      meshes.push_back(covered_tetrahedron(random, random.between(0.05, 0.4)));
      const auto link =
          static_cast<std::size_t>(random.whole(1, static_cast<int>(robot.links().size()) - 1));
      obstacles.push_back(
          {cover_of(meshes.back()),
           Pose(random.quaternion(), links[link].translation() + random.point(0.5))});
    }
    const auto near_home = [&] {
      std::vector<double> result = random_configuration(random, robot, 0.3);
      for (std::size_t v = 0; v < result.size(); ++v) result[v] += home[v];
      return result;
    };
    options.meshes = some_of(meshes, i % 4);
    const ObstacleChecker checker(robot, obstacles, options);
    RobotChecker::Scratch remembers(checker);
    std::vector<double> at = near_home();
    std::vector<double> heading = random_configuration(random, robot, 1.0);
    double step = 1e-2;
    bool before = false;
    for (int k = 0; k < 1500; ++k) {
      if (random.whole(0, 60) == 0) heading = random_configuration(random, robot, 1.0);
      if (random.whole(0, 90) == 0) step = std::pow(10.0, random.between(-6.0, -1.3));
      if (random.whole(0, 150) == 0) at = near_home();
      if (random.whole(0, 20) != 0) {
        for (std::size_t v = 0; v < at.size(); ++v) at[v] += step * heading[v];
      }
      RobotChecker::Scratch fresh(checker);
      const bool expected = checker.collides(at, fresh);
      ASSERT_EQ(checker.collides(at, remembers), expected) << i << ' ' << k;
      query_in_between(random, checker, at, near_home(), remembers);
      (expected ? hits : free) += 1;
      changes += k > 0 && before != expected;
      before = expected;
    }
  }
  EXPECT_GT(hits, effort(3000, 300));
  EXPECT_GT(free, effort(3000, 300));
  EXPECT_GT(changes, effort(100, 10));
}

// A small body inside a large one touches none of its triangles.
TEST(RobotMesh, WhatLiesInsideCollides) {
  Random random(seeded(62));
  RobotModel robot("base");
  robot.add_link("arm", "base", {.name = "hinge", .type = JointType::kRevolute});
  const auto inner = covered_tetrahedron(random, 0.02);
  const auto outer = covered_tetrahedron(random, 2.0);
  robot.attach("arm", cover_of(inner));
  const std::vector<PlacedTree> obstacles = {{cover_of(outer), Pose()}};
  const ObstacleChecker checker(robot, obstacles, {.meshes = {inner, outer}});
  RobotChecker::Scratch scratch(checker);
  const std::vector<double> path = {0.0, 0.5, 1.0};
  EXPECT_TRUE(checker.collides(std::span(path).first(1), scratch));
  std::vector<std::uint8_t> verdicts(3);
  checker.collides(path, scratch, verdicts);
  EXPECT_EQ(verdicts, (std::vector<std::uint8_t>{1, 1, 1}));
}

// So does a sphere inside a mesh, whichever of the two moves.
TEST(RobotMesh, ASphereInsideCollides) {
  Random random(seeded(64));
  const auto outer = covered_tetrahedron(random, 2.0);
  const std::vector<double> path = {0.0, 0.5, 1.0};
  for (const bool mesh_moves : {true, false}) {
    RobotModel robot("base");
    robot.add_link("arm", "base", {.name = "hinge", .type = JointType::kRevolute});
    robot.attach("arm", mesh_moves ? cover_of(outer) : one_sphere_tree({0, 0, 0}, 0.02));
    const std::vector<PlacedTree> obstacles = {
        {mesh_moves ? one_sphere_tree({0, 0, 0}, 0.02) : cover_of(outer), Pose()}};
    const ObstacleChecker checker(robot, obstacles, {.meshes = {outer}});
    RobotChecker::Scratch scratch(checker);
    EXPECT_TRUE(checker.collides(std::span(path).first(1), scratch));
    std::vector<std::uint8_t> verdicts(3);
    checker.collides(path, scratch, verdicts);
    EXPECT_EQ(verdicts, (std::vector<std::uint8_t>{1, 1, 1}));
  }
}

TEST(RobotMesh, RefusesAMissingMesh) {
  RobotModel robot("base");
  EXPECT_THROW(ObstacleChecker(robot, {}, {.meshes = {nullptr}}), Error);
}

}  // namespace
}  // namespace spherule::test
