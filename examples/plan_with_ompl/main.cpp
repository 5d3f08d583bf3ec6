// SPDX-License-Identifier: BSD-3-Clause
// A planner of OMPL whose motions are proved free at every point (adapters/README.md): only the
// validity checker and the motion validator are spherule's.
#include <iostream>
#include <memory>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>
#include <spherule/adapters/ompl/validators.h>
#include <spherule/robot.h>
#include <vector>

namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

// A sphere that moves in a plane, and a wall across its way with a door at the side.
spherule::RobotChecker make_checker() {
  spherule::RobotModel robot;
  spherule::Joint rail{.name = "x",
                       .type = spherule::JointType::kPrismatic,
                       .axis = Eigen::Vector3d::UnitX(),
                       .lower = -1.0,
                       .upper = 1.0};
  robot.add_link("bridge", "base_link", rail);
  rail.name = "y";
  rail.axis = Eigen::Vector3d::UnitY();
  robot.add_link("sled", "bridge", rail);
  const std::vector<spherule::Sphere> sphere = {{{0.0, 0.0, 0.0}, 0.1}};
  robot.attach("sled", std::make_shared<const spherule::SphereTree>(spherule::build_tree(sphere)));
  spherule::RobotScene scene(robot);
  scene.add("wall", spherule::Primitive(spherule::Box{{0.01, 1.5, 1.0}}),
            spherule::Pose::from_translation({0.0, -0.25, 0.0}));
  return scene.snapshot();
}

}  // namespace

int main() {
  ompl::msg::setLogLevel(ompl::msg::LOG_WARN);
  ompl::RNG::setSeed(1);
  const spherule::RobotChecker checker = make_checker();
  const auto space = std::make_shared<ob::RealVectorStateSpace>(2);
  space->setBounds(-1.0, 1.0);
  const auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker(
      std::make_shared<spherule::StateValidityChecker>(information, checker));
  information->setMotionValidator(
      std::make_shared<spherule::MotionValidator>(information, checker));
  information->setup();

  ob::ScopedState<> start(space), goal(space);
  start = std::vector<double>{-0.5, -0.5};
  goal = std::vector<double>{0.5, -0.5};
  if (information->checkMotion(start.get(), goal.get())) return 1;  // through the wall
  const auto problem = std::make_shared<ob::ProblemDefinition>(information);
  problem->setStartAndGoalStates(start, goal);
  og::RRTConnect planner(information);
  planner.setProblemDefinition(problem);
  planner.setup();
  if (planner.solve(ob::timedPlannerTerminationCondition(10.0)) !=
      ob::PlannerStatus::EXACT_SOLUTION)
    return 2;
  const auto& path = *problem->getSolutionPath()->as<og::PathGeometric>();
  std::cout << "a path of " << path.getStateCount() << " states, every motion proved free\n";
  return path.check() ? 0 : 3;
}
