// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "bench/robot_edges/arm.h"
#include "bench/robot_edges/peer_arms.h"
#include "bench/robot_edges/planning.h"
#include "bench/studies/refined_cover.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace spherule {
namespace {

// Other libraries' checks of an arm: on the same convex links they say the same.

// A box on a table with two directions to slide in, and a bar that turns on it, above a fixed box.
Arm make_toy_arm(const TriangleMesh& bar = make_box({0.3, 0.05, 0.05})) {
  Arm arm{RobotModel("base"), {}};
  const auto add = [&](const std::string& name, const std::string& parent, Joint joint) {
    joint.name = name + "_joint";
    arm.model.add_link(name, parent, joint);
  };
  const auto slide = [](const Eigen::Vector3d& axis) {
    return Joint{.type = JointType::kPrismatic, .axis = axis, .lower = -0.8, .upper = 0.8};
  };
  add("rail", "base", slide(Eigen::Vector3d::UnitX()));
  add("box", "rail", slide(Eigen::Vector3d::UnitY()));
  add("bar", "box",
      {.type = JointType::kContinuous,
       .parent_from_joint = Pose::from_translation({0.0, 0.0, 0.2}),
       .axis = Eigen::Vector3d(0.3, 0.2, 1.0)});
  arm.meshes = {make_box({0.2, 0.2, 0.4}), {}, make_box({0.1, 0.1, 0.3}), bar};
  for (std::size_t i = 0; i < arm.meshes.size(); ++i) {
    if (arm.meshes[i].triangles.empty()) continue;
    arm.model.attach(
        arm.model.links()[i].name,
        std::make_shared<const SphereTree>(build_tree(spheres_around(arm.meshes[i], 0.03))));
  }
  return arm;
}

// Obstacles of all kinds around it; the largest is a mesh.
ArmScene make_toy_scene() {
  ArmScene scene{.name = "toy", .cloud_radius = 0.03};
  for (int i = 0; i < 10; ++i) {
    for (int k = 0; k < 10; ++k) scene.cloud.push_back({0.02 * i, -0.6, 0.2 - 0.02 * k});
  }
  const auto add = [&](const Primitive& primitive, const Eigen::Vector3d& at) {
    scene.obstacles.push_back({"obstacle " + std::to_string(scene.obstacles.size()), primitive,
                               Pose::from_translation(at)});
  };
  add(Box{{0.2, 0.1, 0.6}}, {0.6, 0.3, 0.1});
  add(SolidSphere{0.15}, {-0.5, 0.5, 0.1});
  add(Cylinder{0.1, 0.5}, {-0.6, -0.2, 0.1});
  add(Capsule{0.1, 0.3}, {0.5, -0.5, 0.2});
  scene.mesh = make_box({0.3, 0.2, 0.5});
  for (Eigen::Vector3d& vertex : scene.mesh.vertices) vertex += Eigen::Vector3d(0.1, 0.6, 0.1);
  return scene;
}

using Checkers = std::vector<std::unique_ptr<ArmChecker>>;

Checkers checkers_of(const Arm& arm, const ArmScene& scene) {
  const AllowedCollisions allowed(arm.model);
  Checkers checkers;
  for (const FclVolume volume : {FclVolume::kObbRss, FclVolume::kObb}) {
    checkers.push_back(std::make_unique<FclArm>(arm, allowed, scene, volume));
  }
  for (const BulletLinks links : {BulletLinks::kHulls, BulletLinks::kGImpact}) {
    checkers.push_back(std::make_unique<BulletArm>(arm, allowed, scene, links));
  }
  return checkers;
}

// What they say of the arm alone and of each kind of obstacle alone, but where they may differ:
// within rounding of a contact, which is seldom, and where a link holds an obstacle.
void expect_agreement(const ArmScene& scene) {
  constexpr int kConfigurations = 2000;
  const Arm arm = make_toy_arm();
  const Checkers checkers = checkers_of(arm, scene);
  FclArm truth(arm, AllowedCollisions(arm.model), scene, FclVolume::kObbRss);
  RandomNumbers random(3);
  int contacts = 0;
  std::vector<int> differ(checkers.size());
  for (int i = 0; i < kConfigurations; ++i) {
    const Configuration at = random_configuration(arm.model, random);
    if (truth.holds_an_obstacle(at)) continue;
    const bool collides = truth.collides(at);
    contacts += collides ? 1 : 0;
    for (std::size_t k = 0; k < checkers.size(); ++k) {
      differ[k] += checkers[k]->collides(at) != collides ? 1 : 0;
    }
  }
  EXPECT_GT(contacts, 10);
  EXPECT_LT(contacts, kConfigurations - 10);
  for (std::size_t k = 0; k < checkers.size(); ++k) EXPECT_LE(differ[k], 2) << checkers[k]->name();
}

TEST(ArmCheckers, AgreeAboutTheArmItself) {
  expect_agreement({.name = "nothing"});
}

TEST(ArmCheckers, AgreeAboutEveryKindOfObstacle) {
  const ArmScene all = make_toy_scene();
  for (const PlacedPrimitive& obstacle : all.obstacles) {
    SCOPED_TRACE(obstacle.name);
    expect_agreement({.name = "primitive", .obstacles = {obstacle}});
  }
  expect_agreement({.name = "cloud", .cloud = all.cloud, .cloud_radius = all.cloud_radius});
  expect_agreement({.name = "mesh", .mesh = all.mesh});
  expect_agreement(all);
}

// Two bars with a gap, in which a sphere stands: only a hull fills it.
TEST(ArmCheckers, HullsFillGaps) {
  TriangleMesh bars = make_box({0.1, 0.05, 0.05});
  const auto corners = static_cast<int>(bars.vertices.size());
  for (int i = 0; i < corners; ++i) {
    Eigen::Vector3d& vertex = bars.vertices[static_cast<std::size_t>(i)];
    vertex.x() -= 0.3;
    bars.vertices.push_back(vertex + Eigen::Vector3d(0.6, 0.0, 0.0));
  }
  const std::size_t triangles = bars.triangles.size();
  for (std::size_t i = 0; i < triangles; ++i) {
    bars.triangles.push_back((bars.triangles[i].array() + corners).matrix());
  }
  const Arm arm = make_toy_arm(bars);
  ArmScene scene{.name = "ball"};
  scene.obstacles = {{"ball", SolidSphere{0.01}, Pose::from_translation({0.65, 0.5, 0.2})}};
  for (const auto& checker : checkers_of(arm, scene)) {
    EXPECT_EQ(checker->collides(Configuration{0.5, 0.5, 0.0}),
              std::string(checker->name()) == "Bullet hulls")
        << checker->name();
    EXPECT_TRUE(checker->collides(Configuration{0.4, 0.5, 0.0})) << checker->name();
  }
}

// What planners are given in the scenes of an arm, and what becomes of it.
struct ToyScene {
  Arm arm = make_toy_arm();
  AllowedCollisions allowed{arm.model};
  ArmScene scene = make_toy_scene();
  RobotChecker checker = robot_scene(arm, allowed, scene).snapshot();
  FclArm fcl{arm, allowed, scene, FclVolume::kObbRss};
  ContactTest in_contact = [this](std::span<const double> at) { return fcl.collides(at); };

