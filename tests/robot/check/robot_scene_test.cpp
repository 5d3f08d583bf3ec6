// SPDX-License-Identifier: BSD-3-Clause
// Edits of a scene, intended contacts, and input that is refused.

#include "robot/check/robot_scene.h"

#include "base/error.h"
#include "collide/collide.h"
#include "collide/meshes/solid_mesh.h"
#include "collide/point_cloud.h"
#include "robot/model/kinematics.h"
#include "spheretree/sphere_tree.h"
#include "tests/robot/check/checked.h"
#include "tests/robot/robots.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace spherule::test::robot_scene_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::shared_ptr<const SphereTree> row(std::vector<Sphere> spheres) {
  return std::make_shared<const SphereTree>(build_tree(spheres));
}

// A base of a sphere of 0.2, and a slide along x that carries a torch: a nozzle of three spheres
// and a wire of two, whose tip reaches 0.5 ahead of the slide.
RobotModel welder() {
  RobotModel robot("base");
  robot.add_link("lift", "base", sliding(0.0, 1.0, "lift_joint", Eigen::Vector3d::UnitZ()));
  robot.add_link("slide", "lift", sliding(-2.0, 2.0, "slide_joint"));
  robot.attach("base", one_sphere_tree({0, 0, 0}, 0.2));
  robot.attach("slide", row({{{0.1, 0, 0}, 0.05},
                             {{0.2, 0, 0}, 0.05},
                             {{0.3, 0, 0}, 0.05},
                             {{0.4, 0, 0}, 0.01},
                             {{0.49, 0, 0}, 0.01}}));
  return robot;
}

bool is_free(const RobotScene& scene, double lift, double slide) {
  return Checked(scene).free(Configuration{lift, slide});
}

TEST(RobotScene, ObstaclesComeMoveAndGo) {
  RobotScene scene(welder());
  EXPECT_TRUE(is_free(scene, 1.0, 0.0));
  EXPECT_FALSE(is_free(scene, 0.0, -0.3)) << "in the base";
  scene.add("post", one_sphere_tree({0, 0, 0}, 0.1), Pose::from_translation({1, 0, 1}));
  Checked before(scene);
  EXPECT_TRUE(is_free(scene, 1.0, 0.3));
  EXPECT_FALSE(is_free(scene, 1.0, 0.6));
  scene.move("post", Pose::from_translation({0.7, 0, 1}));
  EXPECT_FALSE(is_free(scene, 1.0, 0.3));
  scene.add("board", Primitive(Box{{0.01, 1, 1}}), Pose::from_translation({0.5, 0, 1}));
  EXPECT_FALSE(is_free(scene, 1.0, 0.1));
  EXPECT_EQ(scene.obstacles(), (std::vector<std::string>{"board", "post"}));
  scene.remove("board");
  scene.remove("post");
  EXPECT_TRUE(is_free(scene, 1.0, 0.6));
  EXPECT_FALSE(before.free(Configuration{1.0, 0.6})) << "a snapshot does not change";
}

// What was an obstacle moves with the robot, and intersects what the robot alone would pass.
TEST(RobotScene, AnObstacleIsPickedUp) {
  RobotScene scene(welder());
  const auto part = one_sphere_tree({0, 0, 0}, 0.1);
  scene.add("part", part, Pose::from_translation({1, 0, 1}));
  scene.add("post", one_sphere_tree({0, 0, 0}, 0.1), Pose::from_translation({1.3, 0, 1.15}));
  EXPECT_FALSE(is_free(scene, 1.0, 0.6));
  scene.remove("part");
  EXPECT_TRUE(is_free(scene, 1.0, 0.6));
  EXPECT_TRUE(is_free(scene, 1.0, 0.8));
  scene.attach("part", "slide", part, Pose::from_translation({0.4, 0, 0}));
  EXPECT_TRUE(is_free(scene, 1.0, 0.6));
  EXPECT_FALSE(is_free(scene, 1.0, 0.8));
  const auto told = Checked(scene).explain(Configuration{1.0, 0.8});
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].first.kind, CheckedBody::Kind::kAttached);
  EXPECT_EQ(told[0].first.name, "part");
  EXPECT_EQ(told[0].second.name, "post");
  scene.detach("part");
  EXPECT_TRUE(is_free(scene, 1.0, 0.8));
}

