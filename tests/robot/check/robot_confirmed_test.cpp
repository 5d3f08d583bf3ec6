// SPDX-License-Identifier: BSD-3-Clause
// Contacts confirmed on meshes, of self pairs and with obstacles of every kind, padded and not, in
// configurations and on motions, against distances of convex solids.

#include "base/error.h"
#include "collide/meshes/mesh_contact.h"
#include "collide/meshes/solid_mesh.h"
#include "robot/check/robot_scene.h"
#include "robot/model/kinematics.h"
#include "tests/robot/check/solid_oracle.h"
#include "tests/robot/robots.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace spherule::test::robot_confirmed_test {
namespace {

using Eigen::Vector3d;

// A tetrahedron of `size` with its cover, or one sphere: what every body and many an obstacle is.
struct Thing {
  std::shared_ptr<const CoveredMesh> mesh;  // null: the sphere
  Sphere sphere{Vector3d::Zero(), 0.0};
  double padding = 0.0;

  std::shared_ptr<const SphereTree> tree() const {
    return mesh ? cover_of(mesh) : test::one_sphere_tree(sphere.center, sphere.radius);
  }
  Projection at(const Pose& pose) const {
    if (!mesh) return onto_sphere(pose * sphere.center, sphere.radius);
    std::array<Vector3d, 4> corners;
    std::size_t count = 0;
    for (const auto& triangle : {mesh->mesh().triangle(0), mesh->mesh().triangle(3)}) {
      for (const Vector3d& corner : triangle) {
        const Vector3d placed = pose * corner;
        if (std::find(corners.begin(), corners.begin() + count, placed) ==
            corners.begin() + count) {
          corners[count++] = placed;
        }
      }
    }
    return onto_tetrahedron(corners);
  }
};

// A robot of such bodies, among an obstacle of every kind.
class ConfirmedScene {
 public:
  explicit ConfirmedScene(Random& random)
      : robot_(make_robot(random, bodies_)), allowed_(robot_), scene_(robot_) {
    for (std::size_t link = 0; link < bodies_.size(); ++link) {
      const std::string& name = robot_.links()[link].name;
      if (bodies_[link].padding > 0.0) scene_.set_padding(name, bodies_[link].padding);
    }
    const auto place = [&] { return random.pose(1.2); };
    for (int k = 0; k < 4; ++k) {
      const Pose pose = place();
      const Thing thing = random_thing(random, k == 0 ? 1.5 : 0.3);  // one that holds bodies
      if (k == 3) {
        TriangleMesh mesh{{{0, 0, 0}, {0.3, 0, 0}, {0, 0.3, 0}, {0, 0, 0.3}},
                          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
        mesh.vertex_error = 0.02;
        add("solid", std::make_shared<const SolidMesh>(mesh), pose, 0.02,
            onto_tetrahedron({pose * mesh.vertices[0], pose * mesh.vertices[1],
                              pose * mesh.vertices[2], pose * mesh.vertices[3]}));
      } else {
        if (thing.mesh) meshes_.push_back(thing.mesh);
        add("thing " + std::to_string(k), thing.tree(), pose, 0.0, thing.at(pose));
      }
    }
    const std::vector<Primitive> solids = {Box{{0.3, 0.1, 0.2}}, SolidSphere{0.1},
                                           Cylinder{0.1, 0.3}, Capsule{0.08, 0.3}};
    for (const Primitive& solid : solids) {
      const Pose pose = place();
      add("solid " + std::to_string(solid.index()), solid, pose, 0.0, onto_primitive(solid, pose));
    }
    const Pose floor = Pose::from_translation({0.0, 0.0, -0.9});
    add("floor", Primitive(HalfSpace{}), floor, 0.0, onto_primitive(HalfSpace{}, floor));
  }

  const RobotModel& robot() const { return robot_; }
  RobotChecker checker(InstructionSet set, bool is_confirmed = true) const {
    return scene_.snapshot(
        {.instructions = set,
         .meshes = is_confirmed ? meshes_ : std::vector<std::shared_ptr<const CoveredMesh>>()});
  }

  // The least of how far two are apart, less the padding; below -0.5 where they overlap.
  double gap(std::span<const double> configuration) const {
    std::vector<Pose> poses;
    forward_kinematics(robot_, configuration, poses);
    double least = 1.0;
    const auto take = [&](const Projection& a, const Projection& b, const Vector3d& from,
                          double padding) {
      const double distance = distance_between(a, b, from);
      least = std::min(least, distance < 1e-6 ? -1.0 : distance - padding);
    };
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Projection body = bodies_[i].at(poses[i]);
      for (const Other& other : others_) {
        take(body, other.onto, poses[i].translation(), bodies_[i].padding + other.inflation);
      }
      for (std::size_t k = i + 1; k < bodies_.size(); ++k) {
        if (allowed_.allows(static_cast<int>(i), static_cast<int>(k))) continue;
        take(body, bodies_[k].at(poses[k]), poses[i].translation(),
             bodies_[i].padding + bodies_[k].padding);
      }
    }
    return least;
  }

 private:
  struct Other {
    Projection onto;
    double inflation;
  };

  static Thing random_thing(Random& random, double size) {
    if (random.whole(0, 3) == 0) return {nullptr, {random.point(0.05), 0.3 * size}};
    return {covered_tetrahedron(random, random.between(0.5, 1.0) * size)};
  }

  RobotModel make_robot(Random& random, std::vector<Thing>& bodies) {
    RobotModel robot = random_robot(random, random.whole(3, 6), false);
    for (std::size_t link = 0; link < robot.links().size(); ++link) {
      Thing body = random_thing(random, random.between(0.02, 0.3));
      if (random.whole(0, 2) == 0) body.padding = random.between(0.0, 0.05);
      robot.attach(robot.links()[link].name, body.tree());
      if (body.mesh) meshes_.push_back(body.mesh);
      bodies.push_back(std::move(body));
    }
    return robot;
  }

