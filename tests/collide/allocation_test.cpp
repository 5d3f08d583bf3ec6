// SPDX-License-Identifier: BSD-3-Clause
// A program of its own, because it replaces the global operator new. collides() allocates nothing
// on trees that build_tree makes, and answers right where no memory is to be had.
#include "collide/collide.h"
#include "collide/mechanism/mechanism_check.h"
#include "collide/meshes/mesh_contact.h"
#include "collide/meshes/mesh_tree.h"
#include "collide/pair_cache.h"
#include "collide/search/traversal.h"
#include "collide/sweep.h"
#include "spheretree/build.h"
#include "tests/support/counting_new.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace spherule::test {
namespace {

TEST(Allocation, CollidesTakesNoMemory) {
  Random random(1);
  const SphereTree a = build_tree(random_spheres(random, 2000, 1.0, 0.02));
  const SphereTree b = build_tree(random_spheres(random, 2000, 1.0, 0.02), {.branching = 16});
  const MeshTree mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}});
  int hits = 0;
  int mesh_hits = 0;
  std::vector<Pose> poses;
  for (int i = 0; i < 100; ++i) poses.push_back(random.pose(2.0));
  const int before = allocations;
  for (const Pose& pose : poses) {
    hits += collides(a, Pose(), b, pose);
    mesh_hits += collides(a, Pose(), mesh, pose);
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(hits, 0);
  EXPECT_LT(hits, 100);
  EXPECT_GT(mesh_hits, 0);
}

TEST(Allocation, SweepsClearancesAndTheCacheTakeNoMemory) {
  Random random(3);
  const SphereTree a = build_tree(random_spheres(random, 500, 1.0, 0.02));
  const SphereTree b = build_tree(random_spheres(random, 500, 1.0, 0.02));
  std::vector<Pose> poses;
  for (int i = 0; i < 200; ++i) poses.push_back(random.pose(4.0));
  int free = 0;
  int hits = 0;
  int near = 0;
  PairCache cache(a, b);
  const int before = allocations;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Motion motion = Motion::between(poses[i - 1], poses[i]);
    free += sweep(a, motion, b, Motion::still(Pose())).verdict == Verdict::kFree;
    near += within(a, poses[i], b, Pose(), 0.1);
    hits += cache.collides(poses[i], Pose());
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(free, 0);
  EXPECT_LT(free, 199);
  EXPECT_GT(hits, 0);
  EXPECT_GT(near, hits);
}

TEST(Allocation, ConfirmationTakesNoMemory) {
  const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  TriangleMesh small = mesh;
  for (Eigen::Vector3d& v : small.vertices) v *= 0.05;
  const auto tree_of_sphere = [](double radius) {
    const Sphere sphere{Eigen::Vector3d::Zero(), radius};
    return std::make_shared<const SphereTree>(build_tree(std::span(&sphere, 1)));
  };
  const CoveredMesh a(mesh, tree_of_sphere(1.1));
  const CoveredMesh b(small, tree_of_sphere(0.1));
  Random random(3);
  int hits = 0;
  std::vector<Pose> poses;
  for (int i = 0; i < 1000; ++i) poses.push_back(random.pose(1.2));
  const int before = allocations;
  for (const Pose& pose : poses) hits += collides(a, Pose(), b, pose);
  EXPECT_EQ(allocations, before);
  EXPECT_GT(hits, 0);
  EXPECT_LT(hits, 1000);
}

TEST(Allocation, AMechanismsCheckTakesNoMemory) {
  Random random(2);
  const auto tree = [&] {
    return std::make_shared<const SphereTree>(build_tree(random_spheres(random, 500, 1.0, 0.02)));
  };
  const std::vector<MechanismFrame> frames = {{.parent_from_frame = random.pose(1.0)},
                                              {.parent = 0, .variable = 1, .prismatic = true}};
  const std::vector<MechanismBody> bodies = {{1, random.pose(1.0), tree()}, {0, Pose(), tree()}};
  const std::vector<MechanismObstacle> obstacles = {{random.pose(2.0), tree()}};
  const std::vector<MechanismPair> pairs = {{0, 0}, {1, 0}};
  const MechanismCheck check(frames, bodies, obstacles, pairs, 1e-6);
  MechanismCheck::Scratch scratch(check);
  int hits = 0;
  int queried = 0;
  const auto confirm = [&](const MechanismContact&) {
    ++queried;
    return false;
  };
  const int before = allocations;
  for (int i = 0; i < 1000; ++i) {
    const std::array<double, 2> variables = {random.between(-3.0, 3.0), random.between(-3.0, 3.0)};
    hits += check.collides(variables, scratch, confirm) ? 1 : 0;
    std::array<const double*, MechanismCheck::kBlock> block;
    block.fill(variables.data());
    check.collides(block, scratch, [](int, const MechanismContact&) { return false; });
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(hits, 0);
  EXPECT_LT(hits, 1000);
  EXPECT_GT(queried, 0);
}

TEST(Allocation, CollidesAnswersWithoutMemoryForTheStack) {
  const SphereTree a = caterpillar(1100, 2, false);
  const SphereTree b = caterpillar(1300, 2, true);
  ASSERT_GT(internal::traversal_stack_bound(a, b), internal::kInlineStack);
  // The leaves are apart, the boxes around them are not.
  const Pose inside = Pose::from_translation({1.3, 1.3, 1.3});
  const int before = allocations;
  exhausted = true;
  const bool hit = collides(a, Pose(), b, Pose());
  const bool free = !collides(a, Pose(), b, inside);
  exhausted = false;
  EXPECT_EQ(allocations, before + 2) << "the degenerate trees did require memory";
  EXPECT_TRUE(hit);
  EXPECT_TRUE(free);
}

}  // namespace
}  // namespace spherule::test
