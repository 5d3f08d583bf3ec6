// SPDX-License-Identifier: BSD-3-Clause
// Contacts confirmed on meshes that are not convex, of self pairs and with obstacles of every kind,
// padded and not, against FCL's distances of these meshes, a point-in-solid test, and distances of
// convex cells: nothing missed, and nothing extra but within rounding.

#include "base/rounding.h"
#include "collide/meshes/solid_mesh.h"
#include "robot/check/robot_scene.h"
#include "robot/model/kinematics.h"
#include "tests/robot/check/checked.h"
#include "tests/robot/check/voxel_solids.h"
#include "tests/robot/robots.h"
#include "tests/robot/solid_oracle.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

// FCL is no judge nearer to contact, nor are alternating projections.
constexpr double kUnclear = 1e-6, kUnclearProjection = 1e-3;

// Voxels, a primitive, or one sphere about the origin.
struct Shape {
  std::shared_ptr<const VoxelSolid> voxels{};
  double radius = 0.0;  // of the sphere, or one around the primitive
  double padding = 0.0;
  std::optional<Primitive> primitive{};

  std::shared_ptr<const SphereTree> tree() const {
    return voxels ? cover_of(voxels->covered()) : one_sphere_tree(Vector3d::Zero(), radius);
  }
};

double gap_between(const Shape& a, const Pose& world_from_a, const Shape& b,
                   const Pose& world_from_b) {
  if (a.voxels && b.voxels) {
    return distance_between(*a.voxels, world_from_a, *b.voxels, world_from_b);
  }
  if (b.primitive) {
    if (a.voxels)
      return a.voxels->distance_from(world_from_a, *b.primitive, b.radius, world_from_b);
    const Vector3d center = world_from_b.inverse() * world_from_a.translation();
    return static_cast<double>(distance_to(*b.primitive, center.cast<Wide>())) - a.radius;
  }
  if (!a.voxels && !b.voxels) {
    const Vector3d off = world_from_a.translation() - world_from_b.translation();
    return off.norm() - a.radius - b.radius;
  }
  if (!a.voxels) return gap_between(b, world_from_b, a, world_from_a);
  return a.voxels->distance_from(world_from_a.inverse() * world_from_b.translation()) - b.radius;
}

// A chain of joints that all move, so that all but the adjacent links are tested, an attached
// object, and obstacles of the kinds for which an exact distance is known.
class VoxelScene {
 public:
  VoxelScene(Random& random, int joints) : robot_(make_robot(random, joints)), scene_(robot_) {
    for (std::size_t link = 0; link < bodies_.size(); ++link) {
      names_.push_back(robot_.links()[link].name);
      if (bodies_[link].padding > 0.0) scene_.set_padding(names_[link], bodies_[link].padding);
    }
    attached_ = random_shape(random, 0.04);
    scene_.attach("object", names_.back(), attached_.tree(), at_last_);
    for (int k = 0; k < 4; ++k) {
      const Pose pose = random.pose(1.0);
      Shape shape = random_shape(random, k == 0 ? 0.6 : 0.08);  // one holds bodies
      const std::string name = "obstacle " + std::to_string(k);
      if (k == 3 && shape.voxels) {
        TriangleMesh mesh = shape.voxels->mesh();
        mesh.vertex_error = shape.padding = 0.01;
        scene_.add(name, std::make_shared<const SolidMesh>(mesh), pose);
      } else if (k == 1) {
        shape = random_solid(random);
        scene_.add(name, *shape.primitive, pose);
      } else if (k == 2 && !shape.voxels) {
        scene_.add(name, Primitive(SolidSphere{shape.radius}), pose);
        shape.padding = 0.0;
      } else {
        scene_.add(name, shape.tree(), pose);
        shape.padding = 0.0;
        if (random.whole(0, 1) == 0) {
          scene_.set_padding(names_[1], name, kBetween);
          padded_with_.push_back(static_cast<std::size_t>(k));
        }
      }
      obstacles_.push_back({shape, pose});
    }
    scene_.add("floor", Primitive(HalfSpace{}), Pose::from_translation({0.0, 0.0, kFloor}));
  }

