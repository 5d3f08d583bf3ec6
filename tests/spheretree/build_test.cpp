// SPDX-License-Identifier: BSD-3-Clause
#include "spheretree/build.h"

#include "base/error.h"
#include "spheretree/check.h"
#include "tests/spheretree/exact.h"
#include "tests/spheretree/spheres.h"
#include "tests/spheretree/tree_oracle.h"
#include "tests/support/effort.h"
#include "tests/support/hash.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

// The bound that the comment of build_tree gives: the cheapest splits down to 2 log2 n + 8, then
// medians.
int largest_depth(std::size_t count) {
  const int log2 = static_cast<int>(std::bit_width(count - 1));  // rounded up
  return 2 * log2 + 8 + 1 + log2;
}

bool same_tree(const SphereTree& a, const SphereTree& b) {
  const SphereTreeData& p = a.data();
  const SphereTreeData& q = b.data();
  return p.x == q.x && p.y == q.y && p.z == q.z && p.radius == q.radius &&
         p.first_child == q.first_child && p.child_count == q.child_count && p.spheres == q.spheres;
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

TEST(BuildTree, OneSphereIsALeaf) {
  const SphereTree tree = build_tree(std::vector<Sphere>{{{1, 2, 3}, 0.5}});
  EXPECT_EQ(tree.node_count(), 1U);
  EXPECT_TRUE(tree.is_leaf(0));
  EXPECT_EQ(tree.depth(), 0);
  EXPECT_EQ(tree.sphere(0), (Sphere{{1, 2, 3}, 0.5}));
}

TEST(BuildTree, TheRootOfFewSpheresIsTheirSmallestSphere) {
  const std::vector<Sphere> corners = {
      {{1, 1, 1}, 0.5}, {{1, -1, -1}, 0.5}, {{-1, 1, -1}, 0.5}, {{-1, -1, 1}, 0.5}};
  const Sphere root = build_tree(corners).sphere(0);
  EXPECT_LT(root.center.norm(), 1e-14);
  EXPECT_NEAR(root.radius, std::sqrt(3.0) + 0.5, 1e-14);
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

TEST(BuildTree, IsDeterministic) {
  for (const Family& family : sphere_families(500, 42)) {
    EXPECT_TRUE(same_tree(build_tree(family.spheres), build_tree(family.spheres))) << family.name;
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

// A shell has no volume to fill, as a cover of a thin part: the splits stay even enough that 8-wide
// nodes over a million spheres stay far shallower than the worst case.
TEST(BuildTree, AMillionSpheresOnAShellStayShallow) {
  constexpr auto kCount = static_cast<std::size_t>(effort(1000000, 100000));
  Random random(13);
  std::vector<Sphere> spheres;
  const double radius = std::sqrt(12.5 / static_cast<double>(kCount));
  for (std::size_t i = 0; i < kCount; ++i) spheres.push_back({random.direction(), radius});
  const SphereTree tree = build_tree(spheres);
  EXPECT_LE(tree.depth(), 9);
  EXPECT_LE(tree.node_count(), kCount + kCount / 2);
  EXPECT_LE(tree.sphere(0).radius, 1.75);
}

// Where the spheres are spread out, each level must be a good deal tighter than the one above it:
// a tree that is valid but useless (for example, all spheres as large as the root) fails here.
TEST(BuildTree, LevelsShrink) {
  Random random(9);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 4096; ++i) spheres.push_back({random.in_cube(1.0), 0.01});
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
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Sphere& bad :
       {Sphere{{nan, 0, 0}, 1.0}, Sphere{{0, infinity, 0}, 1.0}, Sphere{{0, 0, 0}, nan},
        Sphere{{0, 0, 0}, -1.0}, Sphere{{0, 0, 2e15}, 1.0}, Sphere{{0, 0, 0}, infinity}}) {
    std::vector<Sphere> spheres = good;
    spheres.push_back(bad);
    EXPECT_THROW(build_tree(spheres), Error);
  }
  // Each is usable, but no usable sphere encloses them all.
  const Vector3d corner(1e15, 1e15, 1e15);
  EXPECT_THROW(build_tree(std::vector<Sphere>{{corner, 1.0}, {-corner, 1.0}}), Error);
}

}  // namespace
}  // namespace spherule::test