TEST(RobotScene, PaddingKeepsApart) {
  RobotScene scene(welder());
  scene.add("post", one_sphere_tree({0, 0, 0}, 0.1), Pose::from_translation({1, 0, 1}));
  // The tip of the wire is 0.02 in front of the post.
  EXPECT_TRUE(is_free(scene, 1.0, 0.38));
  scene.set_padding("slide", 0.015);
  EXPECT_TRUE(is_free(scene, 1.0, 0.38));
  scene.set_padding("slide", "post", 0.01);
  EXPECT_FALSE(is_free(scene, 1.0, 0.38)) << "both count";
  EXPECT_NEAR(Checked(scene).clearance(Configuration{1.0, 0.3}).lower, 0.075, 1e-9);
  const auto told = Checked(scene).explain(Configuration{1.0, 0.38});
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NEAR(told[0].overlap_depth, 0.005, 1e-9);
  EXPECT_NEAR(told[0].padding, 0.025, 1e-12);
  scene.set_padding("slide", 0.0);
  EXPECT_TRUE(is_free(scene, 1.0, 0.38));
}

TEST(RobotScene, CloudsAreTrees) {
  RobotScene scene(welder());
  std::vector<Eigen::Vector3d> points;
  for (int i = -10; i <= 10; ++i) points.emplace_back(1.0, 0.01 * i, 1.0);
  scene.add("cloud", std::make_shared<const SphereTree>(point_cloud_tree(points, 0.005)), Pose());
  EXPECT_TRUE(is_free(scene, 1.0, 0.49));
  EXPECT_FALSE(is_free(scene, 1.0, 0.5));
}

// The tip of the wire may touch the seam, the rest of the wire and the nozzle may not; nor may the
// tip touch anything else.
TEST(RobotScene, OnlyARegionMayTouch) {
  for (const bool is_tree : {true, false}) {
    RobotScene scene(welder());
    const ObstacleShape shape = is_tree ? ObstacleShape(one_sphere_tree({0, 0, 0}, 0.02))
                                        : ObstacleShape(Primitive(SolidSphere{0.02}));
    scene.add("seam", shape, Pose::from_translation({1, 0, 1}));
    scene.add("clamp", shape, Pose::from_translation({1, 0, 0.5}));
    EXPECT_FALSE(is_free(scene, 1.0, 0.5));
    scene.define_region({"slide", "tip"}, Sphere{{0.49, 0, 0}, 0.02});
    EXPECT_FALSE(is_free(scene, 1.0, 0.5)) << "a name alone allows nothing";
    scene.allow_contact(Region{"slide", "tip"}, "seam");
    EXPECT_TRUE(is_free(scene, 1.0, 0.5));
    EXPECT_FALSE(is_free(scene, 1.0, 0.6)) << "the wire";
    EXPECT_FALSE(is_free(scene, 1.0, 0.7)) << "the nozzle";
    EXPECT_FALSE(is_free(scene, 0.5, 0.5)) << "the clamp";
    const auto told = Checked(scene).explain(Configuration{1.0, 0.6});
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].first.name, "slide");
    EXPECT_EQ(told[0].first.sphere, 3) << "as the link's tree numbers it";
    const std::vector<BodySphere> wire = {{0, 3}, {0, 4}};
    scene.define_region({"slide", "tip"}, wire);
    EXPECT_TRUE(is_free(scene, 1.0, 0.6)) << "a region that was replaced";
    EXPECT_FALSE(is_free(scene, 1.0, 0.7));
    scene.allow_contact("slide", "seam");
    EXPECT_TRUE(is_free(scene, 1.0, 0.7));
    scene.forbid_contact("slide", "seam");
    EXPECT_FALSE(is_free(scene, 1.0, 0.7));
    EXPECT_TRUE(is_free(scene, 1.0, 0.6));
    scene.forbid_contact(Region{"slide", "tip"}, "seam");
    EXPECT_FALSE(is_free(scene, 1.0, 0.6));
    scene.allow_contact(Region{"slide", "tip"}, "seam");
    scene.remove("seam");
    scene.add("seam", shape, Pose::from_translation({1, 0, 1}));
    EXPECT_FALSE(is_free(scene, 1.0, 0.5)) << "what was allowed went with the obstacle";
    // All spheres.
    scene.define_region({"slide", "tip"}, Sphere{{0, 0, 0}, 9.0});
    scene.allow_contact(Region{"slide", "tip"}, "seam");
    EXPECT_TRUE(is_free(scene, 1.0, 0.7));
  }
}