  const RobotModel& robot() const { return robot_; }
  RobotChecker checker(InstructionSet set, bool is_confirmed) const {
    return scene_.snapshot(
        {.instructions = set,
         .meshes = is_confirmed ? meshes_ : std::vector<std::shared_ptr<const CoveredMesh>>()});
  }

  // The least distance, less the padding, of all that is tested against each other and within
  // kFarApart; -1 where two have a point in common; 0 where it is unclear whether they touch.
  double gap(std::span<const double> configuration) const {
    std::vector<Pose> poses;
    forward_kinematics(robot_, configuration, poses);
    double least = 1.0;
    bool is_unclear = false;
    const auto take = [&](double distance, double padding) {
      if (distance > kFarApart) return;  // a lower bound, above all padding
      least = std::min(least, distance <= 0.0 ? -1.0 : distance - padding);
    };
    const auto against_obstacles = [&](const Shape& body, const Pose& pose, bool is_second) {
      for (std::size_t k = 0; k < obstacles_.size(); ++k) {
        const bool is_padded = is_second && std::find(padded_with_.begin(), padded_with_.end(),
                                                      k) != padded_with_.end();
        const Shape& shape = obstacles_[k].shape;
        const double padding = body.padding + shape.padding + (is_padded ? kBetween : 0.0);
        const double distance = gap_between(body, pose, shape, obstacles_[k].pose);
        is_unclear |= shape.primitive && std::abs(distance - padding) < kUnclearProjection;
        take(distance < 1e-6 && shape.primitive ? 0.0 : distance, padding);
      }
      const double lowest =
          body.voxels ? body.voxels->lowest(pose) : pose.translation().z() - body.radius;
      take(lowest - kFloor, body.padding);
    };
    const std::size_t last = bodies_.size() - 1;
    const Pose object = poses[last] * at_last_;
    against_obstacles(attached_, object, false);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      against_obstacles(bodies_[i], poses[i], i == 1);
      for (std::size_t k = i + 2; k < bodies_.size(); ++k) {
        take(gap_between(bodies_[i], poses[i], bodies_[k], poses[k]),
             bodies_[i].padding + bodies_[k].padding);
      }
      if (i < last) take(gap_between(bodies_[i], poses[i], attached_, object), bodies_[i].padding);
    }
    return is_unclear && least > -kUnclearProjection ? 0.0 : least;
  }

 private:
  struct Placed {
    Shape shape;
    Pose pose;
  };
  static constexpr double kFloor = -1.2;
  static constexpr double kBetween = 0.03;

  static Shape random_solid(Random& random) {
    const double radius = random.between(0.05, 0.15), length = random.between(0.05, 0.4);
    const Primitive solids[] = {Box{{radius, 2.0 * radius, length}}, Cylinder{radius, length},
                                Capsule{radius, length}};
    return {.radius = length + 2.0 * radius, .primitive = solids[random.index(3)]};
  }

  Shape random_shape(Random& random, double cell_size) {
    if (random.whole(0, 4) == 0) return {.radius = 0.8 * cell_size};
    const int cells = cell_size > 0.3 ? 1 : random.whole(2, 7);
    const auto voxels = std::make_shared<const VoxelSolid>(random, cells, cell_size);
    meshes_.push_back(voxels->covered());
    return {voxels};
  }

  RobotModel make_robot(Random& random, int joints) {
    RobotModel robot("link 0");
    for (int i = 0; i < joints; ++i) {
      Joint joint;
      joint.name = "joint " + std::to_string(i);
      joint.type = random.whole(0, 3) == 0 ? JointType::kPrismatic : JointType::kRevolute;
      joint.parent_from_joint = random.pose(0.4);
      joint.axis = random.point(1.0);
      joint.lower = -100.0;
      joint.upper = 100.0;
      robot.add_link("link " + std::to_string(i + 1), "link " + std::to_string(i), joint);
    }
    for (int i = 0; i <= joints; ++i) {
      Shape body = random_shape(random, random.between(0.03, 0.09));
      if (random.whole(0, 2) == 0) body.padding = random.between(0.0, 0.03);
      robot.attach("link " + std::to_string(i), body.tree());
      bodies_.push_back(std::move(body));
    }
    return robot;
  }

  std::vector<std::shared_ptr<const CoveredMesh>> meshes_;
  std::vector<Shape> bodies_;  // one a link
  RobotModel robot_;
  RobotScene scene_;
  std::vector<std::string> names_;
  Shape attached_;
  const Pose at_last_ = Pose::from_translation({0.0, 0.0, 0.2});
  std::vector<Placed> obstacles_;
  std::vector<std::size_t> padded_with_;  // obstacles from which the second link keeps kBetween
};