  std::vector<PlanningProblem> problems(std::size_t count) {
    RandomNumbers random(5);
    return make_arm_problems(checker, fcl, count, random);
  }
  std::vector<ProblemRow> study(std::size_t count, const PlanOptions& options) {
    return study_problems({checker, in_contact}, in_contact, problems(count), options, 0.002);
  }
};

TEST(ArmProblems, EndsAreFreeAndTheStraightMotionIsNot) {
  ToyScene toy;
  const auto problems = toy.problems(8);
  ASSERT_EQ(problems.size(), 8u);
  RobotChecker::Scratch scratch(toy.checker);
  for (const PlanningProblem& problem : problems) {
    for (const Configuration& end : {problem.start, problem.goal}) {
      EXPECT_TRUE(toy.checker.check_config(end, scratch));
      EXPECT_FALSE(toy.in_contact(end));
    }
    EXPECT_GT(check_path({problem.start, problem.goal}, toy.in_contact, 0.001).contacts, 0u);
  }
  EXPECT_EQ(toy.problems(8).back().goal, problems.back().goal);
}

TEST(ArmProblems, NoneWhereNothingIsInTheWay) {
  ToyScene toy;
  toy.allowed.allow_all();
  const RobotChecker checker = robot_scene(toy.arm, toy.allowed, {}).snapshot();
  FclArm fcl(toy.arm, toy.allowed, {}, FclVolume::kObb);
  RandomNumbers random(5);
  EXPECT_THROW(make_arm_problems(checker, fcl, 1, random), Error);
}

TEST(ArmProblems, ArePlannedWithoutContactsByProofs) {
  ToyScene toy;
  auto rows = toy.study(6, {});
  ASSERT_EQ(rows.size(), 3u);
  for (const ProblemRow& row : rows) {
    EXPECT_EQ(row.plans.size(), 6u);
    EXPECT_GT(row.solved, 0u);
  }
  EXPECT_EQ(rows.front().in_contact, 0u);
  // The seed decides.
  const auto again = toy.study(6, {});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_EQ(again[i].plans[k].path, rows[i].plans[k].path);
    }
  }
  const std::size_t solved = rows[0].solved;
  append(rows, again);
  EXPECT_EQ(rows.back().plans.size(), 12u);
  EXPECT_EQ(rows.front().solved, 2 * solved);
  EXPECT_EQ(toy.study(1, {.most_iterations = 0}).front().solved, 0u);
  EXPECT_EQ(toy.study(1, {.most_seconds = -1.0}).front().solved, 0u);
}

// Coarse samples step over obstacles; what is proved does not.
TEST(ArmProblems, CoarselySampledMotionsPassThroughObstacles) {
  ToyScene toy;
  const auto rows = toy.study(12, {.step = 3.0});
  EXPECT_EQ(rows[0].in_contact, 0u);
  EXPECT_GT(rows[1].in_contact, 0u);
  EXPECT_GT(rows[2].in_contact, 0u);
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
  EXPECT_NEAR(static_cast<double>(check.configurations), 1302.0, 2.0);
  EXPECT_NEAR(static_cast<double>(check.contacts), 1.5, 0.5);
  for (const Configuration& corner : path) {
    EXPECT_NE(std::find(queried.begin(), queried.end(), corner), queried.end());
  }
  for (std::size_t i = 1; i < queried.size(); ++i) {
    for (std::size_t k = 0; k < queried[i].size(); ++k) {
      EXPECT_LE(std::abs(queried[i][k] - queried[i - 1][k]), 1e-3 + 1e-12);
    }
  }
}

}  // namespace
}  // namespace spherule
