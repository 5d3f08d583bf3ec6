// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/checkers/fcl_mesh_checker.h"
#include "bench/checkers/sphere_checkers.h"
#include "bench/checkers/workload.h"
#include "bench/scenes/work_cell.h"
#include "bench/studies/measure.h"
#include "robot/model/kinematics.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/solids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

using test::Random;

// A sphere about the box of every triangle: covers the surface, without any fit.
std::shared_ptr<const SphereTree> surface_spheres(const TriangleMesh& mesh) {
  std::vector<Sphere> spheres;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    Eigen::AlignedBox3d box;
    for (int i = 0; i < 3; ++i) box.extend(mesh.vertices[static_cast<std::size_t>(t[i])]);
    spheres.push_back({box.center(), 0.5 * box.diagonal().norm() * (1.0 + 1e-12)});
  }
  return std::make_shared<const SphereTree>(build_tree(spheres));
}

void add_surface_spheres(Workload& cell) {
  for (Body& body : cell.bodies) body.part.tree = surface_spheres(body.part.mesh);
  for (Obstacle& obstacle : cell.obstacles) {
    obstacle.part.tree = surface_spheres(obstacle.part.mesh);
  }
}

std::vector<ArmPositions> every(const Workload& cell, std::size_t stride) {
  std::vector<ArmPositions> sample;
  for (std::size_t i = 0; i < cell.program.size(); i += stride) sample.push_back(cell.program[i]);
  return sample;
}

std::vector<std::uint8_t> verdicts(Checker& checker, const std::vector<ArmPositions>& sample) {
  std::vector<std::uint8_t> result(sample.size(), 2);
  checker.check(sample, result);
  return result;
}

TEST(Engines, FclAgreesWithTheOracleInEverySetting) {
  const Workload cell = make_paper_cell();
  const auto sample = every(cell, 23);
  const auto touching = Oracle(cell).touching_bodies(sample);
  std::size_t collisions = 0;
  for (const std::uint32_t bits : touching) collisions += bits != 0 ? 1 : 0;
  ASSERT_GT(collisions, 50u);
  for (const FclMeshSetting& setting : all_fcl_mesh_settings()) {
    const auto found = verdicts(*make_fcl_mesh_checker(cell, setting), sample);
    for (std::size_t i = 0; i < sample.size(); ++i) {
      EXPECT_EQ(found[i] != 0, touching[i] != 0) << to_string(setting) << " " << i;
    }
  }
}

TEST(Engines, SphereEnginesAgreeAndMissNothing) {
  Workload cell = make_paper_cell();
  add_surface_spheres(cell);
  const auto sample = every(cell, 601);
  const auto touching = Oracle(cell).touching_bodies(sample);
  const auto by_tree = verdicts(*make_tree_checker(cell, TreeMode::kSingle), sample);
  EXPECT_EQ(by_tree, verdicts(*make_tree_checker(cell, TreeMode::kPairs), sample));
  EXPECT_EQ(by_tree, verdicts(*make_fcl_sphere_checker(cell), sample));
  for (std::size_t i = 0; i < sample.size(); ++i) {
    if (touching[i] != 0) {
      EXPECT_EQ(by_tree[i], 1) << i;
    }
  }
}

// A small cube on the robot's last link inside of a large hollow shell's solid: no two triangles
// meet, so FCL alone says free.
TEST(Oracle, SeesABodyInsideAnother) {
  Workload cell{.name = "inside", .robot = make_robot()};
  cell.bodies.push_back({{.name = "cube", .mesh = make_cube(0.05)}, kJoints});
  cell.obstacles.push_back({{.name = "block", .mesh = make_cube(8.0)}, Pose()});
  const std::vector<ArmPositions> sample{ArmPositions{}};
  EXPECT_EQ(verdicts(*make_fcl_mesh_checker(cell, {}), sample)[0], 0);
  EXPECT_EQ(Oracle(cell).touching_bodies(sample)[0], 1u);
  std::swap(cell.bodies[0].part.mesh, cell.obstacles[0].part.mesh);
  cell.obstacles[0].world_from_part = Pose::from_translation({1.5, 0.0, 1.5});
  EXPECT_EQ(Oracle(cell).touching_bodies(sample)[0], 1u);
  cell.obstacles[0].world_from_part = Pose::from_translation({0.0, 0.0, 9.0});
  EXPECT_EQ(Oracle(cell).touching_bodies(sample)[0], 0u);
}

// The peers in single precision, which promise no less than a miss: their radii are padded.
struct Peer {
  std::string name;
  std::unique_ptr<Checker> checker;
};