TEST(RobotConfirmedTruth, ConfigurationsAgreeWithFcl) {
  const std::vector<InstructionSet> sets = instruction_sets();
  Random random(seeded(271));
  int counts[2] = {}, alarms = 0;
  for (int i = 0; i < scaled(60, 12); ++i) {
    const VoxelScene scene(random, random.whole(3, 6));
    Checked spheres(scene.checker(best_instruction_set(), false));
    std::vector<double> queried;
    std::vector<std::uint8_t> expected;
    std::vector<double> gaps;
    for (int k = 0; k < 40; ++k) {
      const Configuration at = random_configuration(random, scene.robot(), k == 0 ? 200.0 : 1.5);
      const double gap = scene.gap(at);
      if (std::abs(gap) < kUnclear) continue;
      const bool is_free = gap > 0.0;
      gaps.push_back(gap);
      queried.insert(queried.end(), at.begin(), at.end());
      expected.push_back(is_free ? 1 : 0);
      ++counts[is_free];
      alarms += is_free && !spheres.free(at);
    }
    const auto variables = static_cast<std::size_t>(scene.robot().variable_count());
    for (const InstructionSet set : sets) {
      Checked checked(scene.checker(set, true));
      EXPECT_EQ(checked.free(queried, expected.size()), expected) << i;
      for (std::size_t k = 0; k < expected.size(); ++k) {
        const auto at = std::span(queried).subspan(k * variables, variables);
        ASSERT_EQ(checked.free(at), expected[k] != 0) << i << ' ' << k << ' ' << gaps[k];
        ASSERT_EQ(checked.explain(at).empty(), expected[k] != 0) << i << ' ' << k;
        ASSERT_LE(checked.clearance(at).lower, std::max(0.0, gaps[k]) + kUnclear);
      }
    }
  }
  EXPECT_GT(counts[0], effort(300, 20));
  EXPECT_GT(counts[1], effort(300, 20));
  EXPECT_GT(alarms, effort(100, 5));
}

