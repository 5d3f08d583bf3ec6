// SPDX-License-Identifier: BSD-3-Clause
// What planners are given, how their paths are examined again, and how they are compared.
#include "base/error.h"
#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/oracle.h"
#include "bench/planning/path_check.h"
#include "bench/planning/planning_cell.h"
#include "bench/planning/problem_study.h"
#include "bench/planning/problems.h"
#include "bench/planning/process_points.h"
#include "bench/scenes/torch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

namespace spherule::planning_problems_test {
namespace {

TEST(PlanningProblems, EndsAreFreeAndTheStraightMotionIsNot) {
  const Workload cell = make_paper_cell();
  const auto meshes = make_fcl_mesh_checker(cell, {});
  std::vector<ArmPositions> places =
      make_process_points(cell.robot, flange_from_wire(), 30, 12).configurations;
  // As many places in contact are there to be drawn.
  const auto in_contact =
      std::find_if(cell.program.begin(), cell.program.end(),
                   [&](const ArmPositions& positions) { return collides(*meshes, positions); });
  ASSERT_NE(in_contact, cell.program.end());
  places.insert(places.end(), places.size(), *in_contact);
  const auto problems = make_problems(cell, *meshes, places, 10);
  ASSERT_EQ(problems.size(), 10u);
  const auto positions_of = [](const Configuration& configuration) {
    ArmPositions positions;
    std::copy_n(configuration.begin(), kJoints, positions.begin());
    return positions;
  };
  const auto is_place = [&](const ArmPositions& positions) {
    return std::find(places.begin(), places.end(), positions) != places.end();
  };
  std::vector<ArmPositions> ends;
  std::set<ArmPositions> starts;
  for (std::size_t i = 0; i < problems.size(); ++i) {
    const ArmPositions start = positions_of(problems[i].start);
    const ArmPositions goal = positions_of(problems[i].goal);
    EXPECT_TRUE(is_place(start));
    EXPECT_EQ(goal == cell.program.front(), i % 2 == 0);
    EXPECT_EQ(is_place(goal), i % 2 == 1);
    ends.push_back(start);
    ends.push_back(goal);
    EXPECT_GT(
        check_path({problems[i].start, problems[i].goal}, contact_test(*meshes), 0.001).contacts,
        0u);
    starts.insert(start);
  }
  EXPECT_GT(starts.size(), problems.size() / 2);
  for (const std::uint32_t bits : Oracle(cell).touching_bodies(ends)) EXPECT_EQ(bits, 0u);
  EXPECT_THROW(make_problems(cell, *meshes, {}, 1), Error);
  EXPECT_THROW(make_problems(cell, *meshes, {&*in_contact, 1}, 1), Error);
}

TEST(PathCheck, StepsFinelyOverEveryCorner) {
  const std::vector<Configuration> path = {
      {0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 1.0, 0.0}, {-0.3, 1.0, 0.2}};
  // In contact where the second joint is in a thin slab.
  std::vector<Configuration> queried;
  const ContactTest slab = [&](std::span<const double> at) {
    queried.emplace_back(at.begin(), at.end());
    return at[1] > 0.5 && at[1] < 0.502;
  };
  const PathCheck check = check_path(path, slab, 1e-3);
  EXPECT_EQ(check.configurations, queried.size());
  EXPECT_NEAR(static_cast<double>(check.configurations), 1302.0, 2.0);
  EXPECT_GE(check.contacts, 1u);
  EXPECT_LE(check.contacts, 2u);
  for (const Configuration& corner : path) {
    EXPECT_NE(std::find(queried.begin(), queried.end(), corner), queried.end());
  }
  for (std::size_t i = 1; i < queried.size(); ++i) {
    for (std::size_t k = 0; k < queried[i].size(); ++k) {
      EXPECT_LE(std::abs(queried[i][k] - queried[i - 1][k]), 1e-3 + 1e-12);
    }
  }
  EXPECT_EQ(check_path({}, slab, 1e-3).configurations, 0u);
  EXPECT_EQ(check_path({Configuration{0.0, 0.501}}, slab, 1e-3).contacts, 1u);
}

TEST(ProblemStudy, ComparesWhatBothSolve) {
  const auto solved = [](double seconds) {
    return Plan{.end = PlanEnd::kSolved, .seconds = seconds};
  };
  const Plan refused{.end = PlanEnd::kEndsRefused};
  const Plan lost{.end = PlanEnd::kIterations, .seconds = 9.0};
  const ProblemRow ours{
      .plans = {solved(1.0), solved(2.0), refused, lost, solved(1.0), lost, solved(4.0)}};
  const ProblemRow meshes{
      .plans = {solved(10.0), solved(60.0), solved(1.0), solved(1.0), lost, lost, solved(4.0)}};
  const ProblemComparison found = compare(ours, meshes);
  EXPECT_EQ(found.both, 3u);
  EXPECT_EQ(found.mesh_only, 2u);
  EXPECT_EQ(found.refused, 1u);
  EXPECT_EQ(found.sphere_only, 1u);
  EXPECT_EQ(found.median_ratio, 10.0);
  EXPECT_EQ(found.total_ratio, 74.0 / 7.0);
  EXPECT_EQ(median_milliseconds(meshes), 4000.0);
  EXPECT_EQ(ours.ended(PlanEnd::kIterations), 2u);
  EXPECT_EQ(compare({}, {}).both, 0u);
}

}  // namespace
}  // namespace spherule::planning_problems_test
