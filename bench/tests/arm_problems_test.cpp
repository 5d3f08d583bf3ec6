// SPDX-License-Identifier: BSD-3-Clause
// What planners are given in the scenes of an arm, and what becomes of it.
#include "bench/robot_edges/arm_problems.h"

#include "base/error.h"
#include "bench/planning/path_check.h"
#include "bench/planning/problem_study.h"
#include "bench/robot_edges/robot_scenes.h"
#include "bench/tests/toy_arm.h"

#include <gtest/gtest.h>

#include <span>
#include <vector>

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
