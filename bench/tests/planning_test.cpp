// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/checkers/tree_checker.h"
#include "bench/checkers/workload.h"
#include "bench/planning/planner.h"
#include "bench/planning/problem_study.h"
#include "bench/planning/problems.h"
#include "bench/planning/process_study.h"
#include "bench/scenes/program.h"
#include "bench/scenes/work_cell_parts.h"
#include "bench/tests/surface_spheres.h"
#include "robot/model/kinematics.h"
#include "tests/support/effort.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <set>
#include <vector>

// A tool that has to go around a post, planned with each way of checking.

namespace spherule {
namespace {

const Configuration kLeft{0.6, 0.0, 0.0, 0.0, 0.5, 0.0};
const Configuration kAtPost{0.0, 0.0, 0.0, 0.0, 0.5, 0.0};
const Configuration kRight{-0.6, 0.0, 0.0, 0.0, 0.5, 0.0};

// A side of the post goes through the tool in kAtPost.
Workload make_post_cell() {
  Workload cell{.name = "post", .robot = make_robot()};
  cell.bodies.push_back({{.name = "tool", .mesh = make_cube(0.1)}, kJoints});
  cell.obstacles.push_back({{.name = "post", .mesh = make_box({0.3, 0.3, 0.8})},
                            Pose::from_translation({1.73, 0.0, 1.7})});
  test::add_surface_spheres(cell);
  return cell;
}

struct PostCell {
  Workload cell = make_post_cell();
  RobotChecker checker = make_robot_checker(cell);
  std::unique_ptr<Checker> meshes = make_fcl_mesh_checker(cell, {});

  Plan plan(Validity validity, const PlanningProblem& problem, const PlanOptions& options = {}) {
    return spherule::plan({checker, contact_test(*meshes)}, validity, problem, options);
  }
};

constexpr Validity kAll[] = {Validity::kProved, Validity::kSampled, Validity::kMeshes};

TEST(Planner, FindsAWayAroundThePost) {
  PostCell post;
  EXPECT_GT(check_path({kLeft, kRight}, contact_test(*post.meshes), 0.01).contacts, 0u);
  for (const Validity validity : kAll) {
    for (std::uint32_t seed = 1; seed <= static_cast<std::uint32_t>(test::effort(5, 2)); ++seed) {
      const Plan plan = post.plan(validity, {kLeft, kRight}, {.seed = seed});
      ASSERT_TRUE(plan.is_solved()) << name_of(validity);
      EXPECT_EQ(plan.path.front(), kLeft);
      EXPECT_EQ(plan.path.back(), kRight);
      EXPECT_GT(plan.path.size(), 2u);
      EXPECT_GT(plan.motion_checks, 0u);
      if (validity != Validity::kProved) {
        EXPECT_GT(plan.state_checks, 10 * plan.motion_checks);
      }
      EXPECT_EQ(check_path(plan.path, contact_test(*post.meshes), 0.002).contacts, 0u)
          << name_of(validity);
    }
  }
}

TEST(Planner, TheSeedDecides) {
  PostCell post;
  for (const Validity validity : kAll) {
    const Plan first = post.plan(validity, {kLeft, kRight}, {.seed = 4});
    EXPECT_EQ(post.plan(validity, {kLeft, kRight}, {.seed = 4}).path, first.path);
    EXPECT_NE(post.plan(validity, {kLeft, kRight}, {.seed = 5}).path, first.path);
  }
}

// Coarse samples step over the post; what is proved does not.
TEST(Planner, SampledMotionsMayPassThroughThePost) {
  PostCell post;
  const PlanOptions coarse{.step = 3.0};
  for (const Validity validity : kAll) {
    const Plan plan = post.plan(validity, {kLeft, kRight}, coarse);
    ASSERT_TRUE(plan.is_solved());
    EXPECT_EQ(check_path(plan.path, contact_test(*post.meshes), 0.01).contacts == 0,
              validity == Validity::kProved)
        << name_of(validity);
  }
}

TEST(Planner, SaysWhyItHasNoPath) {
  PostCell post;
  for (const Validity validity : kAll) {
    EXPECT_EQ(post.plan(validity, {kLeft, kAtPost}).end, PlanEnd::kEndsRefused);
    EXPECT_EQ(post.plan(validity, {kAtPost, kLeft}).end, PlanEnd::kEndsRefused);
    const PlanningProblem problem{kLeft, kRight};
    EXPECT_EQ(post.plan(validity, problem, {.most_iterations = 0}).end, PlanEnd::kIterations);
    EXPECT_EQ(post.plan(validity, problem, {.most_seconds = -1.0}).end, PlanEnd::kSeconds);
  }
}

TEST(PlanningCell, AnswersAsThePairsDo) {
  Workload cell = make_paper_cell();
  // Such spheres are so large that the lower links are always in contact.
  std::erase_if(cell.bodies, [](const Body& body) { return body.link < 4; });
  test::add_surface_spheres(cell);
  const RobotChecker checker = make_robot_checker(cell);
  RobotChecker::Scratch scratch(checker);
  const auto engine = make_tree_checker(cell, TreeMode::kPairs);
  std::size_t free = 0;
  const std::size_t stride = static_cast<std::size_t>(test::effort(37, 601));
  for (std::size_t i = 0; i < cell.program.size(); i += stride) {
    const bool is_free = checker.check_config(cell.program[i], scratch);
    EXPECT_EQ(is_free, !collides(*engine, cell.program[i])) << i;
    free += is_free ? 1 : 0;
  }
  EXPECT_GT(free, 0u);
  EXPECT_LT(free, cell.program.size() / stride);
}

}  // namespace
}  // namespace spherule