TEST(RobotConfirmedTruth, NoContactInAMotionThatIsFree) {
  const std::vector<InstructionSet> sets = instruction_sets();
  Random random(seeded(272));
  VerdictCounts counts;
  int alarms = 0;
  for (int i = 0; i < scaled(60, 12); ++i) {
    const VoxelScene scene(random, random.whole(3, 6));
    Checked checked(scene.checker(sets[random.index(sets.size())], true));
    Checked spheres(scene.checker(best_instruction_set(), false));
    for (int k = 0; k < 8; ++k) {
      const Configuration from = random_configuration(random, scene.robot(), 1.5);
      const Configuration to =
          moved(from, random_configuration(random, scene.robot(), random.between(0.0, 0.6)));
      if (k % 4 != 0 && scene.gap(from) < 0.0) continue;
      const EdgeResult result = checked.edge(from, to, {.first = k % 2 == 0});
      double least = 1.0;
      constexpr int kSteps = 60;
      for (int step = 0; step <= kSteps; ++step) {
        const double t = static_cast<double>(step) / kSteps;
        const double gap = scene.gap(on_the_way(from, to, t));
        least = std::min(least, gap);
        if (result.verdict != Verdict::kFree && t >= result.free_until) continue;
        ASSERT_GT(gap, -kUnclear) << i << ' ' << k << ' ' << t;
      }
      if (result.verdict == Verdict::kCollision) {
        ASSERT_LT(scene.gap(on_the_way(from, to, result.contact_at)), kUnclear) << i << ' ' << k;
      }
      ASSERT_FALSE(least > 0.05 && result.verdict != Verdict::kFree) << "what is free by far";
      counts.count(result.verdict);
      alarms +=
          result.verdict == Verdict::kFree && spheres.edge(from, to).verdict != Verdict::kFree;
    }
  }
  EXPECT_GT(counts.free, effort(40, 5));
  EXPECT_GT(counts.hits, effort(40, 0));
  EXPECT_GT(alarms, effort(15, 0));
  EXPECT_LE(counts.unknown, 1 + (counts.free + counts.hits) / 50);
}

RobotModel turned(const std::shared_ptr<const CoveredMesh>& mesh) {
  RobotModel robot("base");
  robot.add_link("link", "base", wheel());
  robot.attach("link", cover_of(mesh));
  return robot;
}

// No surfaces touch, in configurations and all along a motion.
TEST(RobotConfirmedTruth, WhatIsInsideTouches) {
  Random random(seeded(274));
  const VoxelSolid small(random, 4, 0.05), large(random, 1, 2.0);
  const std::vector<ObstacleShape> inside = {cover_of(small.covered()),
                                             std::make_shared<const SolidMesh>(small.mesh()),
                                             Primitive(Box{{0.1, 0.2, 0.1}}),
                                             Primitive(SolidSphere{0.1}),
                                             Primitive(Capsule{0.1, 0.1}),
                                             Primitive(Cylinder{0.1, 0.1}),
                                             one_sphere_tree(Vector3d::Zero(), 0.1)};
  const std::vector<ObstacleShape> around = {cover_of(large.covered()),
                                             std::make_shared<const SolidMesh>(large.mesh())};
  for (const double padding : {0.0, 0.01}) {
    for (const bool is_inside : {true, false}) {  // the robot's body is
      for (const ObstacleShape& shape : is_inside ? around : inside) {
        RobotScene scene(turned((is_inside ? small : large).covered()));
        scene.set_padding("link", padding);
        scene.add("shape", shape, random.pose(0.1));
        Checked checked(scene, {.meshes = {small.covered(), large.covered()}});
        SCOPED_TRACE(testing::Message() << is_inside << ' ' << padding);
        const Configuration from = {0.0}, to = {3.0};
        EXPECT_FALSE(checked.free(from));
        EXPECT_EQ(checked.free(std::vector{0.0, 0.5, 1.0}, 3), std::vector<std::uint8_t>(3));
        EXPECT_FALSE(checked.explain(from).empty());
        EXPECT_EQ(checked.edge(from, to).verdict, Verdict::kCollision);
      }
    }
  }
}

// Clearance and padding together may be more than a query of two meshes takes.
TEST(RobotConfirmedTruth, TheLargestClearanceIsAccepted) {
  Random random(seeded(273));
  const VoxelSolid body(random, 4, 0.1);
  RobotScene scene(turned(body.covered()));
  scene.set_padding("link", 0.01);
  scene.add("box", Primitive(Box{{0.1, 0.1, 0.1}}), Pose::from_translation({5.0, 0.0, 0.0}));
  Checked checked(scene, {.meshes = {body.covered()}});
  EXPECT_TRUE(checked.checker.within(std::vector<double>{0.0}, kMaxCoordinate, checked.scratch));
}

}  // namespace
}  // namespace spherule::test
