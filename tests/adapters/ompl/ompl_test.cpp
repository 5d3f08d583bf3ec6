// SPDX-License-Identifier: BSD-3-Clause
// The validity of states and motions for OMPL, against trigonometry, and a planner that uses them.
#include "adapters/ompl/validators.h"
#include "base/error.h"
#include "robot/check/robot_scene.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <barrier>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/base/spaces/SO3StateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace spherule {
namespace {

namespace ob = ompl::base;

using Configuration = std::vector<double>;

constexpr double kRounding = 1e-9;

constexpr int kArmJoints = 3;
constexpr double kLength = 0.5;
constexpr double kSphere = 0.05;
constexpr int kSpheres = 11;
constexpr double kWallSphere = 0.06;
constexpr double kWallBegin = 0.95, kWallStep = 0.08;
constexpr int kWallSpheres = 9;

std::shared_ptr<const SphereTree> row(double begin, double step, int count, double radius) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < count; ++i) spheres.push_back({{begin + step * i, 0.0, 0.0}, radius});
  return std::make_shared<const SphereTree>(build_tree(spheres));
}

// Three links of 0.5 m in the plane, turning about z, the first without limits, made of spheres of
// 0.05 m, and a wall of spheres along x that leaves it a gap at its base. Links meet each other
// only where a joint is turned beyond +-1.5.
RobotChecker planar_arm() {
  RobotModel robot("base");
  std::string parent = "base";
  for (int i = 0; i < kArmJoints; ++i) {
    Joint joint;
    joint.name = "joint_" + std::to_string(i);
    joint.type = i == 0 ? JointType::kContinuous : JointType::kRevolute;
    joint.parent_from_joint = Pose::from_translation({i == 0 ? 0.0 : kLength, 0.0, 0.0});
    joint.lower = -std::numbers::pi;
    joint.upper = std::numbers::pi;
    const std::string link = "link_" + std::to_string(i);
    robot.add_link(link, parent, joint);
    robot.attach(link, row(0.0, kLength / (kSpheres - 1), kSpheres, kSphere));
    parent = link;
  }
  RobotScene scene(robot);
  scene.add("wall", row(kWallBegin, kWallStep, kWallSpheres, kWallSphere));
  return scene.snapshot();
}

// The smallest gap between any sphere of the arm and of the wall, by trigonometry; below zero where
// they overlap.
double planar_arm_gap(std::span<const double> configuration) {
  double gap = std::numeric_limits<double>::infinity();
  double x = 0.0, y = 0.0, angle = 0.0;
  for (const double turn : configuration) {
    angle += turn;
    for (int i = 0; i < kSpheres; ++i) {
      const double along = kLength * i / (kSpheres - 1);
      for (int k = 0; k < kWallSpheres; ++k) {
        const double dx = x + along * std::cos(angle) - (kWallBegin + kWallStep * k);
        const double dy = y + along * std::sin(angle);
        gap = std::min(gap, std::hypot(dx, dy) - kSphere - kWallSphere);
      }
    }
    x += kLength * std::cos(angle);
    y += kLength * std::sin(angle);
  }
  return gap;
}

// With its joints in R^3, or the first in SO2.
struct Planning {
  explicit Planning(bool first_turns = false, const EdgeRequest& request = {}, double bound = 1.5) {
    ompl::msg::noOutputHandler();
    ob::StateSpacePtr space = joints(first_turns ? 2 : 3, bound);
    if (first_turns) {
      space = std::make_shared<ob::SO2StateSpace>() + space;
    }
    information = std::make_shared<ob::SpaceInformation>(space);
    const RobotChecker arm = planar_arm();
    states = std::make_shared<StateValidityChecker>(information, arm);
    motions = std::make_shared<MotionValidator>(information, arm, request);
    information->setStateValidityChecker(states);
    information->setMotionValidator(motions);
    information->setup();
  }

  static ob::StateSpacePtr joints(unsigned count, double bound = 1.5) {
    auto space = std::make_shared<ob::RealVectorStateSpace>(count);
    space->setBounds(-bound, bound);
    return space;
  }

