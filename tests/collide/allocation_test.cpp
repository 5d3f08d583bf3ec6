// SPDX-License-Identifier: BSD-3-Clause
// A program of its own, because it replaces the global operator new. Queries allocate nothing on
// trees that build_tree makes.
#include "collide/collide.h"
#include "collide/kernels/tree_check.h"
#include "collide/meshes/mesh_contact.h"
#include "collide/meshes/mesh_tree.h"
#include "collide/pair_cache.h"
#include "collide/sweep.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/counting_new.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

namespace spherule::test {
namespace {

// Of poses within a cube; some answers, and not all, have to be true.
template <class Query>
void expect_no_allocation(double size, const Query& query) {
  Random random(1);
  std::vector<Pose> poses;
  for (int i = 0; i < 300; ++i) poses.push_back(random.pose(size));
  int hits = 0;
  const int before = allocations;
  for (const Pose& pose : poses) hits += query(pose) ? 1 : 0;
  EXPECT_EQ(allocations, before);
  EXPECT_GT(hits, 0);
  EXPECT_LT(hits, 300);
}

TEST(Allocation, QueriesTakeNoMemory) {
  Random random(1);
  const SphereTree a = build_tree(random_spheres(random, 1000, 1.0, 0.02));
  const SphereTree b = build_tree(random_spheres(random, 1000, 1.0, 0.02), {.branching = 16});
  const MeshTree mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}});
  const auto large = covered_tetrahedron(random, 1.0), small = covered_tetrahedron(random, 0.1);
  PairCache cache(a, b);
  const Pose origin;
  expect_no_allocation(2.0, [&](const Pose& pose) { return collides(a, origin, b, pose); });
  expect_no_allocation(2.0, [&](const Pose& pose) { return collides(a, origin, mesh, pose); });
  expect_no_allocation(4.0, [&](const Pose& pose) { return within(a, origin, b, pose, 0.1); });
  expect_no_allocation(4.0, [&](const Pose& pose) { return cache.collides(origin, pose); });
  expect_no_allocation(1.0,
                       [&](const Pose& pose) { return collides(*large, origin, *small, pose); });
  expect_no_allocation(4.0, [&](const Pose& pose) {
    const Motion motion = Motion::between(pose, Pose::from_translation({3.0, 0.0, 0.0}));
    return sweep(a, motion, b, Motion::still(origin)).verdict == Verdict::kFree;
  });
}

TEST(Allocation, ACheckAgainstTreesTakesNoMemory) {
  Random random(2);
  const auto trees = [&] {
    return std::make_shared<const internal::SearchTrees>(random_spheres(random, 500, 1.0, 0.02));
  };
  internal::PlanSource source;
  source.frames = {{.parent_from_frame = random.pose(1.0)},
                   {.parent = 0, .position = 1, .prismatic = true}};
  source.bodies = {{1, trees(), random.pose(1.0)}, {0, trees(), Pose()}};
  source.obstacles = {{trees(), random.pose(2.0)}};
  source.tests = {{0, 0, true}, {1, 0, true}};
  source.pose_error = 1e-6;
  const internal::TreeCheck check(source, 0);
  internal::TreeCheck::Scratch scratch(check);
  int hits = 0;
  int queried = 0;
  const auto confirm = [&](const internal::TreeContact&) {
    ++queried;
    return false;
  };
  const int before = allocations;
  for (int i = 0; i < 1000; ++i) {
    const std::array<double, 2> variables = {random.between(-3.0, 3.0), random.between(-3.0, 3.0)};
    hits += check.collides(variables, scratch, confirm) ? 1 : 0;
    std::array<const double*, internal::TreeCheck::kBlock> block;
    block.fill(variables.data());
    check.collides(block, scratch, [](int, const internal::TreeContact&) { return false; });
  }
  EXPECT_EQ(allocations, before);
  EXPECT_GT(hits, 0);
  EXPECT_LT(hits, 1000);
  EXPECT_GT(queried, 0);
}

}  // namespace
}  // namespace spherule::test
