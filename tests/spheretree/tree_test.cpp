// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "geometry/sphere.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/effort.h"
#include "tests/support/exact/spheres.h"
#include "tests/support/exact/trees.h"
#include "tests/support/hash.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

// The bound that the comment of build_tree gives: the cheapest splits down to 2 log2 n + 8, then
// medians.
int largest_depth(std::size_t count) {
  const int log2 = static_cast<int>(std::bit_width(count - 1));  // rounded up
  return 2 * log2 + 8 + 1 + log2;
}

void expect_good(const SphereTree& tree, std::span<const Sphere> spheres, int branching) {
  EXPECT_EQ(fault_of(tree.data()), "");
  ASSERT_EQ(tree.spheres().size(), spheres.size());
  EXPECT_TRUE(std::equal(spheres.begin(), spheres.end(), tree.spheres().begin()));
  EXPECT_LE(tree.node_count(), 2 * spheres.size() - 1);
  EXPECT_EQ(tree.depth(), depth_of(tree.data()));
  EXPECT_LE(tree.depth(), largest_depth(spheres.size()));
  EXPECT_LE(tree.branching(), branching);
}

TEST(BuildTree, EveryFamilyGivesAValidTree) {
  std::vector<std::size_t> counts = effort(std::vector<std::size_t>{333, 2000}, 1);
  for (std::size_t count = 1; count <= 20; ++count) counts.push_back(count);
  for (const std::size_t count : counts) {
    for (const Family& family : sphere_families(count, count)) {
      for (const int branching : effort(std::vector{3, 16, 2, 8}, 2)) {
        SCOPED_TRACE(family.name + ", " + std::to_string(count) + " spheres, branching " +
                     std::to_string(branching));
        expect_good(build_tree(family.spheres, {.branching = branching}), family.spheres,
                    branching);
        if (HasFailure()) return;
      }
    }
  }
}

// In rational numbers; tight to some units in the last place of the numbers it is made from.
TEST(BuildTree, TheBoxHoldsTheSpheresTightly) {
  for (const std::size_t count : {1U, 2U, 7U, 300U}) {
    for (const Family& family : sphere_families(count, count + 3)) {
      SCOPED_TRACE(family.name);
      const SphereTree tree = build_tree(family.spheres);
      const Rational slack = Rational(tree.reach()) * Rational(0x1p-50) + Rational(0x1p-1070);
      for (int axis = 0; axis < 3; ++axis) {
        const Rational center = tree.box().center[axis];
        const Rational half = tree.box().half_size[axis];
        const Rational farthest[2] = {center - half + 2 * slack, center + half - 2 * slack};
        bool reached[2] = {};
        for (const Sphere& sphere : family.spheres) {
          const Rational low = Rational(sphere.center[axis]) - Rational(sphere.radius);
          const Rational high = Rational(sphere.center[axis]) + Rational(sphere.radius);
          ASSERT_TRUE(center - half <= low && high <= center + half);
          reached[0] = reached[0] || low <= farthest[0];
          reached[1] = reached[1] || high >= farthest[1];
        }
        ASSERT_TRUE(reached[0] && reached[1]);
      }
    }
  }
}

// A million spheres that no split can tell apart, or that lie on a line, or whose clusters shrink
// geometrically so that splits take off one at a time: neither deep recursion nor quadratic
// time (which would not end within the test's time limit).
TEST(BuildTree, AMillionDegenerateSpheres) {
  constexpr auto kCount = static_cast<std::size_t>(effort(1000000, 200000));
  std::vector<Sphere> coincident(kCount, Sphere{{1, 2, 3}, 0.25});
  std::vector<Sphere> line;
  std::vector<Sphere> geometric;
  for (std::size_t i = 0; i < kCount; ++i) {
    line.push_back({{static_cast<double>(i), 0.0, 0.0}, 0.75});
    geometric.push_back({{std::ldexp(1.0, -static_cast<int>(i % 1000)), 0.0, 0.0}, 0.0});
  }
  for (const auto* spheres : {&coincident, &line, &geometric}) {
    const SphereTree tree = build_tree(*spheres);  // the constructor runs check()
    EXPECT_LE(tree.depth(), largest_depth(kCount));
    EXPECT_TRUE(encloses_exactly(tree.sphere(0), spheres->front()));
    EXPECT_TRUE(encloses_exactly(tree.sphere(0), spheres->back()));
  }
}