TEST(RobotScene, RegionsOfToolsAndLinks) {
  RobotScene scene(welder());
  scene.attach("gripper", "slide", row({{{0.6, 0, 0}, 0.02}, {{0.7, 0, 0}, 0.02}}),
               Pose::from_translation({0, 0, -0.1}));
  // At the lift of 0.1 the gripper is level with the base, which it intersects coming from the
  // left.
  EXPECT_TRUE(is_free(scene, 0.1, -1.0));
  EXPECT_FALSE(is_free(scene, 0.1, -0.7));
  scene.define_region({"gripper", "jaw"}, std::vector<BodySphere>{{0, 1}});
  scene.allow_contact(Region{"gripper", "jaw"}, "base");
  EXPECT_TRUE(is_free(scene, 0.1, -0.9));
  EXPECT_FALSE(is_free(scene, 0.1, -0.7)) << "the other sphere";
  EXPECT_EQ(scene.attached(), std::vector<std::string>{"gripper"});
  scene.detach("gripper");
  EXPECT_TRUE(scene.attached().empty());
  EXPECT_THROW(scene.allow_contact(Region{"gripper", "jaw"}, "base"), Error);
  scene.attach("gripper", "slide", row({{{0.6, 0, 0}, 0.02}}), Pose());
  EXPECT_THROW(scene.allow_contact(Region{"gripper", "jaw"}, "base"), Error) << "went with it";
}

// An attached tool is tested against the link that its flange's link is joined to.
TEST(RobotScene, AToolHasNoPartInItsLinksRights) {
  RobotModel robot("base");
  robot.add_link("wrist", "base", wheel("", Eigen::Vector3d::UnitY()));
  robot.attach("base", row({{{0, 0, -0.5}, 0.1}, {{0, 0, 0}, 0.1}}));
  robot.attach("wrist", one_sphere_tree({0, 0, 0}, 0.1));
  RobotScene scene(robot);
  const auto free = [&](double q) { return Checked(scene).free(Configuration{q}); };
  EXPECT_TRUE(free(3.0)) << "adjacent";
  scene.attach("pole", "wrist", one_sphere_tree({0, 0, 0.5}, 0.05));
  EXPECT_TRUE(free(0.0));
  EXPECT_FALSE(free(3.0)) << "the pole is turned onto the base";
  scene.allow_contact("pole", "base");
  EXPECT_TRUE(free(3.0));
  scene.forbid_contact("base", "pole");
  EXPECT_FALSE(free(3.0));
}

TEST(RobotScene, EdgesOfAllowedPairs) {
  RobotModel robot = welder();
  RobotScene scene(robot);
  EXPECT_FALSE(is_free(scene, 0.0, -0.3));
  AllowedCollisions allowed = scene.allowed_collisions();
  allowed.allow("base", "slide");
  scene.set_allowed_collisions(allowed);
  EXPECT_TRUE(is_free(scene, 0.0, -0.3));
  EXPECT_THROW(scene.set_allowed_collisions(AllowedCollisions(RobotModel("other"))), Error);
}