  void add(const std::string& name, const ObstacleShape& shape, const Pose& pose, double inflation,
           Projection onto) {
    scene_.add(name, shape, pose);
    others_.push_back({std::move(onto), inflation});
  }

  std::vector<std::shared_ptr<const CoveredMesh>> meshes_;
  std::vector<Thing> bodies_;  // one a link
  RobotModel robot_;
  AllowedCollisions allowed_;
  RobotScene scene_;
  std::vector<Other> others_;
};

// What the oracle cannot tell from contact.
constexpr double kUnclear = 1e-3;

TEST(RobotConfirmed, ConfigurationsAreJudgedOnTheMeshes) {
  Random random(seeded(171));
  int hits = 0, free = 0, alarms = 0;
  for (int i = 0; i < scaled(60, 6); ++i) {
    const ConfirmedScene scene(random);
    std::vector<double> queried;
    std::vector<std::uint8_t> expected;
    const RobotChecker spheres = scene.checker(best_instruction_set(), false);
    RobotChecker::Scratch sphere_scratch(spheres);
    for (int k = 0; k < 30; ++k) {
      const std::vector<double> at =
          random_configuration(random, scene.robot(), k == 0 ? 200.0 : 3.2);
      const double gap = scene.gap(at);
      if (std::abs(gap) < kUnclear) continue;
      queried.insert(queried.end(), at.begin(), at.end());
      expected.push_back(gap > 0.0 ? 1 : 0);
      (gap > 0.0 ? free : hits) += 1;
      alarms += gap > 0.0 && !spheres.check_config(at, sphere_scratch);
    }
    const auto variables = static_cast<std::size_t>(scene.robot().variable_count());
    for (const InstructionSet set : instruction_sets()) {
      const RobotChecker checker = scene.checker(set);
      RobotChecker::Scratch scratch(checker);
      std::vector<std::uint8_t> many(expected.size());
      checker.check_configs(queried, scratch, many);
      EXPECT_EQ(many, expected) << i;
      for (std::size_t k = 0; k < expected.size(); ++k) {
        const auto at = std::span(queried).subspan(k * variables, variables);
        ASSERT_EQ(checker.check_config(at, scratch), expected[k] != 0) << i << ' ' << k;
        ASSERT_EQ(checker.explain(at, scratch).empty(), expected[k] != 0) << i << ' ' << k;
        ASSERT_LE(checker.clearance(at, scratch).lower, std::max(0.0, scene.gap(at)) + kUnclear);
      }
    }
  }
  EXPECT_GT(hits, effort(300, 20));
  EXPECT_GT(free, effort(300, 20));
  EXPECT_GT(alarms, effort(100, 5));
}

TEST(RobotConfirmed, MotionsAreProvedOnTheMeshes) {
  const std::vector<InstructionSet> sets = instruction_sets();
  Random random(seeded(172));
  int free = 0, hits = 0, unknown = 0, alarms = 0;
  for (int i = 0; i < scaled(60, 8); ++i) {
    const ConfirmedScene scene(random);
    const RobotChecker checker = scene.checker(sets[random.bits() % sets.size()]);
    const RobotChecker spheres = scene.checker(best_instruction_set(), false);
    RobotChecker::Scratch scratch(checker), sphere_scratch(spheres);
    for (int k = 0; k < 6; ++k) {
      const std::vector<double> from = random_configuration(random, scene.robot(), 3.0);
      std::vector<double> to =
          random_configuration(random, scene.robot(), random.between(0.0, 1.0));
      for (std::size_t v = 0; v < to.size(); ++v) to[v] += from[v];
      if (k % 2 == 0 && scene.gap(from) < 0.0) continue;
      const EdgeResult result =
          checker.check_edge(from, to, scratch, {.resolution = 1e-3, .first = k % 3 == 0});
      double least = 1.0;
      constexpr int kSteps = 60;
      for (int step = 0; step <= kSteps; ++step) {
        const double t = static_cast<double>(step) / kSteps;
        std::vector<double> at;
        for (std::size_t v = 0; v < to.size(); ++v) at.push_back((1.0 - t) * from[v] + t * to[v]);
        const double gap = scene.gap(at);
        least = std::min(least, gap);
        ASSERT_FALSE(gap < -kUnclear && (result.verdict == Verdict::kFree || t < result.free_until))
            << i << ' ' << k << ' ' << t << ' ' << gap;
      }
      if (result.verdict == Verdict::kCollision) {
        std::vector<double> at;
        const double t = result.contact_at;
        for (std::size_t v = 0; v < to.size(); ++v) at.push_back((1.0 - t) * from[v] + t * to[v]);
        ASSERT_LT(scene.gap(at), kUnclear) << i << ' ' << k;
      }
      // What is free by far is proved so.
      ASSERT_FALSE(least > 0.05 && result.verdict != Verdict::kFree)
          << i << ' ' << k << ' ' << least;
      (result.verdict == Verdict::kFree        ? free
       : result.verdict == Verdict::kCollision ? hits
                                               : unknown) += 1;
      alarms += result.verdict == Verdict::kFree &&
                spheres.check_edge(from, to, sphere_scratch).verdict != Verdict::kFree;
    }
  }
  EXPECT_GT(free, effort(30, 3));
  EXPECT_GT(hits, effort(30, 3));
  EXPECT_GT(alarms, effort(12, 1));
  EXPECT_LT(unknown, 1 + (free + hits) / 20);
}

}  // namespace
}  // namespace spherule::test::robot_confirmed_test
