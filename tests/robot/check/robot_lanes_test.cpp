// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/solid_mesh.h"
#include "collide/meshes/spheres_inside.h"
#include "robot/check/robot_checker.h"
#include "robot/check/robot_scene.h"
#include "spheretree/build.h"
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
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// RobotChecker's fast check, configurations and motions in lanes, on every instruction set, against
// explain(), which makes all canonical tests one by one.

namespace spherule::test::robot_lanes_test {
namespace {

Primitive random_primitive(Random& random, double size) {
  const auto length = [&] { return random.between(0.01, 1.0) * size; };
  switch (random.whole(0, 4)) {
    case 0:
      return Box{{length(), length(), length()}};
    case 1:
      return SolidSphere{length()};
    case 2:
      return Cylinder{length(), length()};
    case 3:
      return Capsule{length(), random.whole(0, 9) < 2 ? 0.0 : length()};
    default:
      return HalfSpace{};
  }
}

// A random scene among solids of every kind; some are tiny, some huge.
RandomScene scene_with_solids(Random& random) {
  RandomScene result = random_scene(random);
  const int count = random.whole(0, 5);
  for (int i = 0; i < count; ++i) {
    const double size = random.whole(0, 9) < 1 ? 100.0 : random.whole(0, 9) < 1 ? 1e-3 : 0.3;
    const Primitive solid = random_primitive(random, size);
    const double away = std::holds_alternative<HalfSpace>(solid) ? 4.0 : 3.0 + size;
    result.scene.add("solid_" + std::to_string(i), solid, random.pose(away));
  }
  return result;
}

// A checker for each instruction set, and the canonical answer.
class Checkers {
 public:
  explicit Checkers(const RobotScene& scene) {
    for (const InstructionSet set : instruction_sets()) {
      checkers_.push_back(scene.snapshot({.instructions = set}));
      scratches_.emplace_back(checkers_.back());
    }
  }

  std::size_t count() const { return checkers_.size(); }
  const RobotChecker& checker(std::size_t i) const { return checkers_[i]; }
  RobotChecker::Scratch& scratch(std::size_t i) { return scratches_[i]; }
  bool is_free(const std::vector<double>& q) {
    return checkers_.front().explain(q, scratches_.front()).empty();
  }

