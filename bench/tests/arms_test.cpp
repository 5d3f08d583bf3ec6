// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/planning/problem_study.h"
#include "bench/robot_edges/arm.h"
#include "bench/robot_edges/arm_problems.h"
#include "bench/robot_edges/arm_scenes.h"
#include "bench/robot_edges/peer_arms.h"
#include "bench/studies/refined_cover.h"
#include "bench/tests/toy_arm.h"

#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <vector>

// Other libraries' checks of an arm: on the same convex links they say the same.
#if defined(SPHERULE_BENCH_BULLET)
#include "bench/robot_edges/bullet_arm.h"
#endif

namespace spherule {
namespace {

using Checkers = std::vector<std::unique_ptr<ArmChecker>>;

Checkers checkers_of(const Arm& arm, const ArmScene& scene) {
  const AllowedCollisions allowed(arm.model);
  Checkers checkers;
  for (const FclVolume volume : {FclVolume::kObbRss, FclVolume::kObb}) {
    checkers.push_back(std::make_unique<FclArm>(arm, allowed, scene, volume));
  }
#if defined(SPHERULE_BENCH_BULLET)
  for (const BulletLinks links : {BulletLinks::kHulls, BulletLinks::kGImpact}) {
    checkers.push_back(std::make_unique<BulletArm>(arm, allowed, scene, links));
  }
#endif
  return checkers;
}

// What they say of the arm alone and of each kind of obstacle alone, but where they may differ:
// within rounding of a contact, which is seldom, and where a link holds an obstacle.
void expect_agreement(const ArmScene& scene) {
  constexpr int kConfigurations = 2000;
  const Arm arm = test::make_toy_arm();
  const Checkers checkers = checkers_of(arm, scene);
  FclArm truth(arm, AllowedCollisions(arm.model), scene, FclVolume::kObbRss);
  RandomNumbers random(3);
  int contacts = 0;
  std::vector<int> differ(checkers.size());
  for (int i = 0; i < kConfigurations; ++i) {
    const Configuration at = random_configuration(arm.model, random);
    if (truth.holds_an_obstacle(at)) continue;
    const bool collides = truth.collides(at);
    contacts += collides ? 1 : 0;
    for (std::size_t k = 0; k < checkers.size(); ++k) {
      differ[k] += checkers[k]->collides(at) != collides ? 1 : 0;
    }
  }
  EXPECT_GT(contacts, 10);
  EXPECT_LT(contacts, kConfigurations - 10);
  for (std::size_t k = 0; k < checkers.size(); ++k) EXPECT_LE(differ[k], 2) << checkers[k]->name();
}

TEST(ArmCheckers, AgreeAboutTheArmItself) {
  expect_agreement({.name = "nothing"});
}

TEST(ArmCheckers, AgreeAboutEveryKindOfObstacle) {
  const ArmScene all = test::make_toy_scene();
  for (const PlacedPrimitive& obstacle : all.obstacles) {
    SCOPED_TRACE(obstacle.name);
    expect_agreement({.name = "primitive", .obstacles = {obstacle}});
  }
  expect_agreement({.name = "cloud", .cloud = all.cloud, .cloud_radius = all.cloud_radius});
  expect_agreement({.name = "mesh", .mesh = all.mesh});
  expect_agreement(all);
}

// Two bars with a gap, in which a sphere stands: only a hull fills it.
TEST(ArmCheckers, HullsFillGaps) {
  TriangleMesh bars = make_box({0.1, 0.05, 0.05});
  const auto corners = static_cast<int>(bars.vertices.size());
  for (int i = 0; i < corners; ++i) {
    Eigen::Vector3d& vertex = bars.vertices[static_cast<std::size_t>(i)];
    vertex.x() -= 0.3;
    bars.vertices.push_back(vertex + Eigen::Vector3d(0.6, 0.0, 0.0));
  }
  const std::size_t triangles = bars.triangles.size();
  for (std::size_t i = 0; i < triangles; ++i) {
    bars.triangles.push_back((bars.triangles[i].array() + corners).matrix());
  }
  const Arm arm = test::make_toy_arm(bars);
  ArmScene scene{.name = "ball"};
  scene.obstacles = {{"ball", SolidSphere{0.01}, Pose::from_translation({0.65, 0.5, 0.2})}};
  for (const auto& checker : checkers_of(arm, scene)) {
    EXPECT_EQ(checker->collides(Configuration{0.5, 0.5, 0.0}),
              std::string(checker->name()) == "Bullet hulls")
        << checker->name();
    EXPECT_TRUE(checker->collides(Configuration{0.4, 0.5, 0.0})) << checker->name();
  }
}

}  // namespace
}  // namespace spherule

// What planners are given in the scenes of an arm, and what becomes of it.

namespace spherule {
namespace {

struct ToyScene {
  Arm arm = test::make_toy_arm();
  AllowedCollisions allowed{arm.model};
  ArmScene scene = test::make_toy_scene();
  RobotChecker checker = robot_scene(arm, allowed, scene).snapshot();
  FclArm fcl{arm, allowed, scene, FclVolume::kObbRss};
  ContactTest in_contact = [this](std::span<const double> at) { return fcl.collides(at); };

  std::vector<PlanningProblem> problems(std::size_t count) {
    RandomNumbers random(5);
    return make_arm_problems(checker, fcl, count, random);
  }
};

TEST(ArmProblems, EndsAreFreeAndTheStraightMotionIsNot) {
  ToyScene toy;
  const auto problems = toy.problems(8);
  ASSERT_EQ(problems.size(), 8u);
  RobotChecker::Scratch scratch(toy.checker);
  for (const PlanningProblem& problem : problems) {
    for (const Configuration& end : {problem.start, problem.goal}) {
      EXPECT_TRUE(toy.checker.check_config(end, scratch));
      EXPECT_FALSE(toy.in_contact(end));
    }
    EXPECT_GT(check_path({problem.start, problem.goal}, toy.in_contact, 0.001).contacts, 0u);
  }
  EXPECT_EQ(toy.problems(8).back().goal, problems.back().goal);
}

TEST(ArmProblems, NoneWhereNothingIsInTheWay) {
  ToyScene toy;
  toy.allowed.allow_all();
  const RobotChecker checker = robot_scene(toy.arm, toy.allowed, {}).snapshot();
  FclArm fcl(toy.arm, toy.allowed, {}, FclVolume::kObb);
  RandomNumbers random(5);
  EXPECT_THROW(make_arm_problems(checker, fcl, 1, random), Error);
}

TEST(ArmProblems, ArePlannedWithoutContactsByProofs) {
  ToyScene toy;
  const auto problems = toy.problems(6);
  ProblemStudy study =
      study_problems({toy.checker, toy.in_contact}, toy.in_contact, problems, {}, 0.002);
  ASSERT_EQ(study.rows.size(), 3u);
  for (const ProblemRow& row : study.rows) {
    EXPECT_EQ(row.plans.size(), 6u);
    EXPECT_GT(row.ended(PlanEnd::kSolved), 0u) << name_of(row.validity);
  }
  EXPECT_EQ(study.rows.front().paths_in_contact(), 0u);
  ProblemStudy both;
  both.add(study);
  both.add(study);
  EXPECT_EQ(both.rows.back().plans.size(), 12u);
  EXPECT_EQ(both.rows.back().contacts.size(), 12u);
  EXPECT_EQ(both.rows.front().tested, 2 * study.rows.front().tested);
}

}  // namespace
}  // namespace spherule
