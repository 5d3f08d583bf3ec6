// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/checkers/workload.h"
#include "bench/scenes/program.h"
#include "bench/scenes/work_cell_parts.h"
#include "robot/model/kinematics.h"
#include "tests/support/effort.h"
#include "tests/support/mesh_facts.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace spherule {
namespace {

using std::numbers::pi;

bool has_repeated_corner(const Eigen::Vector3i& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

void expect_sound(const TriangleMesh& mesh, const std::string& name) {
  EXPECT_TRUE(is_closed(mesh)) << name;
  EXPECT_GT(signed_volume(mesh), 0.0) << name;
  const auto count = static_cast<int>(mesh.vertices.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    EXPECT_TRUE((t.array() >= 0).all() && (t.array() < count).all()) << name;
  }
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    for (const double coordinate : vertex) {
      ASSERT_TRUE(std::isfinite(coordinate)) << name;
      EXPECT_EQ(static_cast<double>(static_cast<float>(coordinate)), coordinate) << name;
      EXPECT_EQ(std::nearbyint(coordinate * 0x1p22), coordinate * 0x1p22) << name;
    }
  }
}

TEST(WorkCell, HasThePapersTriangleCounts) {
  std::size_t triangles = 0;
  std::size_t of_zero_area = 0;
  for (const TriangleMesh& link : make_robot_links()) {
    triangles += link.triangles.size();
    for (const Eigen::Vector3i& t : link.triangles) of_zero_area += has_repeated_corner(t) ? 1 : 0;
  }
  EXPECT_EQ(triangles, 6825u);
  EXPECT_EQ(of_zero_area, 1u);  // an odd number of triangles cannot be closed otherwise
  EXPECT_EQ(make_torch().triangles.size(), 4318u);
  EXPECT_EQ(make_workpiece().triangles.size(), 1942u);
}

TEST(WorkCell, IsMadeOfClosedSolids) {
  const auto links = make_robot_links();
  for (std::size_t i = 0; i < links.size(); ++i)
    expect_sound(links[i], "link " + std::to_string(i));
  expect_sound(make_torch(), "torch");
  expect_sound(make_workpiece(), "workpiece");
  expect_sound(make_table(), "table");
}

// Boxes of the real robot's visual meshes, in metres.
TEST(WorkCell, LinksAreAboutAsLargeAsTheRealOnes) {
  const double real[][3] = {{0.92, 0.642, 0.22},   {0.964, 0.959, 0.711}, {0.331, 0.245, 1.111},
                            {0.702, 0.373, 0.372}, {1.249, 0.251, 0.232}, {0.190, 0.067, 0.153},
                            {0.204, 0.125, 0.125}};
  const auto links = make_robot_links();
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Eigen::Vector3d size = bounding_box(links[i]).sizes();
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(size[k], real[i][k], 0.15) << "link " << i;
  }
}

TEST(WorkCell, TheWorkpieceIsHollowThroughout) {
  const TriangleMesh mesh = make_workpiece();
  const double in_wall = 0.5 * (kPipeRadius + kPipeBoreRadius);
  EXPECT_NEAR(winding_number(mesh, {0.0, 0.0, 0.0}), 0.0, 1e-9);
  for (int pipe = 0; pipe < 3; ++pipe) {
    for (const double distance : {0.03, 0.1, 0.25}) {
      const Eigen::Vector3d center = distance * pipe_axis(pipe);
      const Eigen::Vector3d up(0.0, 0.0, in_wall);
      EXPECT_NEAR(winding_number(mesh, center), 0.0, 1e-9);
      EXPECT_NEAR(winding_number(mesh, center + up), 1.0, 1e-9);
      EXPECT_NEAR(winding_number(mesh, center + 1.2 * up), 0.0, 1e-9);
    }
  }
}

