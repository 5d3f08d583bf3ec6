// SPDX-License-Identifier: BSD-3-Clause
// A tool that has to go around a post, planned with each way of checking.
#include "bench/planning/planner.h"

#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/checkers/tree_checker.h"
#include "bench/planning/path_check.h"
#include "bench/planning/planning_cell.h"
#include "bench/tests/surface_spheres.h"
#include "tests/support/effort.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

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
