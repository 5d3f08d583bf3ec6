// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/level_tree.h"

#include "base/error.h"
#include "geometry/enclosing_sphere.h"
#include "tests/spheretree/exact.h"
#include "tests/spheretree/spheres.h"
#include "tests/spheretree/tree_oracle.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

Sphere around(std::span<const Sphere> spheres, double factor) {
  if (spheres.size() == 1) return spheres.front();
  Sphere sphere = enclosing_sphere(spheres);
  sphere.radius = sphere.radius * factor + 0x1p-500;
  return sphere;
}

// Parents of `per_parent` spheres in a row each, as small as they may be, or larger by a factor.
SphereLevel level_over(std::span<const Sphere> finer, std::size_t per_parent, double factor) {
  SphereLevel level;
  for (std::size_t begin = 0; begin < finer.size(); begin += per_parent) {
    const std::size_t count = std::min(per_parent, finer.size() - begin);
    level.parent_of.insert(level.parent_of.end(), count,
                           static_cast<std::int32_t>(level.spheres.size()));
    level.spheres.push_back(around(finer.subspan(begin, count), factor));
  }
  return level;
}

// All that LevelTree promises, judged by walking down from the nodes of each level.
void expect_good(const LevelTree& made, std::span<const Sphere> spheres,
                 std::span<const SphereLevel> levels) {
  const SphereTree& tree = made.tree;
  ASSERT_EQ(fault_of(tree.data()), "");
  ASSERT_TRUE(
      std::equal(spheres.begin(), spheres.end(), tree.spheres().begin(), tree.spheres().end()));
  ASSERT_EQ(made.nodes.size(), levels.size());
  for (std::size_t k = 0; k < levels.size(); ++k) {
    ASSERT_EQ(made.nodes[k].size(), levels[k].spheres.size());
    for (std::size_t i = 0; i < made.nodes[k].size(); ++i) {
      ASSERT_EQ(tree.sphere(static_cast<std::size_t>(made.nodes[k][i])), levels[k].spheres[i]);
    }
  }
  // Which sphere of the finest level stands above each sphere.
  std::vector<std::int32_t> above(tree.node_count(), -1);
  if (levels.empty()) return;
  for (std::size_t i = 0; i < made.nodes[0].size(); ++i) {
    above[static_cast<std::size_t>(made.nodes[0][i])] = static_cast<std::int32_t>(i);
  }
  for (std::size_t node = 0; node < tree.node_count(); ++node) {
    if (tree.is_leaf(node)) {
      const auto sphere = static_cast<std::size_t>(tree.sphere_index(node));
      EXPECT_EQ(above[node], levels[0].parent_of[sphere]);
      continue;
    }
    for (int i = 0; i < tree.child_count(node); ++i) {
      std::int32_t& child = above[static_cast<std::size_t>(tree.first_child(node) + i)];
      if (child < 0) child = above[node];
    }
  }
}

TEST(LevelTree, EveryFamilyGivesAValidTree) {
  constexpr double kRoom = 1.0 + SphereLevel::kReserve;
  for (const std::size_t count : {1U, 2U, 9U, 40U, 333U}) {
    for (const Family& family : sphere_families(count, count)) {
      for (const std::size_t per_parent : {1U, 3U, 70U}) {
        for (const double factor : {kRoom, 1.3}) {
          SCOPED_TRACE(family.name + ", " + std::to_string(count) + ", " +
                       std::to_string(per_parent) + ", " + std::to_string(factor));
          std::vector<SphereLevel> levels = {level_over(family.spheres, per_parent, factor)};
          levels.push_back(level_over(levels[0].spheres, 4, factor));
          for (const int branching : effort(std::vector{8, 2, 16}, 1)) {
            expect_good(build_tree_from_levels(family.spheres, levels, {.branching = branching}),
                        family.spheres, levels);
            if (HasFailure()) return;
          }
        }
      }
    }
  }
}

TEST(LevelTree, WithoutLevelsIsTheOrdinaryTree) {
  const std::vector<Sphere> spheres = sphere_families(200, 5).front().spheres;
  const LevelTree made = build_tree_from_levels(spheres, {});
  const SphereTreeData plain = build_tree(spheres).data();
  EXPECT_EQ(made.tree.data().x, plain.x);
  EXPECT_EQ(made.tree.data().radius, plain.radius);
  EXPECT_EQ(made.tree.data().first_child, plain.first_child);
}

// Spheres that touch the parent from inside leave no room for smallest spheres around groups of
// them.
TEST(LevelTree, GroupsThatDoNotFitTakeTheSphereOfTheParent) {
  Random random(11);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 300; ++i) spheres.push_back({0.9 * random.direction(), 0.1});
  SphereLevel level;
  level.parent_of.assign(spheres.size(), 0);
  level.spheres.push_back({Vector3d::Zero(), 1.0 + 4.0 * SphereLevel::kReserve});
  const std::vector<SphereLevel> levels = {level};
  const LevelTree made = build_tree_from_levels(spheres, levels);
  expect_good(made, spheres, levels);
  const auto& data = made.tree.data();
  const auto at_parent = [&](std::size_t node) {
    return data.child_count[node] > 0 && data.x[node] == 0.0 && data.y[node] == 0.0 &&
           data.z[node] == 0.0;
  };
  std::size_t copies = 0;
  for (std::size_t node = 1; node < made.tree.node_count(); ++node) copies += at_parent(node);
  EXPECT_GT(copies, 0U);
}

TEST(LevelTree, RefusesWhatIsNoLevel) {
  const std::vector<Sphere> spheres = {{Vector3d::Zero(), 1.0}, {Vector3d::UnitX(), 1.0}};
  const auto reason = [&](const SphereLevel& level) -> std::string {
    try {
      build_tree_from_levels(spheres, std::vector<SphereLevel>{level});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const Sphere around{{0.5, 0.0, 0.0}, 2.0};
  EXPECT_EQ(reason({{around}, {0, 0}}), "");
  EXPECT_NE(reason({{around}, {0}}).find("1 parents for 2 spheres"), std::string::npos);
  EXPECT_NE(reason({{around}, {0, 1}}).find("parent 1 of sphere 1"), std::string::npos);
  EXPECT_NE(reason({{around}, {0, -1}}).find("does not exist"), std::string::npos);
  EXPECT_NE(reason({{around, around}, {0, 0}}).find("sphere 1: has no children"),
            std::string::npos);
  // Encloses exactly, without the reserve.
  EXPECT_NE(reason({{{{0.5, 0.0, 0.0}, 1.5}}, {0, 0}}).find("reserve"), std::string::npos);
}

TEST(Cut, HoldsAllSpheresInAtMostSoManySpheres) {
  constexpr std::size_t kCount = effort(150, 40);
  for (const Family& family : sphere_families(kCount, 3)) {
    SCOPED_TRACE(family.name);
    const SphereTree tree = build_tree(family.spheres);
    for (const std::size_t count :
         {std::size_t{1}, std::size_t{2}, std::size_t{20}, kCount - 1, kCount, 8 * kCount}) {
      const std::vector<Sphere> spheres = cut(tree, count);
      EXPECT_LE(spheres.size(), count);
      EXPECT_TRUE(count < kCount || spheres.size() == kCount);
      for (const Sphere& sphere : family.spheres) {
        EXPECT_TRUE(std::ranges::any_of(
            spheres, [&](const Sphere& held) { return encloses_exactly(held, sphere); }));
      }
    }
  }
}

}  // namespace
}  // namespace spherule::test
