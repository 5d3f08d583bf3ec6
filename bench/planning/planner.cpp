// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/planner.h"

#include "adapters/ompl/motion_validator.h"
#include "adapters/ompl/state_validity_checker.h"
#include "bench/planning/joint_space.h"

#include <cstddef>
#include <memory>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <utility>

namespace spherule {
namespace {

namespace ob = ompl::base;

class SeededSampler : public ob::RealVectorStateSampler {
 public:
  SeededSampler(const ob::StateSpace* space, std::uint32_t seed)
      : ob::RealVectorStateSampler(space) {
    rng_.setLocalSeed(seed);
  }
};

}  // namespace

ob::StateSpacePtr make_joint_space(const RobotModel& robot, std::uint32_t seed, double step) {
  const auto joints = static_cast<unsigned>(robot.variable_count());
  const auto space = std::make_shared<ob::RealVectorStateSpace>(joints);
  ob::RealVectorBounds bounds(joints);
  for (std::size_t i = 0; i < joints; ++i) {
    const Joint& joint = robot.joints()[static_cast<std::size_t>(robot.variable_joints()[i])];
    bounds.low[i] = joint.lower;
    bounds.high[i] = joint.upper;
  }
  space->setBounds(bounds);
  space->setLongestValidSegmentFraction(step / space->getMaximumExtent());
  space->setStateSamplerAllocator([seed](const ob::StateSpace* sampled) {
    return std::make_shared<SeededSampler>(sampled, seed);
  });
  return space;
}

std::span<const double> positions_of(const ob::State* state, std::size_t joints) {
  return {state->as<ob::RealVectorStateSpace::StateType>()->values, joints};
}

namespace {

namespace ob = ompl::base;

class MeshValidity : public ob::StateValidityChecker {
 public:
  MeshValidity(const ob::SpaceInformationPtr& information, ContactTest meshes)
      : ob::StateValidityChecker(information), meshes_(std::move(meshes)) {}

  bool isValid(const ob::State* state) const override {
    return si_->satisfiesBounds(state) && !meshes_(positions_of(state, si_->getStateDimension()));
  }

 private:
  ContactTest meshes_;
};

class CountedValidity : public ob::StateValidityChecker {
 public:
  CountedValidity(const ob::SpaceInformationPtr& information, ob::StateValidityCheckerPtr counted)
      : ob::StateValidityChecker(information), counted_(std::move(counted)) {}

  bool isValid(const ob::State* state) const override {
    ++count_;
    return counted_->isValid(state);
  }

  std::size_t count() const { return count_; }
  void forget() { count_ = 0; }

 private:
  ob::StateValidityCheckerPtr counted_;
  mutable std::size_t count_ = 0;
};

std::shared_ptr<CountedValidity> set_validity(const PlanningEngines& engines, Validity validity,
                                              const ob::SpaceInformationPtr& information) {
  ob::StateValidityCheckerPtr states;
  if (validity == Validity::kMeshes) {
    states = std::make_shared<MeshValidity>(information, engines.meshes);
  } else {
    states = std::make_shared<StateValidityChecker>(information, engines.checker);
  }
  const auto counted = std::make_shared<CountedValidity>(information, std::move(states));
  information->setStateValidityChecker(counted);
  // Otherwise OMPL takes its own one, which samples.
  if (validity == Validity::kProved) {
    information->setMotionValidator(
        std::make_shared<MotionValidator>(information, engines.checker));
  }
  return counted;
}

ob::ScopedState<> state_of(const ob::StateSpacePtr& space, const Configuration& positions) {
  ob::ScopedState<> state(space);
  state = positions;
  return state;
}

}  // namespace

std::string name_of(Validity validity) {
  switch (validity) {
    case Validity::kProved:
      return "spherule-proved";
    case Validity::kSampled:
      return "spherule-sampled";
    case Validity::kMeshes:
      return "fcl-mesh-sampled";
  }
  return {};
}

Plan plan(const PlanningEngines& engines, Validity validity, const PlanningProblem& problem,
          const PlanOptions& options) {
  const ob::StateSpacePtr space =
      make_joint_space(engines.checker.robot(), options.seed, options.step);
  const auto information = std::make_shared<ob::SpaceInformation>(space);
  const auto states = set_validity(engines, validity, information);
  information->setup();
  const auto start = state_of(space, problem.start);
  const auto goal = state_of(space, problem.goal);
  Plan result;
  if (!information->isValid(start.get()) || !information->isValid(goal.get())) return result;

  const auto definition = std::make_shared<ob::ProblemDefinition>(information);
  definition->setStartAndGoalStates(start, goal);
  ompl::geometric::RRTConnect planner(information);
  planner.setProblemDefinition(definition);
  planner.setup();
  // The first query makes the memory that all others write to.
  information->checkMotion(start.get(), start.get());
  information->getMotionValidator()->resetMotionCounter();
  states->forget();
  const double begin = processor_seconds();
  std::uint64_t iterations = 0;
  PlanEnd stopped = PlanEnd::kIterations;
  const ob::PlannerStatus status = planner.solve(ob::PlannerTerminationCondition([&] {
    if (processor_seconds() - begin > options.most_seconds) stopped = PlanEnd::kSeconds;
    return stopped == PlanEnd::kSeconds || ++iterations > options.most_iterations;
  }));
  result.seconds = processor_seconds() - begin;
  result.state_checks = states->count();
  const auto& motions = *information->getMotionValidator();
  result.motion_checks = motions.getValidMotionCount() + motions.getInvalidMotionCount();
  const bool solved = status == ob::PlannerStatus::EXACT_SOLUTION;
  result.end = solved ? PlanEnd::kSolved : stopped;
  if (!solved) return result;
  const auto& path = *definition->getSolutionPath()->as<ompl::geometric::PathGeometric>();
  for (unsigned i = 0; i < path.getStateCount(); ++i) {
    const auto positions = positions_of(path.getState(i), information->getStateDimension());
    result.path.emplace_back(positions.begin(), positions.end());
  }
  return result;
}

}  // namespace spherule