  ob::ScopedState<> state(const Configuration& configuration) const {
    ob::ScopedState<> state(information->getStateSpace());
    state = configuration;
    return state;
  }

  Configuration configuration(const ob::State* state) const {
    Configuration values;
    information->getStateSpace()->copyToReals(values, state);
    return values;
  }

  double gap(const ob::State* state) const { return planar_arm_gap(configuration(state)); }

  // The smallest fraction of so many at which the arm intersects the wall, above 1 if none does.
  double first_contact(const ob::State* s1, const ob::State* s2, int steps) const {
    ob::ScopedState<> at(information->getStateSpace());
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      information->getStateSpace()->interpolate(s1, s2, t, at.get());
      if (gap(at.get()) <= -kRounding) return t;
    }
    return 2.0;
  }

  ob::SpaceInformationPtr information;
  std::shared_ptr<StateValidityChecker> states;
  std::shared_ptr<MotionValidator> motions;
};

Configuration random_configuration(test::Random& random, double first = 1.5) {
  return {random.between(-first, first), random.between(-1.5, 1.5), random.between(-1.5, 1.5)};
}

TEST(OmplStates, ValidAndClearanceAreThoseOfTheGap) {
  const Planning planning;
  EXPECT_EQ(planning.states->getSpecs().clearanceComputationType,
            ob::StateValidityCheckerSpecs::BOUNDED_APPROXIMATE);
  test::Random random(1);
  int valid = 0;
  const int cases = test::effort(5000, 300);
  for (int i = 0; i < cases; ++i) {
    const Configuration q = random_configuration(random);
    const auto state = planning.state(q);
    const double gap = planar_arm_gap(q);
    double clearance = -1.0;
    EXPECT_EQ(planning.states->isValid(state.get(), clearance), gap > 0.0);
    EXPECT_EQ(clearance, planning.states->clearance(state.get()));
    EXPECT_GE(clearance, 0.0);
    EXPECT_LE(clearance, std::max(0.0, gap) + kRounding);
    valid += gap > 0.0;
  }
  EXPECT_GT(valid, cases / 10);
  EXPECT_LT(valid, cases * 9 / 10);
  EXPECT_FALSE(planning.states->isValid(planning.state({1.6, 1.0, 0.0}).get()));
  EXPECT_TRUE(planning.states->isValid(planning.state({1.4, 1.0, 0.0}).get()));
}

void expect_motions_so(const Planning& planning, double first, std::uint64_t seed) {
  test::Random random(seed);
  unsigned valid = 0, invalid = 0;
  const ob::StateSpacePtr& space = planning.information->getStateSpace();
  for (int i = 0; i < test::effort(200, 20); ++i) {
    const auto s1 = planning.state(random_configuration(random, first));
    const auto s2 = planning.state(random_configuration(random, first));
    if (!planning.states->isValid(s1.get())) continue;
    const double contact = planning.first_contact(s1.get(), s2.get(), test::effort(500, 200));
    ob::ScopedState<> last(space), at(space);
    last = Configuration{9.0, 9.0, 9.0};
    std::pair<ob::State*, double> last_valid(last.get(), 7.0);
    const bool is_valid = planning.motions->checkMotion(s1.get(), s2.get(), last_valid);
    EXPECT_EQ(planning.motions->checkMotion(s1.get(), s2.get()), is_valid);
    std::pair<ob::State*, double> only_time(nullptr, 7.0);
    EXPECT_EQ(planning.motions->checkMotion(s1.get(), s2.get(), only_time), is_valid);
    EXPECT_EQ(only_time.second, last_valid.second);
    (is_valid ? valid : invalid) += 3;
    if (is_valid) {
      EXPECT_GT(contact, 1.0);
      EXPECT_EQ(last_valid.second, 7.0);
      EXPECT_EQ(planning.configuration(last.get())[1], 9.0);
      continue;
    }
    EXPECT_GE(last_valid.second, 0.0);
    EXPECT_LE(last_valid.second, contact);
    EXPECT_LT(last_valid.second, 1.0);
    space->interpolate(s1.get(), s2.get(), last_valid.second, at.get());
    EXPECT_EQ(planning.configuration(last.get()), planning.configuration(at.get()));
    EXPECT_TRUE(planning.states->isValid(last.get()));
    // Not far from where contact is: the wall is closer there than the arm can get in 1 % of the
    // way.
    EXPECT_LT(planning.gap(last.get()), 0.15);
  }
  EXPECT_EQ(planning.motions->getValidMotionCount(), valid);
  EXPECT_EQ(planning.motions->getInvalidMotionCount(), invalid);
  EXPECT_GT(valid, static_cast<unsigned>(test::effort(30, 3)));
  EXPECT_GT(invalid, static_cast<unsigned>(test::effort(30, 3)));
}

