// SPDX-License-Identifier: BSD-3-Clause
// Solid meshes among the obstacles of a RobotChecker: configurations and motions in lanes, on every
// instruction set, against explain(), which makes all canonical tests one by one.

#include "collide/meshes/solid_mesh.h"
#include "collide/meshes/spheres_inside.h"
#include "robot/check/robot_checker.h"
#include "robot/check/robot_scene.h"
#include "tests/robot/check/scene_oracle.h"
#include "tests/robot/robots.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spherule::test::robot_solid_lanes_test {
namespace {

constexpr int kKinds = 8;

TriangleMesh mesh_of_kind(int kind) {
  switch (kind) {
    case 0:
      return box_mesh(Eigen::Vector3d(-1, -0.5, -0.5), Eigen::Vector3d(1, 0.5, 0.5));
    case 1:
      return icosphere(3);
    case 2:
      return torus(1.0, 0.3, 24, 12);
    case 3:
      return needles(12);
    case 4:
      return open_box();
    case 5:
      return nested_shells(3);
    case 6:
      return with_degenerates(inverted(icosphere(2)));
    default:
      return soup(60, 7);
  }
}

// Of a random kind and size, the largest of which hold the whole robot.
std::shared_ptr<const SolidMesh> random_solid(Random& random) {
  TriangleMesh mesh = mesh_of_kind(random.whole(0, kKinds - 1));
  const double size = random.whole(0, 9) < 2 ? 20.0 : random.between(0.05, 2.0);
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= size;
  mesh.vertex_error = random.whole(0, 1) == 0 ? 0.0 : random.between(0.0, 0.05);
  return std::make_shared<const SolidMesh>(mesh);
}

RandomScene scene_with_meshes(Random& random) {
  RandomScene result = random_scene(random);
  const int count = random.whole(1, 3);
  for (int i = 0; i < count; ++i) {
    result.scene.add("mesh_" + std::to_string(i), random_solid(random), random.pose(3.0));
  }
  return result;
}

struct CheckerOfSet {
  CheckerOfSet(const RobotScene& scene, InstructionSet set)
      : checker(scene.snapshot({.instructions = set})), scratch(checker) {}

  bool is_free(const std::vector<double>& q) { return checker.explain(q, scratch).empty(); }