// G7: the same bytes on every machine, and as long as nobody means to change the trees. All
// families but one are made with + - * / sqrt alone.
TEST(BuildTree, GivesGoldenBytes) {
  constexpr std::uint64_t kGolden = 0x8e0af6d9634a0010;
  std::uint64_t hash = hash_of("");
  const auto add = [&hash](const auto& numbers) {
    const auto bytes = std::as_bytes(std::span(numbers));
    hash = hash_of({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, hash);
  };
  for (const Family& family : sphere_families(2000, 12)) {
    if (family.name.starts_with("scales")) continue;  // made with pow
    const SphereTree tree = build_tree(family.spheres);
    const SphereTreeData& data = tree.data();
    for (const auto* numbers : {&data.x, &data.y, &data.z, &data.radius}) add(*numbers);
    for (const auto* numbers : {&data.first_child, &data.child_count}) add(*numbers);
  }
  EXPECT_EQ(hash, kGolden) << "0x" << std::hex << hash;
}

// Where the spheres are spread out, each level must be a good deal tighter than the one above it:
// a tree that is valid but useless (for example, all spheres as large as the root) fails here.
TEST(BuildTree, LevelsShrink) {
  Random random(9);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 4096; ++i) spheres.push_back({random.point(1.0), 0.01});
  const SphereTree tree = build_tree(spheres);
  EXPECT_LE(tree.depth(), 8);
  EXPECT_LE(tree.node_count(), 6000U);
  EXPECT_LE(tree.sphere(0).radius, 1.2 * std::sqrt(3.0));
  double previous = tree.sphere(0).radius;
  for (int level = 1; level <= 3; ++level) {
    double sum = 0.0;
    const std::vector<Sphere> of_level = tree.level(level);
    for (const Sphere& sphere : of_level) sum += sphere.radius;
    const double mean = sum / static_cast<double>(of_level.size());
    EXPECT_LT(mean, 0.75 * previous) << "level " << level;
    previous = mean;
  }
}

TEST(BuildTree, LevelsCoverAllSpheres) {
  const std::vector<Sphere> spheres = sphere_families(300, 4).front().spheres;
  const SphereTree tree = build_tree(spheres);
  for (int level = 0; level <= tree.depth(); ++level) {
    const std::vector<Sphere> of_level = tree.level(level);
    for (const Sphere& sphere : spheres) {
      EXPECT_TRUE(std::any_of(of_level.begin(), of_level.end(),
                              [&](const Sphere& b) { return encloses_exactly(b, sphere); }));
    }
  }
  EXPECT_EQ(tree.level(0).size(), 1U);
  EXPECT_EQ(tree.level(tree.depth()).size(), spheres.size());
}