TEST(OmplMotions, LastValidIsProvedFree) {
  expect_motions_so(Planning(), 1.5, 2);
}

// A continuous joint turns the shorter way round.
TEST(OmplMotions, ContinuousJointsTurnTheShorterWay) {
  const Planning planning(true);
  expect_motions_so(planning, std::numbers::pi, 3);
  const auto behind = planning.state({3.0, 0.0, 0.0}), beyond = planning.state({-3.0, 0.0, 0.0});
  EXPECT_TRUE(planning.motions->checkMotion(behind.get(), beyond.get()));
  const auto left = planning.state({1.0, 0.0, 0.0}), right = planning.state({-1.0, 0.0, 0.0});
  EXPECT_FALSE(planning.motions->checkMotion(left.get(), right.get()));
}

// OMPL's interpolate() takes one turn off, however far beyond the bounds a motion begins: from 7 to
// -3 it turns back through 0, where the wall is. By the shorter way it would not.
TEST(OmplMotions, BeyondTheBoundsTheyAreStillThoseOfTheSpace) {
  const Planning planning(true);
  test::Random random(8);
  int free = 0, touching = 0;
  for (int i = 0; i < test::effort(2000, 100); ++i) {
    const auto s1 = planning.state(random_configuration(random, 30.0));
    const auto s2 = planning.state(random_configuration(random, std::numbers::pi));
    const double contact = planning.first_contact(s1.get(), s2.get(), test::effort(500, 200));
    const bool is_free = planning.motions->checkMotion(s1.get(), s2.get());
    EXPECT_FALSE(is_free && contact <= 1.0) << planning.configuration(s1.get())[0];
    (contact > 1.0 ? free : touching) += 1;
  }
  EXPECT_GT(free, 0);
  EXPECT_GT(touching, 0);
  const auto turned = planning.state({7.0, 0.0, 0.0}), end = planning.state({-3.0, 0.0, 0.0});
  EXPECT_LE(planning.first_contact(turned.get(), end.get(), 500), 1.0);
  EXPECT_FALSE(planning.motions->checkMotion(turned.get(), end.get()));
}

// Of real numbers it goes straight, whatever ContinuousMotion says, because that is how the space
// moves.
TEST(OmplMotions, RealNumbersGoStraight) {
  const Planning planning(false, {.continuous = ContinuousMotion::kShortest}, 4.0);
  const auto behind = planning.state({3.0, 0.0, 0.0}), beyond = planning.state({-3.0, 0.0, 0.0});
  EXPECT_LE(planning.first_contact(behind.get(), beyond.get(), 500), 1.0);
  EXPECT_FALSE(planning.motions->checkMotion(behind.get(), beyond.get()));
}

