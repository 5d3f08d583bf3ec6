// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// A RobotChecker for OMPL's planners: StateValidityChecker, and MotionValidator, whose motions are
// proved free at every point. Beneath them RobotStates, the states of OMPL's spaces as
// configurations.
//
// @code{.cpp}
// #include <spherule/adapters/ompl/validators.h>
// #include <spherule/robot/check/robot_scene.h>
// #include <ompl/base/ScopedState.h>
// #include <cassert>
//
// spherule::RobotModel robot("base");
// robot.add_link("sled", "base", {.name = "rail", .type = spherule::JointType::kPrismatic,
//                                 .axis = {1, 0, 0}, .lower = -1, .upper = 1});
// const auto space = std::make_shared<ompl::base::RealVectorStateSpace>(1);
// space->setBounds(-1, 1);
// const spherule::RobotStates states(spherule::RobotScene(robot).snapshot(), space);
// ompl::base::ScopedState<> state(space);
// state = std::vector<double>{0.5};
// std::vector<double> configuration;
// states.read(state.get(), configuration);
// assert(configuration == std::vector<double>{0.5});
// @endcode

#include "base/error.h"
#include "collide/sweep.h"
#include "robot/check/robot_checker.h"
#include "robot/model/kinematics.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <numbers>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateSpace.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SO2StateSpace.h>
#include <string>
#include <utility>
#include <vector>

namespace spherule {

// The states of a space of OMPL as configurations of a robot, and what queries about them write to,
// lent to one thread at a time.
//
// The space is a RealVectorStateSpace, an SO2StateSpace (for a joint that turns), or a compound of
// these and of such compounds. Their numbers, in their order, are those of a configuration. Motions
// between states are those of these spaces' interpolate(): straight in real numbers, those of a
// continuous joint included, and by the shorter way round in SO2, where half a turn goes as given;
// from a number beyond the bounds of SO2 one turn at most is taken off, as interpolate() does.
// A class of the user's own that overrides interpolate() is not seen as such; its motions are not
// those that are answered for.
class RobotStates {
 public:
  // Throws Error for a space of another kind, if it has not as many numbers as the robot has
  // variables, and for a number of SO2 whose turn by 2 pi is not the same pose: one that moves a
  // joint that does not turn, or that mimics with a multiplier that is no integer.
  RobotStates(RobotChecker checker, ompl::base::StateSpacePtr space)
      : checker_(std::move(checker)), space_(std::move(space)) {
    if (!space_) throw Error("state space", "there is none");
    list_turns(*space_);
    const auto variables = static_cast<std::size_t>(checker_.robot().variable_count());
    if (turns_.size() != variables) {
      throw Error("state space", "it has " + std::to_string(turns_.size()) +
                                     " numbers, the robot has " + std::to_string(variables) +
                                     " variables");
    }
    for (const Joint& joint : checker_.robot().joints()) {
      if (!joint.moves() || turns_[static_cast<std::size_t>(joint.variable)] == 0) continue;
      if (is_periodic(joint)) continue;
      throw Error("state space", "a number of SO2 moves joint " + joint.name +
                                     ", for which a turn by 2 pi is not the same pose: use a real "
                                     "one");
    }
  }

  // The snapshot that the states are checked with.
  const RobotChecker& checker() const { return checker_; }

  // What one query writes to.
  struct Scratch {
    // For this checker and its copies.
    explicit Scratch(const RobotChecker& checker) : of_checker(checker) {}

    RobotChecker::Scratch of_checker;
    std::vector<double> from;
    std::vector<double> to;
  };

  // Gives the scratch back when it ends. The last one given back is the first to be lent again, so
  // that a lone thread keeps what that remembers.
  class Loan {
   public:
    // Takes one that is free, or makes one, and gives it back at the end.
    explicit Loan(const RobotStates& lender) : lender_(lender), scratch_(lender.take()) {}
    ~Loan() { lender_.give_back(std::move(scratch_)); }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;

