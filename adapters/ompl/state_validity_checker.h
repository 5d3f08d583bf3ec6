// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Validity of OMPL's states by a RobotChecker.
//
// @code{.cpp}
// #include <spherule/adapters/ompl/state_validity_checker.h>
// #include <spherule/robot/check/robot_scene.h>
// #include <spherule/spheretree/build.h>
// #include <ompl/base/ScopedState.h>
// #include <cassert>
//
// const std::vector<spherule::Sphere> spheres{{{0, 0, 0}, 0.1}};
// const auto sphere = std::make_shared<const spherule::SphereTree>(spherule::build_tree(spheres));
// spherule::RobotModel robot("base");
// robot.add_link("sled", "base", {.name = "rail", .type = spherule::JointType::kPrismatic,
//                                 .axis = {1, 0, 0}, .lower = -1, .upper = 1});
// robot.attach("sled", sphere);
// spherule::RobotScene scene(robot);
// scene.add("stop", sphere);
// const auto space = std::make_shared<ompl::base::RealVectorStateSpace>(1);
// space->setBounds(-1, 1);
// const auto information = std::make_shared<ompl::base::SpaceInformation>(space);
// information->setStateValidityChecker(
//     std::make_shared<spherule::StateValidityChecker>(information, scene.snapshot()));
// information->setup();
// ompl::base::ScopedState<> state(space);
// state = std::vector<double>{0.5};
// assert(information->isValid(state.get()));
// state = std::vector<double>{0.1};
// assert(!information->isValid(state.get()));
// @endcode

#include "adapters/ompl/robot_states.h"

#include <limits>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>
#include <utility>

namespace spherule {

// A state is valid if it is within the bounds of its space and the robot's checker finds it free:
// of obstacles and of itself, certainly (G4). Threads may share it.
class StateValidityChecker : public ompl::base::StateValidityChecker {
 public:
  // Throws Error as RobotStates does. OMPL's base class keeps a plain pointer to `information`,
  // which must outlive this.
  StateValidityChecker(const ompl::base::SpaceInformationPtr& information, RobotChecker checker)
      : ompl::base::StateValidityChecker(information),
        states_(std::move(checker), information->getStateSpace()) {
    specs_.clearanceComputationType = ompl::base::StateValidityCheckerSpecs::BOUNDED_APPROXIMATE;
  }

  using ompl::base::StateValidityChecker::clearance;
  using ompl::base::StateValidityChecker::isValid;

  // True if the state lies within the bounds and is free.
  bool isValid(const ompl::base::State* state) const override {
    if (!si_->satisfiesBounds(state)) return false;
    const RobotStates::Loan loan(states_);
    auto& [scratch, configuration, unused] = *loan;
    states_.read(state, configuration);
    return states_.checker().check_config(configuration, scratch);
  }

  // A lower bound of the gap, in metres of the robot's world and not in the measure of the space,
  // to the nearest contact; 0 where there is one. Bounds of the space are not queried. Infinite if
  // nothing is tested.
  double clearance(const ompl::base::State* state) const override {
    const RobotStates::Loan loan(states_);
    auto& [scratch, configuration, unused] = *loan;
    states_.read(state, configuration);
    return states_.checker().clearance(configuration, scratch).lower;
  }

 private:
  RobotStates states_;
};

}  // namespace spherule