// The straight way between the configurations that are checked is that of OMPL's interpolate(), up
// to whole turns and rounding: at its ends, at half a turn, and near it.
TEST(OmplStates, MotionsAreThoseOfTheSpace) {
  const auto space = std::make_shared<ob::SO2StateSpace>() + Planning::joints(2);
  space->setup();
  const RobotStates states(planar_arm(), space);
  constexpr double kPi = std::numbers::pi;
  test::Random random(7);
  int over_the_ends = 0;
  for (int i = 0; i < test::effort(20000, 2000); ++i) {
    ob::ScopedState<> s1(space), s2(space), at(space);
    Configuration q1 = random_configuration(random, kPi);
    Configuration q2 = random_configuration(random, kPi);
    if (i % 4 == 0) q2[0] = q1[0] - std::copysign(kPi, q1[0]) + (i % 3 - 1) * 4.5e-16;
    if (i % 4 == 1) q1[0] = -kPi, q2[0] = i % 8 == 1 ? std::nextafter(kPi, 0.0) : 0.0;
    if (i % 4 == 2) q1[0] *= 3.0;  // beyond the bounds
    s1 = q1;
    s2 = q2;
    Configuration from, to;
    states.read(s1.get(), from);
    states.read_end(s2.get(), from, to);
    over_the_ends += to[0] != q2[0];
    for (int k = 0; k <= 8; ++k) {
      const double t = k / 8.0;
      space->interpolate(s1.get(), s2.get(), t, at.get());
      Configuration of_ompl;
      space->copyToReals(of_ompl, at.get());
      const double straight = from[0] + t * (to[0] - from[0]);
      ASSERT_NEAR(std::remainder(straight - of_ompl[0], 2.0 * kPi), 0.0, 4e-15)
          << q1[0] << ' ' << q2[0];
      for (int j = 1; j < 3; ++j) {
        ASSERT_NEAR(from[j] + t * (to[j] - from[j]), of_ompl[j], 1e-15);
      }
    }
  }
  EXPECT_GT(over_the_ends, test::effort(3000, 300));
}

TEST(OmplMotions, OutOfBoundsOrInContactIsNotValid) {
  const Planning planning;
  const auto free = planning.state({1.4, 1.0, 0.0}), outside = planning.state({1.6, 1.0, 0.0});
  const auto touching = planning.state({0.0, 0.0, 0.0});
  ob::ScopedState<> last(planning.information->getStateSpace());
  std::pair<ob::State*, double> last_valid(last.get(), 7.0);
  EXPECT_FALSE(planning.motions->checkMotion(free.get(), outside.get()));
  EXPECT_FALSE(planning.motions->checkMotion(free.get(), outside.get(), last_valid));
  EXPECT_EQ(last_valid.second, 0.0);
  EXPECT_EQ(planning.configuration(last.get()), planning.configuration(free.get()));
  EXPECT_FALSE(planning.motions->checkMotion(touching.get(), free.get(), last_valid));
  EXPECT_EQ(last_valid.second, 0.0);
  EXPECT_EQ(planning.configuration(last.get()), planning.configuration(touching.get()));
}

// Below and above the wall; every point of what the planner finds is examined.
TEST(OmplPlanning, FindsAWayThroughTheGap) {
  ompl::RNG::setSeed(1);
  const Planning planning;
  const auto start = planning.state({0.8, 0.0, 0.0}), goal = planning.state({-0.8, 0.0, 0.0});
  EXPECT_FALSE(planning.motions->checkMotion(start.get(), goal.get()));
  auto problem = std::make_shared<ob::ProblemDefinition>(planning.information);
  problem->setStartAndGoalStates(start, goal);
  auto planner = std::make_shared<ompl::geometric::RRTConnect>(planning.information);
  planner->setProblemDefinition(problem);
  planner->setup();
  ob::IterationTerminationCondition enough(100000);
  ASSERT_EQ(planner->solve(enough), ob::PlannerStatus::EXACT_SOLUTION);
  const auto& path = *problem->getSolutionPath()->as<ompl::geometric::PathGeometric>();
  ASSERT_GT(path.getStateCount(), 2u);
  EXPECT_EQ(planning.configuration(path.getState(0)), planning.configuration(start.get()));
  for (std::size_t i = 1; i < path.getStateCount(); ++i) {
    EXPECT_GT(
        planning.first_contact(path.getState(static_cast<unsigned>(i - 1)),
                               path.getState(static_cast<unsigned>(i)), test::effort(5000, 300)),
        1.0);
  }
}

