// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "collide/collide.h"
#include "robot/check/robot_collision.h"
#include "robot/check/scene_setup.h"
#include "robot/model/kinematics.h"
#include "robot/pairs/allowed_collisions.h"
#include "robot/pairs/srdf_judgement.h"
#include "tests/robot/box_robots.h"
#include "tests/robot/check/checked.h"
#include "tests/robot/check/checked_scene.h"
#include "tests/robot/robots.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/exact/poses.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

// What touches what: non-empty exactly if the robot collides, and what is said of each contact.

namespace spherule::test::robot_explain_test {
namespace {

struct Scene {
  RobotModel robot{"base"};
  std::vector<PlacedTree> obstacles{};
  ObstacleOptions options{};

  const CoveredMesh* mesh_of(const SphereTree& tree) const {
    for (const auto& mesh : options.meshes) {
      if (&mesh->cover() == &tree) return mesh.get();
    }
    return nullptr;
  }
};

// How deep two spheres overlap, to some 18 digits of the scene.
double overlap(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
               const Pose& world_from_b, const SpherePair& pair) {
  using Number = long double;
  const Sphere& of_a = a.spheres()[static_cast<std::size_t>(pair.a)];
  const Sphere& of_b = b.spheres()[static_cast<std::size_t>(pair.b)];
  const Number distance =
      std::sqrt(squared_distance(transform(world_from_a, exact<Number>(of_a.center)),
                                 transform(world_from_b, exact<Number>(of_b.center))));
  return static_cast<double>(Number(of_a.radius) + Number(of_b.radius) - distance);
}

// By link and obstacle, where they collide: the deepest overlap of two spheres that touch and,
// where meshes are queried, under which triangles touch, if there are any.
using Depths = std::map<std::pair<std::size_t, std::size_t>, double>;

Depths expected_depths(const Scene& scene, std::span<const double> configuration) {
  std::vector<Pose> poses;
  forward_kinematics(scene.robot, configuration, poses, scene.options.world_from_root);
  Depths result;
  for (std::size_t link = 0; link < scene.robot.links().size(); ++link) {
    for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
      const SphereTree& other = *scene.obstacles[i].tree;
      const Pose& world_from_other = scene.obstacles[i].world_from_tree;
      for (const auto& tree : scene.robot.links()[link].trees) {
        const CoveredMesh* const mesh = scene.mesh_of(*tree);
        const CoveredMesh* const other_mesh = scene.mesh_of(other);
        const bool confirmed = mesh != nullptr && other_mesh != nullptr;
        if (!collides(*tree, poses[link], other, world_from_other)) continue;
        if (confirmed && !collides(*mesh, poses[link], *other_mesh, world_from_other)) continue;
        if (!confirmed && mesh != nullptr &&
            !collides(other, world_from_other, mesh->solid(), poses[link])) {
          continue;
        }
        if (!confirmed && other_mesh != nullptr &&
            !collides(*tree, poses[link], other_mesh->solid(), world_from_other)) {
          continue;
        }
        double deepest = -std::numeric_limits<double>::infinity();
        double deepest_unconfirmed = deepest;
        for (const SpherePair& pair : collide(*tree, poses[link], other, world_from_other).pairs) {
          const bool counts = !confirmed || triangles_touch(*mesh, pair.a, poses[link], *other_mesh,
                                                            pair.b, world_from_other);
          double& depth = counts ? deepest : deepest_unconfirmed;
          depth = std::max(depth, overlap(*tree, poses[link], other, world_from_other, pair));
        }
        if (!std::isfinite(deepest)) deepest = deepest_unconfirmed;
        const auto [at, is_new] = result.emplace(std::pair(link, i), deepest);
        at->second = std::max(at->second, deepest);
      }
    }
  }
  return result;
}

struct Count {
  int none = 0;
  int one = 0;
  int many = 0;
  int inside = 0;
};

// Queries all contacts of a configuration and the first few.
void expect_explained(const Scene& scene, Checked& checked, std::span<const double> configuration,
                      Count& count) {
  const Depths expected = expected_depths(scene, configuration);
  const std::vector<CheckedContact> contacts = checked.explain(configuration);
  ASSERT_EQ(contacts.empty(), checked.free(configuration));
  ASSERT_EQ(contacts.size(), expected.size());
  std::vector<Pose> poses;
  forward_kinematics(scene.robot, configuration, poses, scene.options.world_from_root);
  std::set<std::pair<std::size_t, std::size_t>> seen;
  for (const CheckedContact& found : contacts) {
    const auto link = static_cast<std::size_t>(scene.robot.find_link(found.first.name));
    std::size_t obstacle = 0;
    while (obstacle_name(obstacle) != found.second.name) ++obstacle;
    const std::pair place(link, obstacle);
    ASSERT_TRUE(seen.insert(place).second);
    const auto depth = expected.find({link, obstacle});
    ASSERT_NE(depth, expected.end());
    const SphereTree& tree = *scene.robot.links()[link].trees.at(found.first.tree);
    const PlacedTree& other = scene.obstacles.at(obstacle);
    const SpherePair spheres{found.first.sphere, found.second.sphere};
    const double slack = collision_slack(tree, poses[link], *other.tree, other.world_from_tree);
    ASSERT_NEAR(found.overlap_depth, depth->second, 2.0 * slack);
    ASSERT_LE(found.overlap_depth,
              overlap(tree, poses[link], *other.tree, other.world_from_tree, spheres));
    ASSERT_TRUE(
        spheres_touch(tree, spheres.a, poses[link], *other.tree, spheres.b, other.world_from_tree));
    const CoveredMesh* const mesh = scene.mesh_of(tree);
    const CoveredMesh* const other_mesh = scene.mesh_of(*other.tree);
    if (mesh != nullptr && other_mesh != nullptr) {
      const bool do_triangles = triangles_touch(*mesh, spheres.a, poses[link], *other_mesh,
                                                spheres.b, other.world_from_tree);
      ASSERT_TRUE(do_triangles ||
                  contains_component(*mesh, poses[link], *other_mesh, other.world_from_tree));
      count.inside += do_triangles ? 0 : 1;
    }
  }
  for (const std::size_t limit : {0U, 1U, 2U}) {
    const std::vector<CheckedContact> some =
        checked.explain(configuration, {.max_contacts = limit});
    ASSERT_EQ(some.size(), std::min(limit, contacts.size()));
    for (std::size_t k = 0; k < some.size(); ++k) {
      ASSERT_EQ(some[k].first.name, contacts[k].first.name);
      ASSERT_EQ(some[k].first.tree, contacts[k].first.tree);
      ASSERT_EQ(some[k].first.sphere, contacts[k].first.sphere);
      ASSERT_EQ(some[k].second.name, contacts[k].second.name);
      ASSERT_EQ(some[k].second.sphere, contacts[k].second.sphere);
    }
  }
  (contacts.empty() ? count.none : contacts.size() == 1 ? count.one : count.many) += 1;
}

// Along a path, so that the scratch remembers contacts and clearances; a link has a tree without a
// mesh beside one with, and an obstacle has none.
TEST(RobotExplain, TellsWhatMeshesTouch) {
  const std::vector<InstructionSet> sets = instruction_sets();
  Random random(seeded(83));
  Count count;
  for (int i = 0; i < scaled(120, 10); ++i) {
    Scene scene{.robot = random_robot(random, random.whole(1, 6), i % 2 == 1)};
    scene.options = {.world_from_root = random_root(random, 1.0),
                     .instructions = sets[random.index(sets.size())]};
    const auto covered = [&](double size) {
      scene.options.meshes.push_back(covered_tetrahedron(random, size));
      return cover_of(scene.options.meshes.back());
    };
    for (const Link& link : std::vector<Link>(scene.robot.links())) {
      scene.robot.attach(link.name, covered(random.between(0.05, 0.4)));
      if (random.whole(0, 3) == 0) scene.robot.attach(link.name, random_tree(random, 0.1));
    }
    for (int k = 0; k < 2; ++k) {
      const double size = k == 0 ? 4.0 : 1.5;  // large enough to hold links
      scene.obstacles.push_back({covered(random.between(0.05, size)), random.pose(1.5)});
    }
    scene.obstacles.push_back({random_tree(random, 0.2), random.pose(1.5)});
    Checked checked(obstacle_checker(scene.robot, scene.obstacles, scene.options));
    std::vector<double> at = random_configuration(random, scene.robot, 3.2);
    const std::vector<double> heading = random_configuration(random, scene.robot, 0.03);
    for (int k = 0; k < 40; ++k) {
      if (k % 20 == 19) at = random_configuration(random, scene.robot, k == 19 ? 300.0 : 3.2);
      for (std::size_t v = 0; v < at.size(); ++v) at[v] += heading[v];
      ASSERT_NO_FATAL_FAILURE(expect_explained(scene, checked, at, count)) << i << ' ' << k;
    }
  }
  EXPECT_GT(count.none, effort(100, 10));
  EXPECT_GT(count.one, effort(100, 10));
  EXPECT_GT(count.many, effort(100, 10));
  EXPECT_GT(count.inside, effort(20, 1));
}

TEST(RobotExplain, NamesLinks) {
  RobotModel robot = one_arm(wheel(), {5, 0, 0}, 0.1);
  robot.attach("base", one_sphere_tree({0, 0, 0}, 0.1));
  robot.attach("arm", one_sphere_tree({1, 0, 0}, 0.1));
  Checked checked(obstacle_checker(
      robot, {{one_sphere_tree({0, 0, 0.15}, 0.1)},
              {one_sphere_tree({1, 0, 0}, 0.1), Pose::from_translation({0.1, 0, 0})}}));
  const std::vector<CheckedContact> contacts = checked.explain(Configuration{0.0});
  ASSERT_EQ(contacts.size(), 2U);
  EXPECT_EQ(contacts[0].first.name, "arm");
  EXPECT_EQ(contacts[0].first.tree, 1U);
  EXPECT_EQ(contacts[0].second.name, obstacle_name(1));
  EXPECT_NEAR(contacts[0].overlap_depth, 0.1, 1e-12);
  EXPECT_TRUE(contacts[0].world_point.isApprox(Eigen::Vector3d(1.05, 0, 0), 1e-12));
  EXPECT_EQ(contacts[1].first.name, "base");
  EXPECT_EQ(contacts[1].first.tree, 0U);
  EXPECT_EQ(contacts[1].second.name, obstacle_name(0));
  EXPECT_NEAR(contacts[1].overlap_depth, 0.05, 1e-12);
}

}  // namespace
}  // namespace spherule::test::robot_explain_test