TEST(WorkCell, SeamsLieWherePipesMeet) {
  const TriangleMesh mesh = make_workpiece();
  for (int pipe = 0; pipe < 3; ++pipe) {
    for (const double angle : {0.0, 0.3, 0.8, 1.2, 0.5 * pi}) {
      const SeamPoint seam = seam_point(pipe, angle);
      for (const int of : {pipe, (pipe + 1) % 3}) {
        const Eigen::Vector3d axis = pipe_axis(of);
        EXPECT_NEAR((seam.point - seam.point.dot(axis) * axis).norm(), kPipeRadius, 1e-12);
      }
      // A millimetre off along the mean normal is outside, a millimetre deep is in the wall; chords
      // of the mesh stay within 0.03 mm of the cylinder.
      const Eigen::Vector3d normal = (seam.normal_a + seam.normal_b).normalized();
      EXPECT_NEAR(winding_number(mesh, seam.point + 0.001 * normal), 0.0, 1e-6);
      EXPECT_NEAR(winding_number(mesh, seam.point - 0.001 * normal), 1.0, 1e-6);
    }
  }
}

TEST(WorkCell, TheTorchEndsWithItsWire) {
  const TriangleMesh torch = make_torch();
  const Pose wire = flange_from_wire();
  double furthest = -1.0;
  double beside = 0.0;
  for (const Eigen::Vector3d& vertex : torch.vertices) {
    const Eigen::Vector3d in_wire = wire.inverse() * vertex;
    furthest = std::max(furthest, in_wire.z());
    if (in_wire.z() > -0.01) beside = std::max(beside, in_wire.head<2>().norm());
  }
  EXPECT_NEAR(furthest, 0.0, 1e-6);
  EXPECT_NEAR(beside, 0.0006, 1e-6);
}

// FNV-1a over the grid steps.
std::uint64_t hash(const std::vector<ArmPositions>& program) {
  std::uint64_t value = 14695981039346656037U;
  for (const ArmPositions& positions : program) {
    for (const double q : positions) {
      auto steps = static_cast<std::uint64_t>(static_cast<std::int64_t>(q * 0x1p20));
      for (int byte = 0; byte < 8; ++byte, steps >>= 8)
        value = (value ^ (steps & 255U)) * 1099511628211U;
    }
  }
  return value;
}

TEST(Program, IsTheSameEverywhere) {
  const auto [program, is_critical] = make_program(flange_from_wire());
  ASSERT_EQ(program.size(), kProgramSize);
  ASSERT_EQ(is_critical.size(), kProgramSize);
  for (const ArmPositions& positions : program) EXPECT_EQ(on_joint_grid(positions), positions);
  EXPECT_EQ(hash(program), 0xc9a7e55f6321b085U);
}

TEST(Program, IsContinuousAndKeepsTheLimits) {
  const RobotModel robot = make_robot();
  const auto program = make_program(flange_from_wire()).configurations;
  for (std::size_t i = 0; i < program.size(); ++i) {
    for (std::size_t joint = 0; joint < program[i].size(); ++joint) {
      EXPECT_GE(program[i][joint], robot.joints()[joint].lower);
      EXPECT_LE(program[i][joint], robot.joints()[joint].upper);
      if (i > 0) {
        EXPECT_LT(std::abs(program[i][joint] - program[i - 1][joint]), 0.1) << i;
      }
    }
  }
}

// There the end of the wire is within the standoff, the weave and the room at a crotch of the
// metal.
TEST(Program, TheWireIsAtTheMetalInTheCriticalSection) {
  const RobotModel robot = make_robot();
  const auto [program, is_critical] = make_program(flange_from_wire());
  const Pose piece_from_world = world_from_workpiece().inverse();
  std::vector<Pose> world_from_link;
  std::size_t critical = 0;
  for (std::size_t i = 0; i < program.size(); ++i) {
    if (is_critical[i] == 0) continue;
    ++critical;
    forward_kinematics(robot, program[i], world_from_link);
    const Eigen::Vector3d wire =
        piece_from_world *
        (world_from_link.back() * link6_from_flange() * flange_from_wire()).translation();
    double gap = 1.0;  // from the nearest pipe's outer surface
    for (int pipe = 0; pipe < 3; ++pipe) {
      const Eigen::Vector3d axis = pipe_axis(pipe);
      const double along = std::clamp(wire.dot(axis), 0.0, kPipeLength);
      gap = std::min(gap, (wire - along * axis).norm() - kPipeRadius);
    }
    EXPECT_LT(gap, 0.03) << i;
  }
  EXPECT_GT(critical, kProgramSize / 2);
  EXPECT_LT(critical, kProgramSize);
}