TEST(OmplThreads, AnswerAsOne) {
  const Planning planning;
  test::Random random(5);
  std::vector<ob::ScopedState<>> states;
  for (int i = 0; i < test::effort(600, 60); ++i) {
    states.push_back(planning.state(random_configuration(random)));
  }
  struct Answers {
    std::vector<char> valid, motion;
    std::vector<double> clearance;
    bool operator==(const Answers&) const = default;
  };
  const auto query = [&] {
    Answers answers;
    for (std::size_t i = 0; i < states.size(); ++i) {
      const ob::State* s1 = states[i].get();
      const ob::State* s2 = states[(i + 1) % states.size()].get();
      answers.valid.push_back(planning.states->isValid(s1));
      answers.motion.push_back(planning.motions->checkMotion(s1, s2));
      if (i % 8 == 0) answers.clearance.push_back(planning.states->clearance(s1));
    }
    return answers;
  };
  const Answers expected = query();
  planning.motions->resetMotionCounter();
  constexpr std::size_t kThreads = 4;
  const auto rounds = static_cast<std::size_t>(test::effort(20, 3));
  std::vector<std::size_t> equal(kThreads, 0);
  std::vector<std::thread> threads;
  std::barrier together(kThreads);
  for (std::size_t& mine : equal) {
    threads.emplace_back([&] {
      together.arrive_and_wait();
      for (std::size_t round = 0; round < rounds; ++round) mine += query() == expected;
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::size_t mine : equal) EXPECT_EQ(mine, rounds);
  EXPECT_EQ(planning.motions->getCheckedMotionCount(), kThreads * rounds * states.size());
}

TEST(OmplStates, SpacesThatAreNotTheRobotsAreErrors) {
  const RobotChecker arm = planar_arm();
  const auto expect_error = [&](const ob::StateSpacePtr& space) {
    const auto information = std::make_shared<ob::SpaceInformation>(space);
    EXPECT_THROW(StateValidityChecker(information, arm), Error);
    EXPECT_THROW(MotionValidator(information, arm), Error);
  };
  expect_error(Planning::joints(2));
  expect_error(Planning::joints(4));
  expect_error(std::make_shared<ob::SE2StateSpace>());  // three numbers, but cars move otherwise
  expect_error(std::make_shared<ob::SO3StateSpace>());
  expect_error(Planning::joints(2) + std::make_shared<ob::SO3StateSpace>());
  const auto information = std::make_shared<ob::SpaceInformation>(Planning::joints(3));
  EXPECT_THROW(MotionValidator(information, arm, {.resolution = 0.0}), Error);
}

// One turn more of an SO2 variable is the same pose only where every joint that it moves turns, by
// a whole multiple.
TEST(OmplStates, WhatHasNoPeriodOfATurnIsNotOfSO2) {
  const auto refuses = [](JointType leader, JointType follower, double multiplier) {
    RobotModel robot("base");
    robot.add_link("wheel", "base", {.name = "lead", .type = leader, .lower = -3.0, .upper = 3.0});
    robot.add_link("arm", "base",
                   {.name = "follow", .type = follower, .lower = -3.0, .upper = 3.0});
    robot.mimic("follow", "lead", multiplier, 0.25);
    const RobotChecker checker = RobotScene(robot).snapshot();
    const auto real = std::make_shared<ob::SpaceInformation>(Planning::joints(1));
    EXPECT_NO_THROW(MotionValidator(real, checker));
    const auto information =
        std::make_shared<ob::SpaceInformation>(std::make_shared<ob::SO2StateSpace>());
    try {
      MotionValidator(information, checker);
      return false;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("joint"), std::string::npos);
    }
    EXPECT_THROW(StateValidityChecker(information, checker), Error);
    return true;
  };
  constexpr JointType kTurns = JointType::kContinuous, kSlides = JointType::kPrismatic;
  EXPECT_FALSE(refuses(kTurns, kTurns, -2.0));
  EXPECT_FALSE(refuses(kTurns, JointType::kRevolute, 1.0));
  EXPECT_TRUE(refuses(kTurns, kTurns, 0.5));
  EXPECT_TRUE(refuses(kTurns, JointType::kRevolute, 2.0 + 1e-15));
  EXPECT_TRUE(refuses(kTurns, kSlides, 1.0));
  EXPECT_TRUE(refuses(kSlides, kTurns, 1.0));
}

}  // namespace
}  // namespace spherule