 private:
  std::vector<RobotChecker> checkers_;
  std::vector<RobotChecker::Scratch> scratches_;
};

// Moves `free` and `touching` together until nothing lies between them.
void close_in(Checkers& checkers, std::vector<double>& free, std::vector<double>& touching) {
  for (int i = 0; i < 60; ++i) {
    std::vector<double> middle;
    for (std::size_t k = 0; k < free.size(); ++k) {
      middle.push_back(0.5 * free[k] + 0.5 * touching[k]);
    }
    (checkers.is_free(middle) ? free : touching) = middle;
  }
}

void expect_same_answers(Checkers& checkers, const std::vector<std::vector<double>>& tested) {
  std::vector<double> all;
  std::vector<std::uint8_t> truth;
  for (const std::vector<double>& q : tested) {
    all.insert(all.end(), q.begin(), q.end());
    truth.push_back(checkers.is_free(q) ? 1 : 0);
  }
  for (std::size_t i = 0; i < checkers.count(); ++i) {
    std::vector<std::uint8_t> free(tested.size(), 2);
    checkers.checker(i).check_configs(all, checkers.scratch(i), free);
    ASSERT_EQ(free, truth) << "batch, instruction set " << i;
    for (std::size_t k = 0; k < tested.size(); ++k) {
      ASSERT_EQ(checkers.checker(i).check_config(tested[k], checkers.scratch(i)), truth[k] != 0)
          << "one configuration, instruction set " << i;
    }
  }
}

TEST(RobotLanes, VerdictsAreThoseOfTheCanonicalTestsToTheLastDigit) {
  Random random(seeded(911));
  int close = 0;
  for (int n = 0; n < scaled(120, 12); ++n) {
    const auto [scene, oracle] = scene_with_solids(random);
    Checkers checkers(scene);
    std::vector<std::vector<double>> tested;
    const int count = random.whole(1, 19);
    for (int i = 0; i < count; ++i) {
      tested.push_back(random_configuration(random, oracle.robot, 3.0));
    }
    const auto is_free = [&](const std::vector<double>& q) { return checkers.is_free(q); };
    const auto first_free = std::find_if(tested.begin(), tested.end(), is_free);
    const auto first_touching = std::find_if_not(tested.begin(), tested.end(), is_free);
    if (first_free != tested.end() && first_touching != tested.end()) {
      std::vector<double> free = *first_free;
      std::vector<double> touching = *first_touching;
      close_in(checkers, free, touching);
      tested.push_back(free);
      tested.push_back(touching);
      ++close;
    }
    expect_same_answers(checkers, tested);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(close, effort(40, 2));
}

// What is called free has no contact at many configurations, on any instruction set; where a
// contact is reported there is one; and no two instruction sets contradict each other.
TEST(RobotLanes, MotionsAreProvedOnEveryInstructionSet) {
  Random random(seeded(912));
  int free = 0;
  int hits = 0;
  for (int n = 0; n < scaled(100, 10); ++n) {
    const auto [scene, oracle] = scene_with_solids(random);
    Checkers checkers(scene);
    for (int i = 0; i < 4; ++i) {
      const std::vector<double> from = random_configuration(random, oracle.robot, 3.0);
      std::vector<double> to = from;
      const double length = std::exp(random.between(std::log(1e-3), std::log(3.0)));
      for (double& position : to) position += random.between(-length, length);
      const EdgeRequest request{.first = random.whole(0, 9) < 3};
      for (std::size_t k = 0; k < checkers.count(); ++k) {
        const EdgeResult result =
            checkers.checker(k).check_edge(from, to, checkers.scratch(k), request);
        (result.verdict == Verdict::kFree ? free : hits) += 1;
        const auto at = [&](double t) {
          std::vector<double> q;
          for (std::size_t p = 0; p < from.size(); ++p) {
            q.push_back((1.0 - t) * from[p] + t * to[p]);
          }
          return q;
        };
        const double until = result.verdict == Verdict::kFree ? 1.0 : result.free_until;
        for (int step = 0; step <= effort(60, 20); ++step) {
          const double t = until * step / effort(60, 20) * (until < 1.0 ? 1.0 - 1e-12 : 1.0);
          if (until == 0.0) break;
          ASSERT_TRUE(checkers.is_free(at(t))) << "at " << t << " of " << until;
        }
        if (result.verdict == Verdict::kCollision) {
          ASSERT_FALSE(checkers.is_free(at(result.contact_at)));
        }
      }
    }
  }
  EXPECT_GT(free, effort(200, 10));
  EXPECT_GT(hits, effort(100, 5));
}

std::shared_ptr<const SphereTree> spheres_at(std::vector<Eigen::Vector3d> centers, double radius) {
  std::vector<Sphere> spheres;
  for (const Eigen::Vector3d& center : centers) spheres.push_back({center, radius});
  return std::make_shared<const SphereTree>(build_tree(spheres));
}

Joint turning(double limit = 4.0) {
  return {.type = JointType::kRevolute, .lower = -limit, .upper = limit};
}

// Bodies that no obstacle is near move, too.
TEST(RobotLanes, PairsWithoutObstaclesAreNotPassed) {
  RobotModel robot("base");
  robot.add_link("mid", "base", turning());
  robot.add_link("arm", "mid", turning());
  robot.attach("base", spheres_at({{0, 1, 0}}, 0.01));
  robot.attach("mid", spheres_at({{0, 0, 5}}, 0.01));
  robot.attach("arm", spheres_at({{1, 0, 0}}, 0.01));
  Checkers checkers{RobotScene(robot)};
  for (std::size_t i = 0; i < checkers.count(); ++i) {
    const EdgeResult result = checkers.checker(i).check_edge(
        std::vector<double>{0.02, 0.0}, std::vector<double>{3.0, 0.0}, checkers.scratch(i));
    EXPECT_EQ(result.verdict, Verdict::kCollision);
  }
}

// An obstacle as far away as the robot reaches, to the last digits of single precision, does not
// change which tests single precision leaves to double precision.
TEST(RobotLanes, WhatIsJustOutOfReachHidesNothing) {
  RobotModel robot("base");
  robot.add_link("arm", "base", turning());
  robot.attach("arm", spheres_at({{1, 0, 0}}, 0.1));
  for (int i = -40; i <= 40; ++i) {
    RobotScene scene(robot);
    scene.add("a", Primitive(Box{{1, 1, 1}}),
              Pose::from_translation({2.7 * (1.0 + i * 2e-7), 0, 0}));
    scene.add("b", Primitive(SolidSphere{0.1}), Pose::from_translation({0, 1.2 - 1e-6, 0}));
    Checkers checkers(scene);
    const double middle = 1.5707963267948966;
    const EdgeResult result = checkers.checker(0).check_edge(
        std::vector<double>{middle - 0.7}, std::vector<double>{middle + 1.1}, checkers.scratch(0));
    EXPECT_NE(result.verdict, Verdict::kFree);
  }
}

TEST(RobotLanes, ANeedleOfACylinderIsNoContact) {
  RobotModel robot("base");
  robot.add_link("arm", "base", turning());
  robot.attach("arm", spheres_at({{0, 0, 10}, {0, 0, -10}}, 0.1));
  RobotScene scene(robot);
  scene.add("needle", Primitive(Cylinder{1e-50, 1.0}));
  Checkers checkers(scene);
  expect_same_answers(checkers, {{0.0}, {0.5}, {1.0}});
}

// Rigid pairs that rounding decides have the answers of each configuration.
TEST(RobotLanes, RigidPairsAtRoundingsDistance) {
  RobotModel robot("base");
  robot.add_link("arm", "base", turning());
  robot.add_link("tip", "arm", {.type = JointType::kFixed});
  robot.attach("arm", spheres_at({{0.5, 0, 0}}, 0.1));
  robot.attach("tip", spheres_at({{0.7 + 3.5e-15, 0, 0}}, 0.1));
  RobotScene scene(robot);
  AllowedCollisions allowed(robot);
  allowed.forbid("arm", "tip");
  scene.set_allowed_collisions(allowed);
  Checkers checkers(scene);
  Random random(seeded(913));
  std::vector<std::vector<double>> tested;
  for (int i = 0; i < 50; ++i) tested.push_back({random.between(-3.0, 3.0)});
  expect_same_answers(checkers, tested);
  const EdgeResult result =
      checkers.checker(0).check_edge(tested[0], tested[1], checkers.scratch(0));
  EXPECT_NE(result.verdict, Verdict::kFree);
}

}  // namespace
}  // namespace spherule::test::robot_lanes_test

// Solid meshes among the obstacles of a RobotChecker: configurations and motions in lanes, on every
// instruction set, against explain(), which makes all canonical tests one by one.

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