// Clearances that pass over what is proved free.

namespace spherule::test {
namespace {

// Two thin bars one above the other, each in a sphere, that turn about one axis: the spheres
// overlap in all configurations, the bars touch in none. A post stands away from both.
class ClearanceScene : public testing::Test {
 protected:
  ClearanceScene() {
    for (const int link : {1, 2}) {
      const double height = 0.03 * link;
      robot_.model.attach(robot_.model.links()[static_cast<std::size_t>(link)].name,
                          one_sphere_tree({0.4, 0.0, height + 0.01}, kRadius));
    }
    scene_.emplace(robot_.model);
    scene_->add("post", SolidSphere{0.1}, Pose::from_translation({1.5, 0.0, 0.04}));
  }

  RobotClearance clearance(const Configuration& configuration, const ClearanceRequest& request) {
    return Checked(*scene_).clearance(configuration, request);
  }

  static constexpr double kRadius = 0.21;
  BoxRobot robot_ = two_turning_bars(0.03);
  std::optional<RobotScene> scene_;
};

TEST_F(ClearanceScene, SkipsWhatIsProvedFreeOnRequest) {
  const ClearanceRequest skipping{.skip_proved_free = true};
  const Configuration aligned{0.0, 0.0};
  EXPECT_EQ(clearance(aligned, skipping).lower, 0.0) << "nothing is proved";
  EXPECT_FALSE(clearance(aligned, skipping).skipped);

  scene_->set_link_pairs(
      std::make_shared<const LinkPairs>(prove_link_pairs(robot_.model, robot_.bodies)));
  EXPECT_EQ(clearance(aligned, {}).lower, 0.0);
  EXPECT_FALSE(clearance(aligned, {}).skipped);
  // The post is 1.1 m from either centre.
  const RobotClearance rest = clearance(aligned, skipping);
  EXPECT_TRUE(rest.skipped);
  EXPECT_EQ(rest.second.name, "post");
  EXPECT_LE(rest.lower, 1.1 - 0.1 - kRadius);
  EXPECT_NEAR(rest.lower, 1.1 - 0.1 - kRadius, 1e-9);
  // Beyond the limits nothing is proved.
  EXPECT_EQ(clearance({1.5, 1.5}, skipping).lower, 0.0);
  EXPECT_FALSE(clearance({1.5, 1.5}, skipping).skipped);
  // Nothing else is left where the post is gone.
  scene_->remove("post");
  EXPECT_EQ(clearance(aligned, skipping).lower, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace spherule::test

namespace spherule::test::pair_status_test {
namespace {

// Boxes that slide along x: a sled on the floor, on it a cart that can reach the floor's box, a
// bumper fixed to that, and a bird that is 5 m above.
BoxRobot slides() {
  BoxRobot robot{RobotModel("floor")};
  robot.model.add_link("sled", "floor", sliding(0.5, 1.0, "push"));
  robot.model.add_link("cart", "sled", sliding(-1.0, 1.0, "pull"));
  robot.model.add_link("bumper", "cart", {.name = "screw", .type = JointType::kFixed});
  robot.model.add_link("bird", "cart", sliding(0.0, 1.0, "fly"));
  for (const char* const name : {"floor", "sled", "cart", "bumper", "bird"}) {
    const Eigen::Vector3d center(0, 0, std::string(name) == "bird" ? 5.0 : 0.0);
    robot.add_boxes(robot.model.find_link(name), {cube_at(center)});
    robot.model.attach(name, one_sphere_tree(center, 0.2));
  }
  return robot;
}

std::string kind(const RobotModel& robot, const std::vector<PairStatus>& pairs, const char* a,
                 const char* b) {
  const int first = robot.find_link(a);
  const int second = robot.find_link(b);
  for (const PairStatus& pair : pairs) {
    if (pair.first == first && pair.second == second) return std::string(kind_of(pair));
  }
  return "missing";
}

TEST(PairStatus, KindsAreToldApart) {
  const BoxRobot robot = slides();
  const auto proofs =
      std::make_shared<const LinkPairs>(prove_link_pairs(robot.model, robot.bodies));
  AllowedCollisions allowed(robot.model);
  allowed.allow("floor", "bumper");
  const std::vector<PairStatus> pairs = pair_statuses(robot.model, allowed, proofs);
  ASSERT_EQ(pairs.size(), 10U);
  EXPECT_EQ(kind(robot.model, pairs, "cart", "bumper"), "rigid");
  EXPECT_EQ(kind(robot.model, pairs, "floor", "sled"), "adjacent");
  EXPECT_EQ(kind(robot.model, pairs, "floor", "bumper"), "given");
  EXPECT_EQ(kind(robot.model, pairs, "floor", "cart"), "free in boxes");
  EXPECT_EQ(kind(robot.model, pairs, "floor", "bird"), "proved never");
  for (const PairStatus& pair : pairs) {
    EXPECT_EQ(pair.verdict.has_value(), pair.reason != AllowedReason::kRigid);
    EXPECT_EQ(pair.free_share == 1.0, pair.verdict == PairVerdict::kNever);
  }

  const std::vector<PairStatus> unproved = pair_statuses(robot.model, allowed, nullptr);
  EXPECT_EQ(kind(robot.model, unproved, "floor", "cart"), "tested");
  EXPECT_EQ(kind(robot.model, unproved, "floor", "bumper"), "given");
  EXPECT_THROW(pair_statuses(RobotModel("floor"), allowed, proofs), Error);
}

TEST(PairStatus, WhereNoBoxIsFreeTheVerdictIsTheKind) {
  PairStatus status;
  EXPECT_EQ(kind_of(status), "tested");
  status.verdict = PairVerdict::kTouching;
  EXPECT_EQ(kind_of(status), "can touch");
  status.verdict = PairVerdict::kUnknown;
  EXPECT_EQ(kind_of(status), "unknown");
}

}  // namespace
}  // namespace spherule::test::pair_status_test

// Postures of a robot by name, what touches in them, and lists of ignored pairs.

namespace spherule::test::named_postures_test {
namespace {

// A block that slides towards another one on the x axis: they touch where the slide is below 0.2.
BoxRobot slide(double lower) {
  BoxRobot robot{RobotModel("block")};
  robot.model.add_link("slider", "block", sliding(lower, 1.0, "slide"));
  for (const int link : {0, 1}) {
    robot.add_boxes(link, {cube_at({0, 0, 0})});
    robot.model.attach(robot.model.links()[static_cast<std::size_t>(link)].name,
                       one_sphere_tree({0, 0, 0}, 0.18));
  }
  return robot;
}

TEST(NamedPostures, ZeroIsTheNearestLimitWhereItIsBeyond) {
  EXPECT_EQ(zero_posture(slide(-1.0).model).configuration, std::vector<double>{0.0});
  EXPECT_EQ(zero_posture(slide(0.3).model).configuration, std::vector<double>{0.3});
}

TEST(NamedPostures, RestIsAtZeroOrInTheMiddleWhereThatIsCloseToALimit) {
  EXPECT_EQ(rest_posture(slide(-1.0).model).configuration, std::vector<double>{0.0});
  EXPECT_EQ(rest_posture(slide(-0.12).model).configuration, std::vector<double>{0.0});
  EXPECT_EQ(rest_posture(slide(-0.1).model).configuration, std::vector<double>{0.45});
  EXPECT_EQ(rest_posture(slide(0.3).model).configuration, std::vector<double>{0.65});
}

TEST(NamedPostures, StatesOfGroupsPassOverWhatIsNotThere) {
  SemanticDescription semantics;
  semantics.group_states = {
      {"home", "arm", {{"slide", {0.5}}, {"nobody", {7.0}}}},
      {"odd", "arm", {{"slide", {0.5, 0.6}}}},
  };
  const std::vector<NamedPosture> postures = group_postures(slide(-1.0).model, semantics);
  ASSERT_EQ(postures.size(), 2U);
  EXPECT_EQ(postures[0].name, "arm/home");
  EXPECT_EQ(postures[0].configuration, std::vector<double>{0.5});
  EXPECT_EQ(postures[1].configuration, std::vector<double>{0.0});
}

TEST(NamedPostures, ContactsTellSpheresFromMeshes) {
  const BoxRobot robot = slide(-0.5);
  AllowedCollisions allowed(robot.model);
  allowed.forbid("block", "slider");
  const std::vector<NamedPosture> postures = {{"in", {0.1}}, {"near", {0.3}}, {"far", {0.5}}};
  const auto plain = contacts_in(postures, robot.model, robot.bodies, allowed, nullptr);
  ASSERT_EQ(plain.size(), 2U);
  EXPECT_EQ(plain[0].posture, "in");
  EXPECT_TRUE(plain[0].do_meshes_touch);
  EXPECT_NEAR(plain[0].overlap_depth, 0.26, 1e-6);
  EXPECT_EQ(plain[1].posture, "near");
  EXPECT_FALSE(plain[1].do_meshes_touch);
  EXPECT_FALSE(plain[1].is_proved_free);
  const auto pairs = std::make_shared<const LinkPairs>(prove_link_pairs(robot.model, robot.bodies));
  const auto proved = contacts_in(postures, robot.model, robot.bodies, allowed, pairs);
  ASSERT_EQ(proved.size(), 2U);
  EXPECT_TRUE(proved[0].do_meshes_touch);
  EXPECT_FALSE(proved[0].is_proved_free);
  EXPECT_TRUE(proved[1].is_proved_free);
}

TEST(IgnoredPairs, AreAddedOnceInEitherOrder) {
  const RobotModel robot = slide(0.3).model;
  std::vector<DisabledPair> known = {{"slider", "block", "User"}};
  const std::vector<DisabledPair> more = {{"block", "slider", "Never"}, {"block", "nobody", ""}};
  add_missing_pairs(more, robot, known);
  ASSERT_EQ(known.size(), 1U);
  EXPECT_EQ(known[0].reason, "User");
  known.clear();
  add_missing_pairs(more, robot, known);
  ASSERT_EQ(known.size(), 1U);
  EXPECT_EQ(known[0].reason, "Never");
}

TEST(IgnoredPairs, AreThoseProvedNeverToTouch) {
  const auto never = [](double lower) {
    const BoxRobot robot = slide(lower);
    return pairs_proved_never(robot.model, prove_link_pairs(robot.model, robot.bodies));
  };
  EXPECT_TRUE(never(0.1).empty());
  const std::vector<DisabledPair> found = never(0.3);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].link_a, "block");
  EXPECT_EQ(found[0].link_b, "slider");
  EXPECT_EQ(found[0].reason, kProvedNeverReason);
}

}  // namespace
}  // namespace spherule::test::named_postures_test