TEST(RobotScene, RefusesBadEdits) {
  RobotScene scene(welder());
  const auto tree = one_sphere_tree({0, 0, 0}, 0.1);
  scene.add("post", tree, Pose::from_translation({5, 0, 0}));
  scene.attach("tool", "slide", tree);
  for (const char* taken : {"base", "post", "tool", ""}) {
    EXPECT_THROW(scene.add(taken, tree), Error);
    EXPECT_THROW(scene.attach(taken, "slide", tree), Error);
  }
  EXPECT_THROW(scene.add("a", std::shared_ptr<const SphereTree>()), Error);
  EXPECT_THROW(scene.add("a", std::shared_ptr<const SolidMesh>()), Error);
  EXPECT_THROW(scene.add("a", Primitive(SolidSphere{0.0})), Error);
  EXPECT_THROW(scene.add("a", Primitive(Box{{1, 1, kNan}})), Error);
  EXPECT_THROW(scene.attach("a", "nose", tree), Error);
  EXPECT_THROW(scene.attach("a", "post", tree), Error);
  EXPECT_THROW(scene.attach("a", "slide", nullptr), Error);
  for (const char* none : {"base", "tool", "nose", ""}) {
    EXPECT_THROW(scene.move(none, Pose()), Error);
    EXPECT_THROW(scene.remove(none), Error);
  }
  for (const char* none : {"base", "post", "nose"}) EXPECT_THROW(scene.detach(none), Error);
  for (const double bad : {-1e-9, kNan, kInfinity, 1e16}) {
    EXPECT_THROW(scene.set_padding("slide", bad), Error);
    EXPECT_THROW(scene.set_padding("slide", "post", bad), Error);
  }
  EXPECT_THROW(scene.set_padding("post", 0.1), Error) << "no body";
  EXPECT_THROW(scene.set_padding("post", "slide", 0.1), Error) << "the body comes first";
  EXPECT_THROW(scene.set_padding("slide", "slide", 0.1), Error);
  EXPECT_THROW(scene.set_padding("slide", "nose", 0.1), Error);
  EXPECT_THROW(scene.allow_contact("nose", "post"), Error);
  EXPECT_THROW(scene.allow_contact("post", "slide"), Error);
  EXPECT_THROW(scene.allow_contact("slide", "slide"), Error);
  EXPECT_THROW(scene.allow_contact(Region{"slide", "tip"}, "post"), Error);
  EXPECT_THROW(scene.forbid_contact(Region{"slide", "tip"}, "post"), Error);
  using Spheres = std::vector<BodySphere>;
  EXPECT_THROW(scene.define_region({"slide", "tip"}, Spheres{}), Error);
  EXPECT_THROW(scene.define_region({"slide", "tip"}, Spheres{{0, 5}}), Error);
  EXPECT_THROW(scene.define_region({"slide", "tip"}, Spheres{{0, -1}}), Error);
  EXPECT_THROW(scene.define_region({"slide", "tip"}, Spheres{{1, 0}}), Error);
  EXPECT_THROW(scene.define_region({"slide", ""}, Spheres{{0, 0}}), Error);
  EXPECT_THROW(scene.define_region({"post", "tip"}, Spheres{{0, 0}}), Error);
  EXPECT_THROW(scene.define_region({"slide", "tip"}, Sphere{{9, 9, 9}, 0.1}), Error);
  EXPECT_THROW(scene.define_region({"slide", "tip"}, Sphere{{0, 0, 0}, kNan}), Error);
  EXPECT_EQ(scene.obstacles(), std::vector<std::string>{"post"});
  EXPECT_EQ(scene.attached(), std::vector<std::string>{"tool"});
  EXPECT_TRUE(is_free(scene, 1.0, 0.0));
  scene.add("far", one_sphere_tree({1e15, 0, 0}, 1.0), Pose::from_translation({1e15, 0, 0}));
  EXPECT_THROW((void)scene.snapshot(), Error);
}

TEST(RobotScene, RefusesBadConfigurations) {
  RobotScene scene(welder());
  scene.add("post", one_sphere_tree({0, 0, 0}, 0.1), Pose::from_translation({5, 0, 0}));
  const Configuration good = {1.0, 0.0};
  const Configuration touching = {0.0, -0.3};
  for (const bool enforce : {false, true}) {
    Checked checked(scene, {.enforce_limits = enforce});
    const RobotChecker& checker = checked.checker;
    std::vector<RobotChecker::Scratch> two;
    for (int i = 0; i < 2; ++i) two.emplace_back(checker);
    std::vector<std::uint8_t> answers(1);
    for (const Configuration& bad : {Configuration{},
                                     {1.0},
                                     {1.0, 0.0, 0.0},
                                     {kNan, 0.0},
                                     {0.0, kInfinity},
                                     {-kInfinity, 0.0}}) {
      EXPECT_THROW((void)checked.free(bad), Error);
      EXPECT_THROW((void)checked.free(bad, 1), Error);
      EXPECT_THROW(checker.check_configs(bad, two, answers), Error);
      EXPECT_THROW((void)checked.edge(bad, good), Error);
      EXPECT_THROW((void)checked.edge(good, bad), Error);
      EXPECT_THROW((void)checker.measure_edge(good, bad, checked.scratch), Error);
      EXPECT_THROW((void)checked.clearance(bad), Error);
      EXPECT_THROW((void)checker.within(bad, 0.1, checked.scratch), Error);
      EXPECT_THROW((void)checked.explain(bad), Error);
    }
    EXPECT_THROW((void)checked.edge(good, {1.0, 101.0}), Error);
    for (const double bad : {0.0, -1.0, kNan}) {
      EXPECT_THROW((void)checked.edge(good, good, {.resolution = bad}), Error);
      EXPECT_THROW((void)checked.edge(touching, good, {.resolution = bad}), Error);
      EXPECT_THROW((void)checker.measure_edge(good, good, checked.scratch, bad), Error);
      EXPECT_THROW((void)checker.within(good, bad - 1.0, checked.scratch), Error);
    }
    EXPECT_THROW((void)checked.free(good, 2), Error);
    EXPECT_THROW(checker.check_configs(good, std::span<RobotChecker::Scratch>(), answers), Error);
    EXPECT_TRUE(checked.free({}, 0).empty());
    checker.check_configs({}, two, {});
    // A large position is answered all the same.
    EXPECT_EQ(checked.free(Configuration{1.0, 150.0}), !enforce);
    EXPECT_EQ(checked.free(Configuration{1.5, 0.0}), !enforce);
  }
}

