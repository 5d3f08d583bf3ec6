// SPDX-License-Identifier: BSD-3-Clause
#include "collide/kernels/compiled_plan.h"
#include "collide/kernels/plan_kernels.h"
#include "collide/kernels/plan_trees.h"
#include "robot/check/body_pairs.h"
#include "robot/check/plan_source.h"
#include "robot/model/joint_positions.h"
#include "tests/robot/check/checked.h"
#include "tests/robot/path_bounds.h"
#include "tests/robot/robots.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <vector>

// Cells of joint positions in which two bodies are apart, against the gaps of all their spheres.

namespace spherule::test::free_cells_test {
namespace {

using internal::FreeCells;
using internal::FreeCellsSource;
using internal::SearchTrees;

std::shared_ptr<const SearchTrees> trees_of(const std::vector<Sphere>& spheres) {
  return std::make_shared<const SearchTrees>(spheres);
}

FreeCellsSource::Joint random_joint(Random& random, int position) {
  FreeCellsSource::Joint joint{random.pose(0.5), random.whole(0, 3) > 0, position};
  const double span = joint.turns ? 1.0 : 0.2;
  joint.lower = random.between(-3.2, 0.0) * span;
  joint.upper = joint.lower + random.between(0.0, 6.4) * span;
  if (random.whole(0, 9) == 0) joint.upper = joint.lower;
  if (random.whole(0, 9) == 0) joint.upper = joint.lower + 12.6 * span;
  return joint;
}

// One or two joints, on either side.
FreeCellsSource random_source(Random& random) {
  FreeCellsSource source;
  const int joints = random.whole(1, 2);
  for (int i = 0; i < joints; ++i) {
    FreeCellsSource::Side& side = random.whole(0, 1) == 0 ? source.first : source.second;
    side.chain.push_back(random_joint(random, i));
  }
  for (FreeCellsSource::Side* side : {&source.first, &source.second}) {
    side->trees = trees_of(random_spheres(random, random.whole(1, 30), 0.3, 0.1));
    side->frame_from_trees = random.pose(0.4);
  }
  source.margin = random.whole(0, 1) * 1e-3;
  return source;
}

Eigen::Isometry3d pose_of(const FreeCellsSource::Side& side, const std::vector<double>& positions) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  for (const FreeCellsSource::Joint& joint : side.chain) {
    const double at = positions[static_cast<std::size_t>(joint.position)];
    result = result * joint.parent_from_frame.isometry();
    if (joint.turns) {
      result.rotate(Eigen::AngleAxisd(at, Eigen::Vector3d::UnitZ()));
    } else {
      result.translate(at * Eigen::Vector3d::UnitZ());
    }
  }
  return result * side.frame_from_trees.isometry();
}

// Of the nearest two spheres.
double gap(const FreeCellsSource& source, const std::vector<double>& positions) {
  const Eigen::Isometry3d first = pose_of(source.first, positions);
  const Eigen::Isometry3d second = pose_of(source.second, positions);
  double least = std::numeric_limits<double>::infinity();
  for (const Sphere& a : source.first.trees->narrow.spheres()) {
    for (const Sphere& b : source.second.trees->narrow.spheres()) {
      least = std::min(least, (first * a.center - second * b.center).norm() - a.radius - b.radius);
    }
  }
  return least;
}

bool is_free(const FreeCells& cells, const std::vector<double>& positions) {
  int coordinates[2];
  for (std::size_t k = 0; k < 2; ++k) {
    const FreeCells::Axis& axis = cells.axes()[k];
    const double at =
        (positions[static_cast<std::size_t>(axis.position)] - axis.lower) * axis.scale;
    if (!(at >= 0.0 && at < FreeCells::kCells)) return false;
    coordinates[k] = static_cast<int>(at);
  }
  return (cells.words()[static_cast<std::size_t>(coordinates[1])] >> coordinates[0] & 1U) != 0;
}

// Anywhere in the intervals, or at a border between two cells: there the bound is least slack.
std::vector<double> random_positions(Random& random, const FreeCellsSource& source,
                                     const FreeCells& cells) {
  std::vector<double> positions(2, 0.0);
  for (const FreeCellsSource::Side* side : {&source.first, &source.second}) {
    for (const FreeCellsSource::Joint& joint : side->chain) {
      double& at = positions[static_cast<std::size_t>(joint.position)];
      at = random.between(joint.lower, joint.upper);
      for (const FreeCells::Axis& axis : cells.axes()) {
        if (axis.position != joint.position || axis.scale == 0.0 || random.whole(0, 1) == 0) {
          continue;
        }
        at = axis.lower + random.whole(0, FreeCells::kCells) / axis.scale;
        at = std::clamp(at + random.whole(-1, 1) * 1e-15, joint.lower, joint.upper);
      }
    }
  }
  return positions;
}

TEST(FreeCells, HoldNoPositionsAtWhichSpheresAreNear) {
  Random random(seeded(77));
  int checked = 0;
  int far = 0;
  int far_and_free = 0;
  for (int round = 0; round < scaled(300, 60); ++round) {
    const FreeCellsSource source = random_source(random);
    const std::shared_ptr<const FreeCells> cells = FreeCells::of(source);
    if (cells == nullptr) continue;
    for (int i = 0; i < 400; ++i) {
      const std::vector<double> positions = random_positions(random, source, *cells);
      const double exact = gap(source, positions);
      const bool free = is_free(*cells, positions);
      if (free) {
        ASSERT_GT(exact, source.margin) << "round " << round;
      }
      checked += free ? 1 : 0;
      far += exact > 0.1 ? 1 : 0;
      far_and_free += exact > 0.1 && free ? 1 : 0;
    }
  }
  EXPECT_GT(checked, effort(20000, 4000));
  EXPECT_GT(far_and_free, far / 10 * 9);
}

TEST(FreeCells, AreKeptForTheSameTreesAndJoints) {
  Random random(seeded(6));
  internal::FreeCellsCache cache;
  FreeCellsSource source;
  source.first.trees = trees_of({{Eigen::Vector3d::Zero(), 0.1}});
  source.second.trees = trees_of({{Eigen::Vector3d::UnitX(), 0.1}});
  source.second.chain = {{Pose(), true, 0, -1.0, 1.0}};
  const std::shared_ptr<const FreeCells> cells = cache.of(source);
  ASSERT_NE(cells, nullptr);
  EXPECT_EQ(cache.of(source), cells);
  FreeCellsSource other = source;
  other.second.chain[0].upper = 2.0;
  EXPECT_NE(cache.of(other), cells);
  other = source;
  other.second.frame_from_trees = Pose::from_translation({-1.0, 0.0, 0.0});
  EXPECT_EQ(cache.of(other), nullptr);
  other = source;
  other.second.trees = trees_of({{Eigen::Vector3d::Zero(), 0.1}});
  EXPECT_EQ(cache.of(other), nullptr);
  EXPECT_EQ(cache.of(source), cells);
}

}  // namespace
}  // namespace spherule::test::free_cells_test

// The bounds of speeds and accelerations as the kernels compute them, in lanes and in both
// precisions, against the same formula for one path at a time.

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
  const internal::RobotPlanSource made = make_plan_source(pairs);
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
    const Configuration to = moved(random_configuration(random, robot, 2.0), from);
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
