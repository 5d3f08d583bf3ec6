// SPDX-License-Identifier: BSD-3-Clause
#include "bench/planning/process_points.h"

#include "bench/checkers/tree_checker.h"
#include "bench/planning/planning_cell.h"
#include "bench/planning/process_study.h"
#include "bench/scenes/program.h"
#include "bench/scenes/torch.h"
#include "bench/scenes/workpiece.h"
#include "bench/tests/surface_spheres.h"
#include "robot/model/kinematics.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

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