// Of a robot whose links carried no spheres yet, base and tool are adjacent.
TEST(RobotScene, AdjacencyIsThatOfItsOwnSpheres) {
  const auto robot = [](bool has_spheres) {
    RobotModel model("base");
    model.add_link("arm", "base", turning(-3.0, 3.0));
    model.add_link("tool", "arm", {.parent_from_joint = Pose::from_translation({1, 0, 0})});
    if (!has_spheres) return model;
    model.attach("base", one_sphere_tree({-1, 0, 0}, 0.3));
    model.attach("arm", one_sphere_tree({0.5, 0, 0}, 0.1));
    model.attach("tool", one_sphere_tree({0, 0, 0}, 0.1));
    return model;
  };
  RobotScene scene(robot(true));
  AllowedCollisions bare(robot(false));
  ASSERT_EQ(bare.reason(0, 2), AllowedReason::kAdjacent);
  scene.set_allowed_collisions(bare);
  EXPECT_EQ(scene.allowed_collisions().reason(0, 2), AllowedReason::kTested);
  EXPECT_EQ(scene.allowed_collisions().reason(0, 1), AllowedReason::kAdjacent);
  EXPECT_EQ(scene.allowed_collisions().reason(1, 2), AllowedReason::kRigid);
  EXPECT_FALSE(Checked(scene).free(Configuration{3.1}));
  bare.forbid("base", "tool");
  bare.allow("base", "tool");
  scene.set_allowed_collisions(bare);
  EXPECT_EQ(scene.allowed_collisions().reason(0, 2), AllowedReason::kGiven);
}

TEST(RobotScene, PaddingsAddUpToNoLess) {
  RobotScene scene(welder());
  scene.add("board", Primitive(Box{{1, 1, 1}}));
  scene.set_padding("slide", 1.0);
  scene.set_padding("slide", "board", 1e-17);
  bool is_found = false;
  for (const CheckedContact& contact : Checked(scene).explain(Configuration{0.0, 0.0})) {
    if (contact.first.name != "slide" || contact.second.name != "board") continue;
    is_found = true;
    EXPECT_GT(contact.padding, 1.0);
  }
  EXPECT_TRUE(is_found);
}