    // The scratch lent.
    Scratch& operator*() const { return *scratch_; }

   private:
    const RobotStates& lender_;
    std::unique_ptr<Scratch> scratch_;
  };

  // The configuration of a state, in the order of the robot's variables.
  void read(const ompl::base::State* state, std::vector<double>& configuration) const {
    configuration.clear();
    append(*space_, state, configuration);
  }

  // The end of a motion from `from`, such that the straight way to it is the motion's: of SO2,
  // where it is more than half a turn away, one turn less, as interpolate() has it. Within the
  // bounds that is nearest_turn(). Checks charge its rounding, which is less than kTurnError.
  void read_end(const ompl::base::State* state, const std::vector<double>& from,
                std::vector<double>& to) const {
    read(state, to);
    for (std::size_t i = 0; i < to.size(); ++i) {
      const double step = to[i] - from[i];
      if (turns_[i] == 0 || std::abs(step) <= std::numbers::pi) continue;
      to[i] -= std::copysign(2.0 * std::numbers::pi, step);
    }
  }

 private:
  // A space that is derived from one of these may move in another way: one that does not say so by
  // its type cannot be told, one that does (SE2 of cars) is refused.
  void list_turns(const ompl::base::StateSpace& space) {
    using namespace ompl::base;
    const int type = space.getType();
    const auto* compound = dynamic_cast<const CompoundStateSpace*>(&space);
    if (type == STATE_SPACE_REAL_VECTOR && dynamic_cast<const RealVectorStateSpace*>(&space)) {
      turns_.insert(turns_.end(), space.getDimension(), std::uint8_t{0});
    } else if (type == STATE_SPACE_SO2 && dynamic_cast<const SO2StateSpace*>(&space)) {
      turns_.push_back(1);
    } else if (type == STATE_SPACE_UNKNOWN && compound) {
      for (unsigned i = 0; i < compound->getSubspaceCount(); ++i) {
        list_turns(*compound->getSubspace(i));
      }
    } else {
      throw Error("state space", "'" + space.getName() + "' is neither real, SO2 nor of these");
    }
  }

  static void append(const ompl::base::StateSpace& space, const ompl::base::State* state,
                     std::vector<double>& configuration) {
    if (space.getType() == ompl::base::STATE_SPACE_REAL_VECTOR) {
      const double* values = state->as<ompl::base::RealVectorStateSpace::StateType>()->values;
      configuration.insert(configuration.end(), values, values + space.getDimension());
    } else if (space.getType() == ompl::base::STATE_SPACE_SO2) {
      configuration.push_back(state->as<ompl::base::SO2StateSpace::StateType>()->value);
    } else {
      const auto& compound = *space.as<ompl::base::CompoundStateSpace>();
      const auto* parts = state->as<ompl::base::CompoundState>();
      for (unsigned i = 0; i < compound.getSubspaceCount(); ++i) {
        append(*compound.getSubspace(i), parts->components[i], configuration);
      }
    }
  }

  std::unique_ptr<Scratch> take() const {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<Scratch> scratch = std::move(idle_.back());
        idle_.pop_back();
        return scratch;
      }
    }
    return std::make_unique<Scratch>(checker_);
  }

  void give_back(std::unique_ptr<Scratch> scratch) const {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(scratch));
  }

  RobotChecker checker_;
  ompl::base::StateSpacePtr space_;
  std::vector<std::uint8_t> turns_;  // 1 for a number of SO2
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Scratch>> idle_;
};

// Validity of OMPL's states by a RobotChecker.
//
// @code{.cpp}
// #include <spherule/spheretree/sphere_tree.h>
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

// Validity of OMPL's motions, proved at every point of them.
//
// @code{.cpp}
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
// const spherule::MotionValidator validator(information, scene.snapshot());
// ompl::base::ScopedState<> left(space), right(space);
// left = std::vector<double>{-0.5};
// right = std::vector<double>{0.5};
// assert(validator.checkMotion(left.get(), left.get()));
// assert(!validator.checkMotion(left.get(), right.get()));  // the stop is in between
// @endcode