TEST(Program, ShufflingKeepsTheConfigurations) {
  const auto program = make_program(flange_from_wire()).configurations;
  auto mixed = shuffled(program, 7);
  EXPECT_NE(mixed, program);
  EXPECT_EQ(mixed, shuffled(program, 7));
  auto sorted = program;
  std::sort(sorted.begin(), sorted.end());
  std::sort(mixed.begin(), mixed.end());
  EXPECT_EQ(mixed, sorted);
}

TEST(InverseKinematics, BringsTheFlangeToTheTarget) {
  const RobotModel robot = make_robot();
  const ArmPositions reference{0.3, 0.2, 0.1, -0.4, 0.8, 0.5};
  std::vector<Pose> links;
  forward_kinematics(robot, reference, links);
  const Pose target = links.back() * link6_from_flange();
  const auto found = solve_inverse_kinematics(robot, target, {0.0, 0.0, 0.0, 0.0, 0.6, 0.0});
  ASSERT_TRUE(found.has_value());
  forward_kinematics(robot, *found, links);
  const Pose reached = links.back() * link6_from_flange();
  EXPECT_LT((reached.translation() - target.translation()).norm(), 1e-5);
  EXPECT_LT((reached.matrix() - target.matrix()).norm(), 2e-5);
  EXPECT_FALSE(solve_inverse_kinematics(robot, Pose::from_translation({5.0, 0.0, 0.0}), reference));
}

// The oracle on a part of the program; the benchmark queries it about all of it.
TEST(Program, HasTheWantedShareOfCollisions) {
  const Workload cell = make_paper_cell();
  std::vector<ArmPositions> sample;
  for (std::size_t i = 0; i < cell.program.size(); i += 7) sample.push_back(cell.program[i]);
  std::size_t collisions = 0;
  std::vector<std::size_t> by_body(cell.bodies.size(), 0);
  for (const std::uint32_t bits : Oracle(cell).touching_bodies(sample)) {
    collisions += bits != 0 ? 1 : 0;
    for (std::size_t i = 0; i < by_body.size(); ++i) by_body[i] += bits >> i & 1U;
  }
  const double share = static_cast<double>(collisions) / static_cast<double>(sample.size());
  EXPECT_GT(share, 0.11);
  EXPECT_LT(share, 0.15);
  for (const char* name : {"torch", "link_4", "link_5"}) {
    const auto body = std::find_if(cell.bodies.begin(), cell.bodies.end(),
                                   [&](const Body& b) { return b.part.name == name; });
    ASSERT_NE(body, cell.bodies.end());
    EXPECT_GT(by_body[static_cast<std::size_t>(body - cell.bodies.begin())], 0u) << name;
  }
}

}  // namespace
}  // namespace spherule

// Postures in closed form against forward kinematics.

namespace spherule {
namespace {

using std::numbers::pi;

Pose flange_at(const RobotModel& robot, const ArmPositions& positions) {
  std::vector<Pose> links;
  forward_kinematics(robot, positions, links);
  return links.back() * link6_from_flange();
}

// The largest difference of an angle, whole turns left out.
double difference(const ArmPositions& a, const ArmPositions& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(std::remainder(a[i] - b[i], 2.0 * pi)));
  }
  return most;
}

void expect_reached(const RobotModel& robot, const Pose& target,
                    const std::vector<ArmPositions>& postures) {
  for (const ArmPositions& posture : postures) {
    const Pose reached = flange_at(robot, posture);
    EXPECT_LT((reached.translation() - target.translation()).norm(), 1e-6);
    EXPECT_LT((reached.matrix() - target.matrix()).cwiseAbs().maxCoeff(), 1e-6);
    for (const double angle : posture) EXPECT_LE(std::abs(angle), pi);
  }
}

