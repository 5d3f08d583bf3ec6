// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/effort.h"
#include "tests/support/exact/spheres.h"
#include "tests/support/exact/trees.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <utility>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

template <typename T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool same_nodes(const SphereTree& a, const SphereTree& b) {
  return same_bytes(a.data().first_child, b.data().first_child) &&
         same_bytes(a.data().child_count, b.data().child_count);
}

bool same_spheres(const SphereTree& a, const SphereTree& b) {
  const SphereTreeData& p = a.data();
  const SphereTreeData& q = b.data();
  return same_bytes(p.x, q.x) && same_bytes(p.y, q.y) && same_bytes(p.z, q.z) &&
         same_bytes(p.radius, q.radius);
}

std::vector<Sphere> spheres_of(const SphereTree& tree) {
  return {tree.spheres().begin(), tree.spheres().end()};
}

// Moves one sphere in `stride` by up to `size` times its set's extent, and changes its radius.
std::vector<Sphere> stirred(std::vector<Sphere> spheres, Random& random, double size,
                            std::size_t stride) {
  double extent = 0.0;
  for (const Sphere& sphere : spheres) {
    extent = std::max(extent, (sphere.center - spheres[0].center).norm() + sphere.radius);
  }
  for (Sphere& sphere : spheres) {
    if (random.index(stride) != 0) continue;
    sphere.center += size * extent * random.point(1.0);
    sphere.radius *= random.between(0.0, 2.0);
  }
  return spheres;
}

void expect_good(const SphereTree& refitted, const SphereTree& tree,
                 const std::vector<Sphere>& moved) {
  EXPECT_TRUE(check(refitted).valid);
  EXPECT_EQ(fault_of(refitted.data()), "");
  EXPECT_TRUE(same_bytes(spheres_of(refitted), moved));
  EXPECT_TRUE(same_nodes(refitted, tree));
  EXPECT_EQ(refitted.depth(), tree.depth());
  EXPECT_EQ(refitted.branching(), tree.branching());
}

TEST(Refit, EveryFamilyStaysValidWhereverItsSpheresGo) {
  Random random(21);
  for (const std::size_t count : {1U, 2U, 7U, 40U, kSanitized ? 200U : 600U}) {
    for (const Family& family : sphere_families(count, count)) {
      for (const int branching : effort(std::vector{8, 2, 16}, 1)) {
        const SphereTree tree = build_tree(family.spheres, {.branching = branching});
        for (const double size : {1e-16, 1e-3, 10.0}) {
          for (const std::size_t stride : {1U, 20U}) {
            SCOPED_TRACE(family.name + ", " + std::to_string(count) + " spheres, branching " +
                         std::to_string(branching) + ", size " + std::to_string(size));
            const std::vector<Sphere> moved = stirred(family.spheres, random, size, stride);
            expect_good(refit(tree, moved), tree, moved);
            if (HasFailure()) return;
          }
        }
      }
    }
  }
}

TEST(Refit, ATreeThatIsMovedInGivesTheSame) {
  Random random(22);
  for (const Family& family : sphere_families(200, 9)) {
    SphereTree tree = build_tree(family.spheres);
    const std::vector<Sphere> moved = stirred(family.spheres, random, 0.1, 2);
    const SphereTree copied = refit(tree, moved);
    expect_good(copied, tree, moved);
    const SphereTree anew(copied.data());
    EXPECT_EQ(copied.reach(), anew.reach()) << family.name;
    EXPECT_EQ(copied.box().center, anew.box().center) << family.name;
    EXPECT_EQ(copied.box().half_size, anew.box().half_size) << family.name;
    EXPECT_TRUE(same_spheres(refit(std::move(tree), moved), copied)) << family.name;
  }
}

