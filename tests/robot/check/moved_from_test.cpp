// SPDX-License-Identifier: BSD-3-Clause
// Objects whose content was moved to others: none is read where nothing is. Each query throws Error
// or ends the program with a message, answers what the object said before, or says that it knows
// nothing.
#include "base/error.h"
#include "collide/collide.h"
#include "collide/mechanism/mechanism_check.h"
#include "collide/meshes/mesh_contact.h"
#include "collide/meshes/solid_mesh.h"
#include "collide/solids/primitive.h"
#include "collide/solids/solid_within.h"
#include "geometry/mesh_distance.h"
#include "robot/check/robot_collision.h"
#include "robot/check/robot_scene.h"
#include "robot/model/kinematics.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/free_boxes.h"
#include "robot/pairs/link_pairs.h"
#include "spheretree/build.h"
#include "spheretree/level_tree.h"
#include "tests/collide/tetrahedra.h"
#include "tests/collide/trees.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace spherule::test::moved_from_test {
namespace {

using Eigen::Vector3d;

const Pose kHere;
const Pose kFar(Eigen::Quaterniond::Identity(), Vector3d(100.0, 0.0, 0.0));

// Where the content goes; what is left stays in `object`.
template <class Object>
Object taken_from(Object& object) {
  return std::move(object);
}

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

std::shared_ptr<const SphereTree> around_it() {
  return one_sphere_tree({0.3, 0.3, 0.3}, 2.0);
}

TEST(MovedFrom, SphereTree) {
  const SphereTree other = *around_it();
  SphereTree tree = other;
  const SphereTree taken = taken_from(tree);
  EXPECT_TRUE(collides(taken, kHere, other, kHere));
  EXPECT_EQ(tree.node_count(), 0u);
  EXPECT_TRUE(tree.spheres().empty());
  EXPECT_THROW(tree.level(0), Error);
  EXPECT_THROW(cut(tree, 3), Error);
  EXPECT_THROW(refit(tree, {}), Error);
  // Wherever they stand: it must not count as free because nothing is there.
  for (const Pose& pose : {kHere, kFar}) {
    EXPECT_THROW(collide(tree, pose, other, kHere), Error);
    EXPECT_THROW(collide(other, kHere, tree, pose), Error);
    EXPECT_THROW(distance(tree, pose, other, kHere), Error);
    EXPECT_THROW(within(other, pose, tree, kHere, 1.0), Error);
    EXPECT_THROW(collide(tree, pose, Primitive(SolidSphere{1.0}), kHere), Error);
    EXPECT_DEATH(collides(tree, pose, other, kHere), "SphereTree: its content was moved");
    EXPECT_DEATH(collides(other, pose, tree, kHere), "SphereTree: its content was moved");
    EXPECT_DEATH(collides(tree, pose, Primitive(SolidSphere{1.0}), kHere),
                 "SphereTree: its content was moved");
  }
  RobotModel robot;
  EXPECT_THROW(robot.attach("base_link", std::make_shared<const SphereTree>(tree)), Error);
  // It can be given content again.
  tree = other;
  EXPECT_TRUE(collides(tree, kHere, other, kHere));
  SphereTree second = *around_it();
  tree = std::move(second);
  EXPECT_TRUE(collides(tree, kHere, other, kHere));
  EXPECT_THROW(second.level(0), Error);  // NOLINT(bugprone-use-after-move)
}

TEST(MovedFrom, Meshes) {
  const SphereTree other = *around_it();
  MeshTree surface(tetrahedron());
  const MeshTree taken_surface = taken_from(surface);
  SolidMesh solid(tetrahedron());
  const SolidMesh taken_solid = taken_from(solid);
  CoveredMesh covered(tetrahedron(), around_it());
  const CoveredMesh taken_covered = taken_from(covered);
  EXPECT_TRUE(collides(other, kHere, taken_surface, kHere));
  EXPECT_TRUE(collides(other, kHere, taken_solid, kHere));
  EXPECT_TRUE(collides(taken_covered, kHere, taken_covered, kHere));
  for (const Pose& pose : {kHere, kFar}) {
    EXPECT_THROW(collide(other, pose, surface, kHere), Error);
    EXPECT_THROW(distance(other, pose, surface, kHere), Error);
    EXPECT_THROW(distance(other, pose, solid, kHere), Error);
    EXPECT_DEATH(within(other, pose, solid, kHere, 1.0), "SphereTree: its content was moved");
    EXPECT_THROW(within(solid, pose, taken_solid, kHere, 1.0), Error);
    EXPECT_DEATH(deepest_contact(other, pose, solid, kHere), "its content was moved");
    EXPECT_DEATH(collides(other, pose, surface, kHere), "SphereTree: its content was moved");
    EXPECT_DEATH(collides(other, pose, solid, kHere), "SphereTree: its content was moved");
  }
  EXPECT_DEATH(collides(covered, kHere, taken_covered, kHere), "its content was moved");
  EXPECT_DEATH(collides(other, kHere, covered.mesh(), kHere), "its content was moved");
  // Kept: what the queries share.
  EXPECT_TRUE(solid.is_closed());
  EXPECT_TRUE(covered.solid().has_inside());
  EXPECT_EQ(covered.cover().node_count(), 1u);
  RobotScene scene{RobotModel()};
  EXPECT_THROW(scene.add("solid", std::make_shared<const SolidMesh>(solid)), Error);
}

TEST(MovedFrom, MeshDistance) {
  MeshDistance distance(tetrahedron());
  const MeshDistance taken = taken_from(distance);
  EXPECT_GT(taken(Vector3d(2, 2, 2)).lower, 1.0);
  EXPECT_THROW(distance(Vector3d::Zero()), Error);
  EXPECT_THROW(distance.winding_number(Vector3d(0.1, 0.1, 0.1)), Error);
  const auto all = [](const MeshDistance::Corners&) { return true; };
  EXPECT_THROW(distance.visit_ray(Vector3d::Zero(), Vector3d::Ones(), all), Error);
  EXPECT_THROW(distance.visit_all(all), Error);
}

TEST(MovedFrom, MechanismCheck) {
  const std::vector<MechanismFrame> frames(1);
  const std::vector<MechanismBody> bodies = {{.frame = 0, .tree = around_it()}};
  const std::vector<MechanismObstacle> obstacles = {{.tree = around_it()}};
  const std::vector<MechanismPair> pairs = {{0, 0}};
  MechanismCheck check(frames, bodies, obstacles, pairs, 0.0);
  MechanismCheck::Scratch scratch(check);
  const std::array position = {0.0};
  const auto touches = [](const MechanismContact&) { return true; };
  const MechanismCheck taken = taken_from(check);
  EXPECT_TRUE(taken.collides(position, scratch, touches));
  EXPECT_TRUE(check.collides(position, scratch, touches));
  const MechanismCheck::Scratch taken_scratch = taken_from(scratch);
  EXPECT_THROW(taken.collides(position, scratch, touches), Error);
  EXPECT_THROW(taken.is_free_along(position, position, scratch), Error);
  EXPECT_THROW(taken.is_following(scratch), Error);
}

TEST(MovedFrom, RobotCheckerAndScene) {
  RobotModel robot;
  robot.attach("base_link", around_it());
  RobotScene scene(robot);
  scene.add("wall", around_it());
  RobotScene taken_scene = taken_from(scene);
  EXPECT_THROW(scene.snapshot(), Error);
  EXPECT_THROW(scene.attach("tool", "base_link", around_it()), Error);
  EXPECT_THROW(scene.set_padding("base_link", 1.0), Error);
  EXPECT_THROW(scene.move("wall", kFar), Error);
  EXPECT_THROW(scene.reason("base_link", "base_link"), Error);
  EXPECT_TRUE(scene.robot().links().empty());

  RobotChecker checker = taken_scene.snapshot();
  const RobotChecker taken = taken_from(checker);
  EXPECT_EQ(checker.robot().links().size(), 1u);
  RobotChecker::Scratch scratch(checker);
  EXPECT_FALSE(taken.check_config({}, scratch));
  EXPECT_FALSE(checker.check_config({}, scratch));
  const RobotChecker::Scratch taken_scratch = taken_from(scratch);
  EXPECT_THROW(taken.check_config({}, scratch), Error);
  EXPECT_THROW(taken.check_edge({}, {}, scratch), Error);
  EXPECT_THROW(taken.within({}, 1.0, scratch), Error);
  EXPECT_THROW(taken.clearance({}, scratch), Error);
  EXPECT_THROW(taken.explain({}, scratch), Error);

  const RobotModel taken_robot = taken_from(robot);
  EXPECT_EQ(taken_robot.links().size(), 1u);
  EXPECT_EQ(robot.find_link("base_link"), -1);
  EXPECT_THROW(robot.attach("base_link", around_it()), Error);
  EXPECT_THROW(RobotScene(robot).snapshot(), Error);
  EXPECT_THROW(robot.check_cache(), Error);
  std::vector<Pose> poses;
  EXPECT_THROW(forward_kinematics(robot, {}, poses), Error);
  forward_kinematics(taken_robot, {}, poses);
  EXPECT_TRUE(robot_collides(taken_robot, poses, *around_it(), kHere));
  EXPECT_DEATH(robot_collides(robot, poses, *around_it(), kHere),
               "RobotModel: its content was moved");
}

TEST(MovedFrom, AllowedCollisions) {
  RobotModel robot("base");
  robot.add_link("arm", "base", {.name = "turn", .type = JointType::kRevolute});
  AllowedCollisions allowed(robot);
  const AllowedCollisions taken = taken_from(allowed);
  EXPECT_TRUE(taken.allows(0, 1));
  EXPECT_FALSE(allowed.allows(0, 1));
  EXPECT_EQ(allowed.reason(0, 1), AllowedReason::kTested);
  EXPECT_TRUE(allowed.pairs().empty());
  EXPECT_THROW(allowed.allows("base", "arm"), Error);
  EXPECT_THROW(allowed.allow("base", "arm"), Error);
  EXPECT_THROW(allowed.require_robot(robot), Error);
}

TEST(MovedFrom, Proofs) {
  FreeBoxes boxes({}, std::string(1, '\1'));
  const FreeBoxes taken = taken_from(boxes);
  EXPECT_TRUE(taken.contains({}));
  EXPECT_FALSE(boxes.contains({}));
  EXPECT_FALSE(boxes.contains_edge({}, {}));
  EXPECT_FALSE(boxes.has_free_box());
  EXPECT_FALSE(boxes.is_all_free());
  EXPECT_EQ(boxes.node_count(), 0u);
  EXPECT_THROW(boxes.for_each_leaf([](bool, auto, auto) {}), Error);

  LinkPair pair;
  pair.first = 0;
  pair.second = 1;
  LinkPairs pairs({pair}, 2, 1, 1);
  const LinkPairs taken_pairs = taken_from(pairs);
  EXPECT_NE(taken_pairs.find(0, 1), nullptr);
  EXPECT_EQ(pairs.find(0, 1), nullptr);
  EXPECT_FALSE(pairs.is_free(0, 1, {}));
}

}  // namespace
}  // namespace spherule::test::moved_from_test