TEST(BuildTree, RefusesBadInput) {
  const std::vector<Sphere> good = {{{0, 0, 0}, 1.0}, {{1, 0, 0}, 1.0}};
  EXPECT_THROW(build_tree(std::vector<Sphere>{}), Error);
  for (const int branching : {-1, 0, 1, 17, 1000}) {
    EXPECT_THROW(build_tree(good, {.branching = branching}), Error) << branching;
  }
  for (const Sphere& bad : unusable_spheres()) {
    std::vector<Sphere> spheres = good;
    spheres.push_back(bad);
    EXPECT_THROW(build_tree(spheres), Error);
  }
  // Each is usable, but no usable sphere encloses them all.
  const Vector3d corner(1e15, 1e15, 1e15);
  EXPECT_THROW(build_tree(std::vector<Sphere>{{corner, 1.0}, {-corner, 1.0}}), Error);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::int32_t kLargest = std::numeric_limits<std::int32_t>::max();
constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();

SphereTreeData some_tree(std::size_t count = 60, int branching = 4) {
  return build_tree(sphere_families(count, 6).front().spheres, {.branching = branching}).data();
}

void expect_refused(const SphereTreeData& data, const std::string& mentions) {
  const TreeReport report = check(data);
  EXPECT_FALSE(report.valid);
  ASSERT_FALSE(report.problems.empty());
  EXPECT_LE(report.problems.size(), TreeReport::kMaxProblems);
  EXPECT_NE(report.problems.front().find(mentions), std::string::npos) << report.problems.front();
  EXPECT_THROW(SphereTree{data}, Error);
}

TEST(Check, ReportsAValidTree) {
  const std::vector<Sphere> spheres = sphere_families(60, 6).front().spheres;
  const SphereTree tree = build_tree(spheres, {.branching = 4});
  const TreeReport report = check(tree);
  EXPECT_TRUE(report.valid);
  EXPECT_TRUE(report.problems.empty());
  EXPECT_EQ(report.sphere_count, 60U);
  EXPECT_EQ(report.leaf_count, 60U);
  EXPECT_EQ(report.node_count, tree.node_count());
  EXPECT_EQ(report.depth, depth_of(tree.data()));
  EXPECT_EQ(report.branching, 4);
  EXPECT_EQ(report.root_radius, tree.sphere(0).radius);
  EXPECT_GT(report.mean_inflation, 1.0);
}

TEST(Check, RefusesArraysOfDifferentLength) {
  for (const auto array :
       {&SphereTreeData::x, &SphereTreeData::y, &SphereTreeData::z, &SphereTreeData::radius}) {
    SphereTreeData data = some_tree();
    (data.*array).pop_back();
    expect_refused(data, "length");
    data = some_tree();
    (data.*array).clear();
    expect_refused(data, "length");
  }
  for (const auto array : {&SphereTreeData::first_child, &SphereTreeData::child_count}) {
    SphereTreeData data = some_tree();
    (data.*array).push_back(0);
    expect_refused(data, "length");
  }
  expect_refused(SphereTreeData{}, "no node");
  SphereTreeData data = some_tree();
  data.spheres.clear();
  expect_refused(data, "no sphere");
}

TEST(Check, RefusesNumbersThatAreNotUsable) {
  for (const double bad : {kNan, kInfinity, -kInfinity, 2e15}) {
    for (const auto array :
         {&SphereTreeData::x, &SphereTreeData::y, &SphereTreeData::z, &SphereTreeData::radius}) {
      for (const std::size_t node : {std::size_t{0}, std::size_t{3}, some_tree().x.size() - 1}) {
        SphereTreeData data = some_tree();
        (data.*array)[node] = bad;
        expect_refused(data, "node " + std::to_string(node));
      }
    }
    SphereTreeData data = some_tree();
    data.spheres[5].center.y() = bad;
    expect_refused(data, "sphere 5");
  }
  SphereTreeData data = some_tree();
  data.radius[0] = -data.radius[0];
  expect_refused(data, "node 0");
}

// Every index of every node, replaced by everything that could go wrong.
TEST(Check, RefusesEveryWrongIndexAndCount) {
  const SphereTreeData good = some_tree(20, 3);
  const auto nodes = static_cast<std::int32_t>(good.x.size());
  for (std::size_t node = 0; node < good.x.size(); ++node) {
    const auto self = static_cast<std::int32_t>(node);
    const std::int32_t first = good.first_child[node];
    for (const std::int32_t bad :
         {first - 1, first + 1, 0, self, -1, nodes, nodes - 1, kLargest, kLeast}) {
      if (bad == first) continue;
      SphereTreeData data = good;
      data.first_child[node] = bad;
      SCOPED_TRACE("first child of " + std::to_string(node) + ": " + std::to_string(bad));
      expect_refused(data, "");
    }
    const std::int32_t count = good.child_count[node];
    for (const std::int32_t bad : {count - 1, count + 1, 0, -1, 17, kLargest, kLeast}) {
      if (bad == count) continue;
      SphereTreeData data = good;
      data.child_count[node] = bad;
      SCOPED_TRACE("child count of " + std::to_string(node) + ": " + std::to_string(bad));
      expect_refused(data, "");
    }
  }
}

// Two leaves exchange spheres that are bit for bit the same: still one leaf each. One leaf naming
// the other's sphere is not.
TEST(Check, WantsOneLeafForEachSphere) {
  SphereTreeData data = build_tree(std::vector<Sphere>(5, Sphere{{1, 2, 3}, 0.5})).data();
  ASSERT_EQ(data.child_count[1], 0);
  ASSERT_EQ(data.child_count[2], 0);
  std::swap(data.first_child[1], data.first_child[2]);
  EXPECT_TRUE(check(data).valid);
  data.first_child[1] = data.first_child[2];
  expect_refused(data, "another leaf");
}

TEST(Check, TellsMinusZeroFromZero) {
  SphereTreeData data = build_tree(std::vector<Sphere>{{{0, 1, 2}, 0.5}}).data();
  data.x[0] = -0.0;
  expect_refused(data, "is not that of sphere 0");
}

TEST(Check, RefusesTooManyChildren) {
  // A root over 17 leaves, otherwise in order.
  SphereTreeData data;
  data.spheres.assign(17, Sphere{{0, 0, 0}, 0.5});
  data.x.assign(18, 0.0);
  data.y = data.z = data.x;
  data.radius.assign(18, 0.5);
  data.radius[0] = 1.0;
  data.child_count.assign(18, 0);
  data.child_count[0] = 17;
  for (std::int32_t i = 0; i < 18; ++i) data.first_child.push_back(i - 1);
  data.first_child[0] = 1;
  expect_refused(data, "17 children");
}

// Radii moved by single units in the last place about the limit: "valid" must never be said where
// exact arithmetic denies it, and both answers must occur for the test to mean something.
TEST(Check, NeverPassesASphereThatDoesNotEnclose) {
  Random random(21);
  int passed = 0;
  int refused = 0;
  int needed = 0;  // refused rightly, though the parent is within 4 units of the child's reach
  for (int i = 0; i < 20000; ++i) {
    const double scale = std::pow(10.0, random.between(-9.0, 9.0));
    const Sphere child = {scale * random.point(1.0), scale * random.unit()};
    Sphere parent = {scale * random.point(1.0), 0.0};
    parent.radius = (child.center - parent.center).norm() + child.radius;
    const int steps = static_cast<int>(random.index(21)) - 10;
    for (int k = 0; k < std::abs(steps); ++k) {
      parent.radius = std::nextafter(parent.radius, steps > 0 ? kInfinity : 0.0);
    }
    SphereTreeData data;
    data.spheres = {child};
    for (const Sphere& sphere : {parent, child}) {
      data.x.push_back(sphere.center.x());
      data.y.push_back(sphere.center.y());
      data.z.push_back(sphere.center.z());
      data.radius.push_back(sphere.radius);
    }
    data.first_child = {1, 0};
    data.child_count = {1, 0};
    const bool valid = check(data).valid;
    const bool truth = fault_of(data).empty();
    ASSERT_TRUE(!valid || truth);
    ++(valid ? passed : refused);
    if (!truth && std::abs(steps) <= 4) ++needed;
  }
  EXPECT_GT(passed, 1000);
  EXPECT_GT(refused, 1000);
  EXPECT_GT(needed, 1000);
}

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
void expect_good_levels(const LevelTree& made, std::span<const Sphere> spheres,
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
            expect_good_levels(
                build_tree_from_levels(family.spheres, levels, {.branching = branching}),
                family.spheres, levels);
            if (HasFailure()) return;
          }
        }
      }
    }
  }
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
  expect_good_levels(made, spheres, levels);
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