// A motion is valid only if it is proved free at every point of it, its ends included (G6): there
// is no step width, and setStateValidityCheckingResolution() changes nothing. What is not proved at
// the resolution of the request is not valid. A motion whose end is out of the bounds of the space
// is not valid. Threads may share it.
//
// The motion is the one of the space's interpolate(): a number of SO2 goes the shorter way, over pi
// where that is shorter; a real number goes straight, that of a continuous joint, too: from 3 to
// -3 rad back through 0. `continuous` of the request is not used.
class MotionValidator : public ompl::base::MotionValidator {
 public:
  // Throws Error as RobotStates and require_resolution() do. OMPL's base class keeps a plain
  // pointer to `information`, which must outlive this.
  MotionValidator(const ompl::base::SpaceInformationPtr& information, RobotChecker checker,
                  const EdgeRequest& request = {})
      : ompl::base::MotionValidator(information),
        states_(std::move(checker), information->getStateSpace()),
        request_(request) {
    require_resolution(request.resolution);
    request_.continuous = ContinuousMotion::kAsGiven;  // the ends are taken from the space
  }

  // True if the motion is proved free and its end lies within the bounds.
  bool checkMotion(const ompl::base::State* s1, const ompl::base::State* s2) const override {
    return count(si_->satisfiesBounds(s2) && check(s1, s2, request_).verdict == Verdict::kFree);
  }

  // If the motion is not valid, lastValid.second is a fraction up to which it is proved free, hence
  // not beyond the first contact, and lastValid.first, where it is not null, is the state there,
  // which is found free as well; s1 and 0 if nothing is proved.
  bool checkMotion(const ompl::base::State* s1, const ompl::base::State* s2,
                   std::pair<ompl::base::State*, double>& lastValid) const override {
    double free_until = 0.0;
    if (si_->satisfiesBounds(s2)) {
      EdgeRequest request = request_;
      request.first = true;
      const EdgeResult result = check(s1, s2, request);
      if (result.verdict == Verdict::kFree) return count(true);
      free_until = result.free_until;
    }
    lastValid.second = last_valid(s1, s2, free_until, lastValid.first);
    return count(false);
  }

 private:
  EdgeResult check(const ompl::base::State* s1, const ompl::base::State* s2,
                   const EdgeRequest& request) const {
    const RobotStates::Loan loan(states_);
    auto& [scratch, from, to] = *loan;
    states_.read(s1, from);
    states_.read_end(s2, from, to);
    return states_.checker().check_edge(from, to, scratch, request);
  }

  // What is proved ends before `free_until`, and a state is rounded: so it is checked itself, and
  // one before it if it is not free.
  double last_valid(const ompl::base::State* s1, const ompl::base::State* s2, double free_until,
                    ompl::base::State* state) const {
    constexpr double kStep = 1e-6;
    constexpr int kTries = 8;
    ompl::base::State* const tried = state ? state : si_->allocState();
    double fraction = std::min(free_until, 1.0);
    for (int i = 0; i < kTries && fraction > 0.0; ++i) {
      si_->getStateSpace()->interpolate(s1, s2, fraction, tried);
      if (is_free(tried)) break;
      fraction = i + 1 < kTries ? std::max(0.0, fraction - kStep * (1 << (2 * i))) : 0.0;
    }
    if (!(fraction > 0.0)) si_->copyState(tried, s1);
    if (!state) si_->freeState(tried);
    return fraction;
  }

  bool is_free(const ompl::base::State* state) const {
    const RobotStates::Loan loan(states_);
    auto& [scratch, configuration, unused] = *loan;
    states_.read(state, configuration);
    return states_.checker().check_config(configuration, scratch);
  }

  bool count(bool valid) const {
    std::atomic_ref(valid ? valid_ : invalid_).fetch_add(1, std::memory_order_relaxed);
    return valid;
  }

  RobotStates states_;
  EdgeRequest request_;
};

}  // namespace spherule