// Two for the wrist where the arm is forwards or backwards alone; mostly all eight.
TEST(SphericalWrist, FindsEveryPosture) {
  const RobotModel robot = make_robot();
  test::Random random(3);
  std::size_t all = 0;
  const int cases = test::effort(5000, 500);
  for (int i = 0; i < cases; ++i) {
    ArmPositions positions;
    for (double& position : positions) position = random.between(-pi, pi);
    // Away from where two postures fall together.
    if (std::abs(std::sin(positions[4])) < 1e-3) continue;
    const Pose target = flange_at(robot, positions);
    const auto postures = inverse_kinematics_branches(robot, target);
    expect_reached(robot, target, postures);
    EXPECT_TRUE(std::any_of(postures.begin(), postures.end(), [&](const ArmPositions& posture) {
      return difference(posture, positions) < 1e-6;
    })) << i;
    for (std::size_t a = 0; a < postures.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) EXPECT_GT(difference(postures[a], postures[b]), 1e-6);
    }
    EXPECT_TRUE(postures.size() == 4 || postures.size() == 8) << postures.size();
    all += postures.size() == 8 ? 1 : 0;
  }
  EXPECT_GT(all, static_cast<std::size_t>(cases) / 4);
  EXPECT_LT(all, static_cast<std::size_t>(cases));
}

TEST(SphericalWrist, ReachesPlacesWherePosturesFallTogether) {
  const RobotModel robot = make_robot();
  const double straight = -std::atan2(1.38, 0.15);  // of the elbow
  for (const ArmPositions& positions :
       {ArmPositions{0.4, 0.3, -0.2, 1.1, 0.0, 0.7},          // the wrist stretched
        ArmPositions{0.4, 0.3, -0.2, 1.1, pi, 0.7},           // and folded
        ArmPositions{-1.0, 0.6, straight, 0.3, 0.9, -2.0},    // the arm stretched
        ArmPositions{-1.0, 0.6, straight, 0.0, 0.0, 0.0}}) {  // and the wrist
    const Pose target = flange_at(robot, positions);
    const auto postures = inverse_kinematics_branches(robot, target);
    EXPECT_GE(postures.size(), 1u);
    expect_reached(robot, target, postures);
  }
}

TEST(SphericalWrist, FindsNothingOutOfReach) {
  const RobotModel robot = make_robot();
  EXPECT_TRUE(inverse_kinematics_branches(robot, Pose::from_translation({5.0, 0.0, 0.0})).empty());
  EXPECT_TRUE(inverse_kinematics_branches(robot, Pose::from_translation({0.34, 0.0, 0.7})).empty());
}

TEST(SphericalWrist, RefusesOtherRobots) {
  EXPECT_THROW(inverse_kinematics_branches(RobotModel(), Pose()), Error);
  const RobotModel usual = make_robot();
  RobotModel robot("base");
  std::string parent = "base";
  for (int i = 0; i < kJoints; ++i) {
    const Joint& joint = usual.joints()[static_cast<std::size_t>(i)];
    Joint moved{.name = joint.name,
                .type = joint.type,
                .parent_from_joint = joint.parent_from_joint,
                .axis = joint.axis,
                .lower = joint.lower,
                .upper = joint.upper};
    if (i == 5) moved.parent_from_joint = Pose::from_translation({0.0, 0.0, 0.1});
    const std::string link = "link_" + std::to_string(i);
    robot.add_link(link, parent, moved);
    parent = link;
  }
  EXPECT_THROW(inverse_kinematics_branches(robot, Pose()), Error);
}

TEST(SphericalWrist, LimitsIncludeTheirEnds) {
  const RobotModel robot = make_robot();
  ArmPositions positions{};
  EXPECT_TRUE(is_within_limits(robot, positions));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Joint& joint = robot.joints()[i];
    for (const double limit : {joint.lower, joint.upper}) {
      positions[i] = limit;
      EXPECT_TRUE(is_within_limits(robot, positions));
      positions[i] = std::nextafter(limit, 2.0 * limit);
      EXPECT_FALSE(is_within_limits(robot, positions));
    }
    positions[i] = 0.0;
  }
}

}  // namespace
}  // namespace spherule