// The scene has changed: what a scratch remembers of the old one is of no use.
TEST(RobotScene, RefusesTheScratchOfAnotherSnapshot) {
  RobotScene scene(welder());
  scene.add("post", one_sphere_tree({0, 0, 0}, 0.1), Pose::from_translation({5, 0, 0}));
  std::optional<RobotChecker> before(scene.snapshot());
  std::vector<RobotChecker::Scratch> old;
  old.emplace_back(*before);
  const RobotChecker copy = *before;
  const Configuration q = {1.0, 0.0};
  EXPECT_TRUE(copy.check_config(q, old[0]));
  scene.move("post", Pose::from_translation({0.3, 0, 1}));
  std::vector<std::uint8_t> answers(1);
  for (int i = 0; i < 2; ++i) {
    const RobotChecker checker = scene.snapshot();
    EXPECT_THROW((void)checker.check_config(q, old[0]), Error);
    EXPECT_THROW(checker.check_configs(q, old[0], answers), Error);
    EXPECT_THROW(checker.check_configs(q, old, answers), Error);
    EXPECT_THROW((void)checker.check_edge(q, q, old[0]), Error);
    EXPECT_THROW((void)checker.check_edges(q, q, old), Error);
    EXPECT_THROW((void)checker.measure_edge(q, q, old[0]), Error);
    EXPECT_THROW((void)checker.clearance(q, old[0]), Error);
    EXPECT_THROW((void)checker.within(q, 0.1, old[0]), Error);
    EXPECT_THROW((void)checker.explain(q, old[0]), Error);
    // Also where so few are not shared out, so that only the first scratch is used.
    std::vector<RobotChecker::Scratch> mixed;
    mixed.emplace_back(checker);
    mixed.push_back(std::move(old[0]));
    EXPECT_THROW(checker.check_configs(q, mixed, answers), Error);
    old[0] = std::move(mixed[1]);
    before.reset();  // the next may lie where it lay
  }
}

// Nothing is tested of a robot without spheres, and nothing in an empty scene.
TEST(RobotScene, EmptyOnesAreFree) {
  Checked checked{RobotScene(RobotModel("alone"))};
  EXPECT_TRUE(checked.free({}));
  EXPECT_EQ(checked.edge({}, {}).verdict, Verdict::kFree);
  EXPECT_EQ(checked.clearance({}).lower, kInfinity);
  EXPECT_TRUE(checked.explain({}).empty());
  RobotScene scene(RobotModel("alone"));
  EXPECT_THROW((void)scene.snapshot({.meshes = {nullptr}}), Error);
  scene.add("ball", one_sphere_tree({0, 0, 0}, 1.0));
  EXPECT_TRUE(Checked(scene).free({}));
}

// The far end of a mimic rounds by more than the bounds for the usual range allow for.
TEST(RobotSceneMimics, FarOnesAreMetToTheLastDigits) {
  RobotModel robot("base");
  robot.add_link("slide", "base", sliding(-1.0, 1.0, "lead"));
  robot.add_link("a", "slide", sliding(-1.0, 1.0, "far", {1, 2, 3}));
  robot.mimic("far", "lead", 1e8);
  Joint joint = wheel("turn", {0.3, 0.5, 0.8});
  joint.parent_from_joint = Pose::from_translation({0.3, 0.1, 0.2});
  robot.add_link("b", "a", joint);
  robot.attach("a", one_sphere_tree({0.1234, 0.2345, 0.345}, 0.1));
  robot.attach("b", one_sphere_tree({0.3, -0.2, 0.1}, 0.1));
  const Pose root(Eigen::Quaterniond(0.3, 0.5, 0.1, 0.7), {0.1, 0.2, 0.3});
  RobotScene scene(robot, root);
  AllowedCollisions allowed(robot);
  allowed.forbid("a", "b");
  scene.set_allowed_collisions(allowed);
  Checked checked(scene);
  std::vector<Pose> poses;
  const auto touches = [&](double lead, double turn) {
    forward_kinematics(robot, Configuration{lead, turn}, poses, root);
    return collides(*robot.links()[2].trees[0], poses[2], *robot.links()[3].trees[0], poses[3]);
  };
  int touching = 0;
  for (int i = 0; i < 200; ++i) {
    const double lead = 0.5 + 0.0024681357 * i;
    for (double turn = -3.1; turn < 3.1; turn += 0.15) {
      double in = turn;
      double out = turn + 0.15;
      if (touches(lead, in) == touches(lead, out)) continue;
      if (!touches(lead, in)) std::swap(in, out);
      for (int halving = 0; halving < 60; ++halving) {
        const double middle = 0.5 * (in + out);
        (touches(lead, middle) ? in : out) = middle;
      }
      ++touching;
      EXPECT_FALSE(checked.free(Configuration{lead, in})) << lead << ' ' << in;
      EXPECT_EQ(checked.clearance(Configuration{lead, in}).lower, 0.0);
    }
  }
  EXPECT_GT(touching, 100);
}

}  // namespace
}  // namespace spherule::test::robot_scene_test