  RobotChecker checker;
  RobotChecker::Scratch scratch;
};

std::vector<double> between(const std::vector<double>& a, const std::vector<double>& b, double t) {
  std::vector<double> result;
  for (std::size_t k = 0; k < a.size(); ++k) result.push_back((1.0 - t) * a[k] + t * b[k]);
  return result;
}

// A free and a touching configuration with nothing between them; none if all are of one kind.
std::optional<std::array<std::vector<double>, 2>> at_contact(
    CheckerOfSet& checker, const std::vector<std::vector<double>>& tested) {
  const auto is_free = [&](const std::vector<double>& q) { return checker.is_free(q); };
  const auto free = std::find_if(tested.begin(), tested.end(), is_free);
  const auto touching = std::find_if_not(tested.begin(), tested.end(), is_free);
  if (free == tested.end() || touching == tested.end()) return std::nullopt;
  std::array<std::vector<double>, 2> ends = {*free, *touching};
  for (int i = 0; i < 60; ++i) {
    const std::vector<double> middle = between(ends[0], ends[1], 0.5);
    ends[is_free(middle) ? 0 : 1] = middle;
  }
  return ends;
}

TEST(RobotSolidLanes, VerdictsAreThoseOfTheCanonicalTests) {
  Random random(seeded(921));
  int close = 0;
  for (int n = 0; n < scaled(50, 8); ++n) {
    const auto [scene, oracle] = scene_with_meshes(random);
    CheckerOfSet first(scene, InstructionSet::kPortable);
    std::vector<std::vector<double>> tested;
    for (int i = 0; i < 19; ++i) tested.push_back(random_configuration(random, oracle.robot, 3.0));
    if (const auto ends = at_contact(first, tested)) {
      tested.insert(tested.end(), ends->begin(), ends->end());
      ++close;
    }
    std::vector<double> all;
    std::vector<std::uint8_t> truth;
    for (const std::vector<double>& q : tested) {
      all.insert(all.end(), q.begin(), q.end());
      truth.push_back(first.is_free(q) ? 1 : 0);
    }
    for (const InstructionSet set : instruction_sets()) {
      CheckerOfSet other(scene, set);
      std::vector<std::uint8_t> free(tested.size(), 2);
      other.checker.check_configs(all, other.scratch, free);
      ASSERT_EQ(free, truth) << "scene " << n;
      for (std::size_t k = 0; k < tested.size(); ++k) {
        ASSERT_EQ(other.checker.check_config(tested[k], other.scratch), truth[k] != 0);
      }
    }
  }
  EXPECT_GT(close, effort(12, 1));
}

TEST(RobotSolidLanes, MotionsAreFreeWhereTheCanonicalTestsAre) {
  Random random(seeded(922));
  int free = 0;
  int hits = 0;
  for (int n = 0; n < scaled(20, 6); ++n) {
    const auto [scene, oracle] = scene_with_meshes(random);
    const Random motions(random.bits());  // the same on every instruction set
    for (const InstructionSet set : instruction_sets()) {
      CheckerOfSet tested(scene, set);
      Random motion = motions;
      for (int i = 0; i < 4; ++i) {
        const std::vector<double> from = random_configuration(motion, oracle.robot, 3.0);
        const std::vector<double> to =
            between(from, random_configuration(motion, oracle.robot, 3.0), i < 2 ? 0.05 : 1.0);
        const EdgeResult result =
            tested.checker.check_edge(from, to, tested.scratch, {.first = motion.whole(0, 9) < 3});
        (result.verdict == Verdict::kFree ? free : hits) += 1;
        const double until = result.verdict == Verdict::kFree ? 1.0 : result.free_until;
        for (int step = 0; step < effort(40, 15) && until > 0.0; ++step) {
          const double t = until * step / effort(40, 15);
          ASSERT_TRUE(tested.is_free(between(from, to, t))) << "at " << t << " of " << until;
        }
        if (result.verdict == Verdict::kCollision) {
          ASSERT_FALSE(tested.is_free(between(from, to, result.contact_at)));
        }
      }
    }
  }
  EXPECT_GT(free, effort(10, 2));
  EXPECT_GT(hits, effort(20, 4));
}

// A body that touches no triangle and is wholly inside, all along its motion.
TEST(RobotSolidLanes, AMotionInsideIsNotFree) {
  RobotModel robot("base");
  robot.add_link("slide", "base",
                 {.type = JointType::kPrismatic, .axis = {1, 0, 0}, .lower = -9, .upper = 9});
  robot.attach("slide", one_sphere_tree({0, 0, 0}, 1e-3));
  for (const int kind : {0, 1, 6}) {
    TriangleMesh mesh = mesh_of_kind(kind);
    for (Eigen::Vector3d& vertex : mesh.vertices) vertex *= 3.0;
    RobotScene scene(robot);
    scene.add("solid", std::make_shared<const SolidMesh>(mesh));
    for (const InstructionSet set : instruction_sets()) {
      CheckerOfSet tested(scene, set);
      for (double at = -1.4; at < 1.4; at += 0.07) {
        const std::vector<double> from = {at};
        const std::vector<double> to = {at + 0.01};
        EXPECT_FALSE(tested.checker.check_config(from, tested.scratch)) << kind << " at " << at;
        EXPECT_NE(tested.checker.check_edge(from, to, tested.scratch).verdict, Verdict::kFree);
      }
    }
  }
}

// A body on a line through the middle of a sphere of fine triangles, far smaller than the growth.
TEST(RobotSolidGrowth, TouchesWithinTheGrowth) {
  RobotModel robot("base");
  robot.add_link("slide", "base",
                 {.type = JointType::kPrismatic, .axis = {1, 0, 0}, .lower = -9, .upper = 9});
  robot.attach("slide", one_sphere_tree({0, 0, 0}, 1e-3));
  TriangleMesh mesh = icosphere(4);
  mesh.vertex_error = 0.5;
  for (const double offset : {0.0, 7.0}) {
    RobotScene scene(robot);
    scene.add("solid", std::make_shared<const SolidMesh>(mesh),
              Pose::from_translation({offset, 0, 0}));
    for (const InstructionSet set : instruction_sets()) {
      const RobotChecker checker = scene.snapshot({.instructions = set});
      RobotChecker::Scratch scratch(checker);
      for (const double at : {1.2, 1.3, 1.4, 1.45}) {
        const std::vector<double> from = {offset - at};
        const std::vector<double> to = {offset - at - 0.01};
        EXPECT_FALSE(checker.check_config(from, scratch)) << at;
        EXPECT_NE(checker.check_edge(from, to, scratch).verdict, Verdict::kFree) << at;
        const std::vector<double> many(16, offset - at);
        std::vector<std::uint8_t> free(16, 2);
        checker.check_configs(many, scratch, free);
        EXPECT_EQ(free, std::vector<std::uint8_t>(16, 0)) << at;
      }
      const std::vector<double> away = {offset - 1.6};
      EXPECT_TRUE(checker.check_config(away, scratch));
    }
  }
}

// Points that the canonical test finds in the solid, as near to it as it goes, are in the cover.
TEST(SolidSpheres, HoldWhatTheCanonicalTestFindsInside) {
  Random random(seeded(923));
  int inside = 0;
  for (int n = 0; n < 2 * kKinds; ++n) {
    TriangleMesh mesh = mesh_of_kind(n % kKinds);
    mesh.vertex_error = n < kKinds ? 0.0 : 0.02;
    const SolidMesh solid(mesh);
    const std::vector<Sphere> cover = internal::spheres_around(solid);
    for (int i = 0; i < scaled(300, 30); ++i) {
      const Eigen::Vector3d p = random.point(1.2);
      if (!collides(*one_sphere_tree(p, 0.0), Pose(), solid, Pose())) continue;
      ++inside;
      const auto holds = [&](const Sphere& s) { return (s.center - p).norm() <= s.radius; };
      ASSERT_TRUE(std::any_of(cover.begin(), cover.end(), holds)) << "kind " << n;
    }
  }
  EXPECT_GT(inside, effort(300, 20));
}

}  // namespace
}  // namespace spherule::test::robot_solid_lanes_test
