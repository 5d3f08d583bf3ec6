// SPDX-License-Identifier: BSD-3-Clause
// The bounds of speeds and accelerations as the kernels compute them, in lanes and in both
// precisions, against the same formula for one path at a time.

#include "collide/kernels/compiled_plan.h"
#include "collide/kernels/plan_kernels.h"
#include "robot/check/body_pairs.h"
#include "robot/check/plan_source.h"
#include "robot/model/joint_positions.h"
#include "tests/robot/path_bounds.h"
#include "tests/robot/robots.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

namespace spherule::test::plan_bounds_test {
namespace {

using internal::kPlanLanes;

// A motion of one unit of time, by the robot's joints.
struct JointMotion {
  std::vector<double> rates;
  std::vector<double> shifts;
};

JointMotion motion_of(const RobotModel& robot, const std::vector<double>& from,
                      const std::vector<double>& to) {
  JointMotion motion;
  for (const Joint& joint : robot.joints()) {
    const double first = joint.moves() ? joint.position(from) : 0.0;
    const double last = joint.moves() ? joint.position(to) : 0.0;
    motion.rates.push_back(std::abs(last - first));
    motion.shifts.push_back(std::max(std::abs(first), std::abs(last)));
  }
  return motion;
}

// Not less than the formula gives, and no more than rounding may add.
template <class Real>
void expect_bounds(const internal::PlanMotionBound<Real>& found, const PathBounds& formula) {
  const double slack = std::is_same_v<Real, float> ? 1e-4 : 1e-12;
  EXPECT_GE(static_cast<double>(found.speed), formula.speed * (1.0 - 1e-14));
  EXPECT_LE(static_cast<double>(found.speed), formula.speed * (1.0 + slack));
  EXPECT_GE(static_cast<double>(found.bend), formula.bend * (1.0 - 1e-14));
  EXPECT_LE(static_cast<double>(found.bend), formula.bend * (1.0 + slack));
}

// Evaluates the motion as a whole. How many bounds of pairs were compared.
template <class Real>
int check_bounds(const internal::BodyPairs& pairs, InstructionSet set,
                 const std::vector<double>& from, const std::vector<double>& to) {
  const internal::RobotPlanSource made = make_plan_source(pairs, pairs.pairs().size());
  const internal::CompiledPlan<Real> compiled(made.source);
  internal::PlanMemory<Real> memory(compiled);
  const internal::PlanScratch<Real>& scratch = memory.view();
  const internal::CheckPlan<Real>& plan = compiled.plan();

  const JointPositions positions(pairs.robot());
  JointPositions::Scratch places = positions.scratch_for(2);
  const auto first = positions.of(from, places, 0);
  const auto last = positions.of(to, places, 1);
  for (std::size_t p = 0; p < first.size(); ++p) {
    const double largest = std::max(std::abs(first[p]), std::abs(last[p]));
    const double rate = std::abs(last[p] - first[p]);
    const auto up = [](double x) {
      return std::nextafter(static_cast<Real>(x), std::numeric_limits<Real>::infinity());
    };
    scratch.from[p] = first[p];
    scratch.to[p] = last[p];
    scratch.rates[p] = static_cast<Real>(last[p] - first[p]);
    scratch.speeds[p] = up(rate);
    scratch.shifts[p] = up(largest);
    *scratch.total_speed += up(rate);
  }
  std::fill_n(scratch.has_bounds, plan.bound_count, false);

  std::vector<std::uint64_t> near(static_cast<std::size_t>(plan.word_count) * kPlanLanes);
  internal::PlanParts parts;
  std::fill_n(parts.middle, kPlanLanes, 0.5);
  std::fill_n(parts.half, kPlanLanes, 0.5);
  parts.lanes = (1U << kPlanLanes) - 1;
  parts.near = near.data();
  parts.all_contacts = true;
  const internal::PlanClient client{
      .touches = [](void*, int, std::int32_t) { return false; },
      .near = [](void*, std::int32_t, unsigned lanes, double) { return lanes; },
      .is_proved_free = [](void*, int, std::int32_t) { return false; },
      .is_motion_proved = [](void*, std::int32_t) { return false; },
      .proved_parts = [](void*, std::int32_t, unsigned) { return 0U; },
      .context = nullptr,
      .skips_never = false};
  const internal::PlanKernelSet& kernels = internal::plan_kernels_for(set);
  if constexpr (std::is_same_v<Real, float>) {
    kernels.evaluate_float(plan, scratch, parts, client);
  } else {
    kernels.evaluate_double(plan, scratch, parts, client);
  }

  const auto [rates, shifts] = motion_of(pairs.robot(), from, to);
  for (std::size_t body = 0; body < pairs.pieces().size(); ++body) {
    expect_bounds(scratch.body_bounds[body],
                  path_bounds(pairs.path_to_root(body), false, rates, shifts));
  }
  int compared = 0;
  for (std::int32_t i = 0; i < plan.pair_count; ++i) {
    if (!scratch.has_bounds[1 + i / kPlanLanes]) continue;
    const auto test = static_cast<std::size_t>(compiled.source_test(plan.first_pair + i));
    expect_bounds(scratch.pair_bounds[i],
                  path_bounds(pairs.path(made.pair_of_test[test]), true, rates, shifts));
    ++compared;
  }
  return compared;
}

TEST(PlanBounds, AreThoseOfTheFormula) {
  Random random(391);
  int compared = 0;
  const int cases = effort(300, 40);
  for (int n = 0; n < cases; ++n) {
    RobotModel robot = random_robot(random, random.whole(2, 9), n % 2 == 0);
    if (n % 3 == 0) add_random_mimics(random, robot, 1.0);
    std::vector<internal::CheckedPiece> pieces;
    std::vector<internal::CheckedPair> tested;
    for (int link = 0; link < static_cast<int>(robot.links().size()); ++link) {
      pieces.push_back(
          {.tree = one_sphere_tree(random.point(0.5), random.between(0.1, 1.0)), .link = link});
      for (int other = 0; other < link; ++other) tested.push_back({link, other, false});
    }
    const std::size_t count = tested.size();
    const internal::BodyPairs pairs(robot, Pose(), pieces, {}, tested, count);
    const std::vector<double> from = random_configuration(random, robot, 2.0);
    std::vector<double> to = random_configuration(random, robot, 2.0);
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
    for (const InstructionSet set : instruction_sets()) {
      compared += check_bounds<float>(pairs, set, from, to);
      compared += check_bounds<double>(pairs, set, from, to);
      ASSERT_FALSE(HasFailure()) << n;
    }
  }
  EXPECT_GT(compared, 10 * cases);
}

}  // namespace
}  // namespace spherule::test::plan_bounds_test