std::vector<Peer> peers_of(const Workload& workload) {
  std::vector<Peer> peers;
  for (const InstructionSet set :
       {InstructionSet::kPortable, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (!is_available(set)) continue;
    const std::string number = std::to_string(static_cast<int>(set));
    peers.push_back({"all pairs, instructions " + number,
                     make_flat_scan_checker(workload, FlatScan::kAllPairs, set)});
    peers.push_back({"spheres in front, instructions " + number,
                     make_flat_scan_checker(workload, FlatScan::kSpheresInFront, set)});
  }
  peers.push_back(
      {"Bullet's pair test", make_bullet_sphere_checker(workload, BulletQuery::kContactPairTest)});
  peers.push_back({"Bullet's trees", make_bullet_sphere_checker(workload, BulletQuery::kTrees)});
  return peers;
}

std::vector<Sphere> random_spheres(Random& random, std::size_t count, double spread) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-spread),
                                Eigen::Vector3d::Constant(spread));
  std::vector<Sphere> spheres;
  for (std::size_t i = 0; i < count; ++i) {
    spheres.push_back({random.in_box(box), random.between(0.0, 0.1)});
  }
  return spheres;
}

Part part_of(const std::string& name, const std::vector<Sphere>& spheres) {
  return {
      .name = name, .mesh = {}, .tree = std::make_shared<const SphereTree>(build_tree(spheres))};
}

std::vector<std::pair<Eigen::Matrix<long double, 3, 1>, long double>> placed(const Part& part,
                                                                             const Pose& pose) {
  std::vector<std::pair<Eigen::Matrix<long double, 3, 1>, long double>> spheres;
  const auto matrix = pose.rotation().cast<long double>().normalized().toRotationMatrix();
  for (const Sphere& sphere : part.tree->spheres()) {
    spheres.emplace_back(
        matrix * sphere.center.cast<long double>() + pose.translation().cast<long double>(),
        static_cast<long double>(sphere.radius));
  }
  return spheres;
}

// The least gap of two spheres of the pairs that are tested, in long double.
double gap_of(const Workload& workload, const ArmPositions& configuration) {
  std::vector<Pose> world_from_link;
  forward_kinematics(workload.robot, configuration, world_from_link);
  long double least = std::numeric_limits<long double>::infinity();
  for (const Body& body : workload.bodies) {
    const auto moving = placed(body.part, world_from_link[static_cast<std::size_t>(body.link)]);
    for (const Obstacle& obstacle : workload.obstacles) {
      if (!is_tested(body, obstacle)) continue;
      for (const auto& [a, radius_a] : moving) {
        for (const auto& [b, radius_b] : placed(obstacle.part, obstacle.world_from_part)) {
          least = std::min(least, (a - b).norm() - radius_a - radius_b);
        }
      }
    }
  }
  return static_cast<double>(least);
}

ArmPositions random_configuration(Random& random, const RobotModel& robot) {
  ArmPositions configuration;
  for (const Joint& joint : robot.joints()) {
    configuration[static_cast<std::size_t>(joint.variable)] =
        random.between(joint.lower, joint.upper);
  }
  return configuration;
}

// Some spheres on every other link; obstacles with one sphere at the gap from a sphere of the
// robot, and some more around.
Workload random_scene(Random& random, ArmPositions& configuration, double gap) {
  Workload scene{.name = "random", .robot = make_robot()};
  configuration = random_configuration(random, scene.robot);
  for (int link = kJoints; link >= 0; link -= 2) {
    scene.bodies.push_back(
        {part_of("body", random_spheres(random, 1 + random.index(40), 0.2)), link});
  }
  std::vector<Pose> world_from_link;
  forward_kinematics(scene.robot, configuration, world_from_link);
  const Body& body = scene.bodies[random.index(scene.bodies.size())];
  const auto& spheres = body.part.tree->spheres();
  const Sphere& near = spheres[random.index(spheres.size())];
  const Pose world_from_part(random.rotation(), 2.0 * random.direction());
  const double radius = random.between(0.0, 0.3);
  const Eigen::Vector3d center =
      world_from_link[static_cast<std::size_t>(body.link)] * near.center +
      (near.radius + radius + gap) * random.direction();
  std::vector<Sphere> of_first = random_spheres(random, random.index(3), 0.1);
  of_first.push_back({world_from_part.inverse() * center, radius});
  scene.obstacles.push_back({part_of("first", of_first), world_from_part});
  scene.obstacles.push_back({part_of("table", random_spheres(random, 1 + random.index(100), 0.3)),
                             Pose::from_translation(3.0 * random.direction())});
  return scene;
}

