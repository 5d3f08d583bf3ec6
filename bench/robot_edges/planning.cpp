// SPDX-License-Identifier: BSD-3-Clause
#include "bench/robot_edges/planning.h"

#include "adapters/ompl/validators.h"
#include "base/error.h"
#include "bench/robot_edges/arm.h"
#include "bench/studies/measure.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <span>
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

// The robot's joints between their limits, in radians. `seed` alone decides what its samplers draw.
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

// Of this process so far: what is timed by it runs on one thread, and what else the machine does
// hardly shows.
double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

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

void set_validity(const PlanningEngines& engines, Validity validity,
                  const ob::SpaceInformationPtr& information) {
  if (validity == Validity::kMeshes) {
    information->setStateValidityChecker(
        std::make_shared<MeshValidity>(information, engines.meshes));
  } else {
    information->setStateValidityChecker(
        std::make_shared<StateValidityChecker>(information, engines.checker));
  }
  // Otherwise OMPL takes its own one, which samples.
  if (validity == Validity::kProved) {
    information->setMotionValidator(
        std::make_shared<MotionValidator>(information, engines.checker));
  }
}

ob::ScopedState<> state_of(const ob::StateSpacePtr& space, const Configuration& positions) {
  ob::ScopedState<> state(space);
  state = positions;
  return state;
}

}  // namespace

Plan plan(const PlanningEngines& engines, Validity validity, const PlanningProblem& problem,
          const PlanOptions& options) {
  const ob::StateSpacePtr space =
      make_joint_space(engines.checker.robot(), options.seed, options.step);
  const auto information = std::make_shared<ob::SpaceInformation>(space);
  set_validity(engines, validity, information);
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
  const double begin = processor_seconds();
  std::uint64_t iterations = 0;
  const ob::PlannerStatus status = planner.solve(ob::PlannerTerminationCondition([&] {
    return processor_seconds() - begin > options.most_seconds ||
           ++iterations > options.most_iterations;
  }));
  result.seconds = processor_seconds() - begin;
  if (status != ob::PlannerStatus::EXACT_SOLUTION) return result;
  const auto& path = *definition->getSolutionPath()->as<ompl::geometric::PathGeometric>();
  for (unsigned i = 0; i < path.getStateCount(); ++i) {
    const auto positions = positions_of(path.getState(i), information->getStateDimension());
    result.path.emplace_back(positions.begin(), positions.end());
  }
  return result;
}

PathCheck check_path(const std::vector<Configuration>& path, const ContactTest& in_contact,
                     double step) {
  PathCheck result;
  const auto test = [&](const Configuration& at) {
    ++result.configurations;
    result.contacts += in_contact(at) ? 1 : 0;
  };
  if (!path.empty()) test(path.front());
  Configuration at;
  for (std::size_t i = 1; i < path.size(); ++i) {
    double most = 0.0;
    for (std::size_t k = 0; k < path[i].size(); ++k) {
      most = std::max(most, std::abs(path[i][k] - path[i - 1][k]));
    }
    const auto steps = std::max(1, static_cast<int>(std::ceil(most / step)));
    at.resize(path[i].size());
    for (int s = 1; s <= steps; ++s) {
      const double t = static_cast<double>(s) / steps;
      for (std::size_t k = 0; k < at.size(); ++k) {
        at[k] = (1.0 - t) * path[i - 1][k] + t * path[i][k];
      }
      test(at);
    }
  }
  return result;
}

namespace {

constexpr int kTries = 5000;    // for one problem
constexpr double kStep = 0.01;  // radians
constexpr double kTick = 1e-6;  // of the processor's clock, seconds

// Whether its ends are free and the straight motion between them is not, at configurations that are
// queried.
bool needs_a_plan(const PlanningProblem& problem, const ContactTest& in_contact) {
  return !in_contact(problem.start) && !in_contact(problem.goal) &&
         check_path({problem.start, problem.goal}, in_contact, kStep).contacts > 0;
}

}  // namespace

std::vector<PlanningProblem> make_arm_problems(const RobotChecker& checker, FclArm& fcl,
                                               std::size_t count, RandomNumbers& random) {
  RobotChecker::Scratch scratch(checker);
  const auto is_end = [&](const Configuration& at) {
    return checker.check_config(at, scratch) && !fcl.holds_an_obstacle(at);
  };
  const ContactTest in_contact = [&](std::span<const double> at) { return fcl.collides(at); };
  std::vector<PlanningProblem> problems;
  for (int tries = 0; problems.size() < count; ++tries) {
    if (tries == kTries) throw Error("problems", "hardly any motion needs a plan");
    PlanningProblem problem{random_configuration(checker.robot(), random),
                            random_configuration(checker.robot(), random)};
    if (!is_end(problem.start) || !is_end(problem.goal)) continue;
    if (!needs_a_plan(problem, in_contact)) continue;
    problems.push_back(std::move(problem));
    tries = 0;
  }
  return problems;
}

double ProblemRow::median_milliseconds() const {
  std::vector<double> times;
  for (const Plan& plan : plans) {
    if (plan.is_solved()) times.push_back(1e3 * plan.seconds);
  }
  return median(std::move(times));
}

TimeRatios compare(const ProblemRow& row, const ProblemRow& other) {
  std::vector<double> ratios;
  double ours = 0.0;
  double theirs = 0.0;
  for (std::size_t i = 0; i < row.plans.size(); ++i) {
    if (!row.plans[i].is_solved() || !other.plans[i].is_solved()) continue;
    ratios.push_back(other.plans[i].seconds / std::max(row.plans[i].seconds, kTick));
    ours += row.plans[i].seconds;
    theirs += other.plans[i].seconds;
  }
  return {median(std::move(ratios)), theirs / std::max(ours, kTick)};
}

std::vector<ProblemRow> study_problems(const PlanningEngines& engines, const ContactTest& judge,
                                       const std::vector<PlanningProblem>& problems,
                                       const PlanOptions& options, double recheck_step) {
  std::vector<ProblemRow> rows{{Validity::kProved}, {Validity::kSampled}, {Validity::kMeshes}};
  for (std::size_t i = 0; i < problems.size(); ++i) {
    PlanOptions one = options;
    one.seed += static_cast<std::uint32_t>(i);
    for (ProblemRow& row : rows) {
      const Plan& made = row.plans.emplace_back(plan(engines, row.validity, problems[i], one));
      row.solved += made.is_solved() ? 1 : 0;
      row.in_contact += check_path(made.path, judge, recheck_step).contacts > 0 ? 1 : 0;
    }
  }
  return rows;
}

void append(std::vector<ProblemRow>& rows, const std::vector<ProblemRow>& more) {
  rows.resize(more.size());
  for (std::size_t i = 0; i < more.size(); ++i) {
    rows[i].validity = more[i].validity;
    rows[i].plans.insert(rows[i].plans.end(), more[i].plans.begin(), more[i].plans.end());
    rows[i].solved += more[i].solved;
    rows[i].in_contact += more[i].in_contact;
  }
}

}  // namespace spherule
