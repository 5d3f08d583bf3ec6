// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Validity of OMPL's motions, proved at every point of them.
//
// @code{.cpp}
// #include <spherule/adapters/ompl/motion_validator.h>
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
// const spherule::MotionValidator validator(information, scene.snapshot());
// ompl::base::ScopedState<> left(space), right(space);
// left = std::vector<double>{-0.5};
// right = std::vector<double>{0.5};
// assert(validator.checkMotion(left.get(), left.get()));
// assert(!validator.checkMotion(left.get(), right.get()));  // the stop is in between
// @endcode

#include "adapters/ompl/robot_states.h"
#include "collide/sweep.h"

#include <algorithm>
#include <atomic>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <utility>

namespace spherule {

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