TEST(SpherePeers, MissNothingAndAddNoMoreThanTheirPads) {
  Random random(5);
  std::size_t hits = 0;
  std::size_t frees = 0;
  std::size_t near = 0;
  for (int i = 0; i < 1000; ++i) {
    const double gaps[] = {0.0,   -1e-9, 1e-9, -1e-7, 1e-7, -1e-6, 1e-6,
                           -1e-5, 1e-5,  1e-4, -1e-4, 1e-3, 0.1,   0.5};
    ArmPositions configuration;
    const Workload scene = random_scene(random, configuration, gaps[random.index(14)]);
    const double gap = gap_of(scene, configuration);
    const double pad = single_precision_pad(scene_reach(scene));
    const bool must_hit = gap <= 0.0;
    const bool must_be_free = gap > 3.0 * pad;  // two radii, and what the pads are for
    hits += must_hit ? 1 : 0;
    frees += must_be_free ? 1 : 0;
    near += std::abs(gap) < 3e-6 ? 1 : 0;
    for (const Peer& peer : peers_of(scene)) {
      std::uint8_t verdict = 2;
      peer.checker->check({&configuration, 1}, {&verdict, 1});
      if (must_hit) {
        EXPECT_EQ(verdict, 1) << peer.name << " " << i << " gap " << gap;
      } else if (must_be_free) {
        EXPECT_EQ(verdict, 0) << peer.name << " " << i << " gap " << gap << " pad " << pad;
      }
    }
  }
  EXPECT_GT(hits, 300u);
  EXPECT_GT(frees, 100u);
  EXPECT_GT(near, 100u);
}

// Their forward kinematics along whole turns, against a sphere where the last link's is.
TEST(SpherePeers, MoveAsTheRobotDoes) {
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    Workload scene{.name = "one sphere", .robot = make_robot()};
    ArmPositions configuration;
    for (double& position : configuration) position = random.between(-10.0, 10.0);
    const Sphere sphere{0.3 * random.direction(), 0.0};
    scene.bodies.push_back({part_of("ball", {sphere}), kJoints});
    std::vector<Pose> world_from_link;
    forward_kinematics(scene.robot, configuration, world_from_link);
    const Eigen::Vector3d there = world_from_link.back() * sphere.center;
    for (const double away : {0.0, 2e-4}) {
      scene.obstacles = {{part_of("there", {{there + away * random.direction(), 0.0}}), Pose()}};
      for (const Peer& peer : peers_of(scene)) {
        std::uint8_t verdict = 2;
        peer.checker->check({&configuration, 1}, {&verdict, 1});
        EXPECT_EQ(verdict, away == 0.0 ? 1 : 0) << peer.name << " " << i;
      }
    }
  }
}

TEST(SpherePeers, RefuseWhatTheyCannotMove) {
  Workload scene{.name = "shifted", .robot = RobotModel("root")};
  scene.robot.add_link("slide", "root", {.name = "joint", .type = JointType::kPrismatic});
  scene.bodies.push_back({part_of("ball", {{{0.0, 0.0, 0.0}, 0.1}}), 1});
  EXPECT_THROW(make_flat_scan_checker(scene, FlatScan::kAllPairs), Error);
  scene.robot = make_robot();
  scene.obstacles.assign(32, {part_of("ball", {{{0.0, 0.0, 9.0}, 0.1}}), Pose()});
  EXPECT_NO_THROW(make_flat_scan_checker(scene, FlatScan::kAllPairs));
  scene.obstacles.push_back(scene.obstacles.front());
  EXPECT_THROW(make_flat_scan_checker(scene, FlatScan::kAllPairs), Error);
}

TEST(FitParts, StopsWhereAPromiseIsNotProved) {
  Simplification fit;
  Certificate& certificate = fit.certificate;
  certificate.covered = true;
  fit.options.max_error = 2.0;
  certificate.protrusion_over_simplified_max = 2.0;
  EXPECT_NO_THROW(check_promises(fit, "part"));
  fit.options.max_error = 1.9;
  EXPECT_THROW(check_promises(fit, "part"), Error);
  fit.options.max_error = 2.0;
  certificate.protrusion_over_simplified_max.reset();
  EXPECT_THROW(check_promises(fit, "part"), Error);
  certificate.protrusion_over_simplified_max = 1.0;
  certificate.covered = false;
  EXPECT_THROW(check_promises(fit, "part"), Error);
}

}  // namespace
}  // namespace spherule