// What planners are given, how their paths are examined again, and how they are compared.

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

namespace spherule::process_points_test {
namespace {

// How far a point in the world is from the nearest pipe's outer surface.
double gap_to_pipes(const Eigen::Vector3d& point) {
  const Eigen::Vector3d at = world_from_workpiece().inverse() * point;
  double gap = 1.0;
  for (int pipe = 0; pipe < 3; ++pipe) {
    const Eigen::Vector3d axis = pipe_axis(pipe);
    const double along = std::clamp(at.dot(axis), 0.0, kPipeLength);
    gap = std::min(gap, (at - along * axis).norm() - kPipeRadius);
  }
  return gap;
}

TEST(ProcessPoints, BringTheWireToTheSeamInEveryPosture) {
  const RobotModel robot = make_robot();
  const std::size_t points = 9;
  const std::size_t angles = 8;
  const ProcessPoints found = make_process_points(robot, flange_from_wire(), points, angles);
  ASSERT_EQ(found.configurations.size(), found.point_of.size());
  EXPECT_GT(found.configurations.size(), points * angles);
  EXPECT_LT(found.configurations.size(), found.postures);
  EXPECT_LE(found.postures, 8 * points * angles);
  EXPECT_TRUE(std::is_sorted(found.point_of.begin(), found.point_of.end()));
  std::vector<Pose> links;
  std::vector<Eigen::Vector3d> tips(points);
  std::vector<Eigen::Vector3d> wires(points, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < found.configurations.size(); ++i) {
    for (std::size_t k = 0; k < kJoints; ++k) {
      EXPECT_GE(found.configurations[i][k], robot.joints()[k].lower);
      EXPECT_LE(found.configurations[i][k], robot.joints()[k].upper);
    }
    forward_kinematics(robot, found.configurations[i], links);
    const Pose wire = links.back() * link6_from_flange() * flange_from_wire();
    const Eigen::Vector3d along = wire.matrix().col(2);
    EXPECT_GT(gap_to_pipes(wire.translation()), 0.002);
    EXPECT_LT(gap_to_pipes(wire.translation()), 0.03);
    EXPECT_LT(along.z(), -0.5);
    // The torch turns about the wire of its point.
    const std::size_t point = found.point_of[i];
    if (wires[point].isZero()) {
      tips[point] = wire.translation();
      wires[point] = along;
    }
    EXPECT_LT((wire.translation() - tips[point]).norm(), 2e-5);
    EXPECT_LT((along - wires[point]).norm(), 2e-5);
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_NE(found.configurations[k], found.configurations[i]);
    }
  }
  for (std::size_t a = 0; a < points; ++a) {
    EXPECT_FALSE(wires[a].isZero()) << a;
    for (std::size_t b = 0; b < a; ++b) EXPECT_GT((tips[a] - tips[b]).norm(), 1e-3);
  }
}

TEST(ProcessStudy, MissesNothing) {
  Workload cell = make_paper_cell();
  test::add_surface_spheres(cell);
  const ProcessPoints points = make_process_points(
      cell.robot, flange_from_wire(), static_cast<std::size_t>(test::effort(12, 3)), 6);
  const ProcessStudy study = study_process_points(cell, make_robot_checker(cell), points);
  ASSERT_EQ(study.rows.size(), 4u);
  EXPECT_EQ(study.configurations, points.configurations.size());
  EXPECT_GT(study.free_configurations, 0u);
  EXPECT_LT(study.free_configurations, study.configurations);
  for (const ProcessRow& row : study.rows) {
    EXPECT_EQ(row.count.missed, 0u) << row.engine;
    EXPECT_EQ(row.count.collisions,
              study.configurations - study.free_configurations + row.count.extra);
    EXPECT_EQ(row.free_points + row.lost_points, study.free_points);
    EXPECT_GT(row.checks_a_second, 0.0);
  }
  // These spheres are far too large for the torch to weld, so that something is lost to count.
  EXPECT_EQ(study.rows[0].count.extra, study.rows[1].count.extra);
  EXPECT_GT(study.rows[0].lost_points, 0u);
  EXPECT_EQ(study.rows[2].count.extra, 0u);
  EXPECT_EQ(study.rows[2].lost_points, 0u);
}

}  // namespace
}  // namespace spherule::process_points_test