// A tree through levels has spheres that are not the smallest; what has not moved keeps them.
TEST(Refit, SpheresAboveWhatStaysAreKept) {
  std::vector<Sphere> spheres;
  SphereLevel level;
  for (int i = 0; i < 40; ++i) {
    spheres.push_back({{static_cast<double>(i), 0.0, 0.0}, 0.5});
    level.parent_of.push_back(i / 10);
  }
  for (int i = 0; i < 4; ++i) level.spheres.push_back({{10.0 * i + 4.5, 1.0, 0.0}, 9.0});
  const LevelTree levels = build_tree_from_levels(spheres, std::vector{level});
  EXPECT_TRUE(same_spheres(refit(levels.tree, spheres), levels.tree));

  spheres[25].center.y() += 0.25;
  const SphereTree refitted = refit(levels.tree, spheres);
  expect_good(refitted, levels.tree, spheres);
  for (std::size_t i = 0; i < 4; ++i) {
    const Sphere sphere = refitted.sphere(static_cast<std::size_t>(levels.nodes[0][i]));
    if (i == 2) {
      EXPECT_LT(sphere.radius, 5.1);
    } else {
      EXPECT_EQ(sphere, level.spheres[i]);
    }
  }
}

// The spheres depend on the nodes and on where the spheres are, not on where they have been.
TEST(Refit, TheWayThereLeavesNoTrace) {
  Random random(23);
  for (const Family& family : sphere_families(300, 6)) {
    const SphereTree tree = build_tree(family.spheres);
    const std::vector<Sphere> moved = stirred(family.spheres, random, 0.3, 3);
    SphereTree current = tree;
    for (const double size : {0.01, 1.0, 0.1}) {
      current = refit(current, stirred(family.spheres, random, size, 2));
    }
    EXPECT_TRUE(same_spheres(refit(current, moved), refit(tree, moved))) << family.name;
    EXPECT_TRUE(same_spheres(refit(current, family.spheres), tree)) << family.name;
  }
}

// -0.0 is another sphere than 0.0 as far as bytes go.
TEST(Refit, SignsOfZeroAreTakenOver) {
  const std::vector<Sphere> spheres = {{{0.0, 0, 0}, 1.0}, {{1, 0, 0}, 1.0}, {{2, 0, 0}, 1.0}};
  std::vector<Sphere> moved = spheres;
  moved[0].center.x() = -0.0;
  const SphereTree tree = build_tree(spheres);
  const SphereTree refitted = refit(tree, moved);
  expect_good(refitted, tree, moved);
  EXPECT_TRUE(same_spheres(refitted, build_tree(moved)));
}

// Spheres as tight as a new tree's where neighbours stay neighbours; a tree that is valid but
// useless would fail here. Stirring shows in what the comment says to examine.
TEST(Refit, IsAsTightAsANewTreeWhileNeighboursStayTogether) {
  Random random(25);
  std::vector<Sphere> spheres;
  for (int i = 0; i < 4096; ++i) spheres.push_back({random.direction(), 0.05});
  const SphereTree tree = build_tree(spheres);
  std::vector<Sphere> bent = spheres;
  for (Sphere& sphere : bent) {
    const double z = sphere.center.z();
    sphere.center += Vector3d(0.3 * z * z, -0.2 * z, 0.1 * z);
  }
  const SphereTree refitted = refit(tree, bent);
  const SphereTree built = build_tree(bent);
  EXPECT_LE(refitted.sphere(0).radius, 1.05 * built.sphere(0).radius);
  EXPECT_LE(check(refitted).mean_inflation, 1.1 * check(built).mean_inflation);
  const SphereTree scattered = refit(tree, stirred(bent, random, 0.5, 1));
  EXPECT_GE(check(scattered).mean_inflation, 1.5 * check(tree).mean_inflation);
}

TEST(Refit, RefusesBadInput) {
  const std::vector<Sphere> good = {{{0, 0, 0}, 1.0}, {{1, 0, 0}, 1.0}};
  const SphereTree tree = build_tree(good);
  EXPECT_THROW(refit(tree, {}), Error);
  EXPECT_THROW(refit(tree, std::span(good).first(1)), Error);
  std::vector<Sphere> more = good;
  more.push_back({{2, 0, 0}, 1.0});
  EXPECT_THROW(refit(tree, more), Error);
  for (const Sphere& bad : unusable_spheres()) {
    EXPECT_THROW(refit(tree, std::vector<Sphere>{good[0], bad}), Error);
  }
  // Each is usable, but no usable sphere encloses them all.
  const Vector3d corner(1e15, 1e15, 1e15);
  EXPECT_THROW(refit(tree, std::vector<Sphere>{{corner, 1.0}, {-corner, 1.0}}), Error);
}

}  // namespace
}  // namespace spherule::test
