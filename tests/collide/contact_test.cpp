// SPDX-License-Identifier: BSD-3-Clause
// The deepest contact: of spheres against 100 digits over all pairs, of meshes against the queries
// that it has to agree with, over all pairs as well.

#include "collide/contact.h"

#include "spheretree/build.h"
#include "tests/collide/exact_scene.h"
#include "tests/collide/exact_triangles.h"
#include "tests/collide/tetrahedra.h"
#include "tests/collide/trees.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace spherule::test::contact_test {
namespace {

using Eigen::Vector3d;

Real exact_overlap(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                   const Pose& world_from_b, const SpherePair& pair) {
  return -PlacedSphereSets{a.spheres()[static_cast<std::size_t>(pair.a)],
                           b.spheres()[static_cast<std::size_t>(pair.b)], world_from_a,
                           world_from_b}
              .gap();
}

// What is said of two spheres is true: how deep they overlap and where.
void expect_true(const Contact& contact, const SphereTree& a, const Pose& world_from_a,
                 const SphereTree& b, const Pose& world_from_b) {
  const Real exact = exact_overlap(a, world_from_a, b, world_from_b, contact.spheres);
  const double slack = collision_slack(a, world_from_a, b, world_from_b);
  ASSERT_LE(contact.overlap_depth, exact);
  ASSERT_LE(exact - contact.overlap_depth, slack);
  ASSERT_GE(contact.overlap_depth, -2.0 * slack);
  const Sphere& of_a = a.spheres()[static_cast<std::size_t>(contact.spheres.a)];
  const Sphere& of_b = b.spheres()[static_cast<std::size_t>(contact.spheres.b)];
  const double from_a = (contact.world_point - world_from_a * of_a.center).norm();
  const double from_b = (contact.world_point - world_from_b * of_b.center).norm();
  const double rounding = slack + 3e-14 * contact.world_point.norm();
  ASSERT_LE(from_a, of_a.radius + rounding);
  ASSERT_LE(from_b, of_b.radius + rounding);
  // As far inside the one as inside the other, unless one lies inside the other.
  if (std::abs(of_a.radius - of_b.radius) < from_a + from_b - rounding) {
    ASSERT_NEAR(of_a.radius - from_a, of_b.radius - from_b, 2.0 * rounding);
  }
}

// Deep in each other, near contact and apart, of any size, some spheres twice.
TEST(Contact, OfSpheresIsTheDeepest) {
  SceneRandom random(1);
  int deep = 0;
  int grazing = 0;
  int free = 0;
  for (int i = 0; i < effort(600, 60); ++i) {
    const double size = std::ldexp(1.0, random.whole(-20, 20));
    std::vector<Sphere> first = random_spheres(random, random.whole(1, 20), size, 0.3 * size);
    std::vector<Sphere> second = random_spheres(random, random.whole(1, 20), size, 0.3 * size);
    if (i % 5 == 0) first.insert(first.end(), first.begin(), first.begin() + 1);
    if (i % 7 == 0) second.insert(second.end(), second.begin(), second.end() - 1);
    const Pose world_from_a = random.pose(size);
    Pose world_from_b(random.quaternion(), world_from_a.translation() + random.point(size));
    if (i % 3 != 0) {
      // The first spheres come as near as rounding lets them, the others are small.
      for (Sphere& sphere : first) sphere.radius *= 0.01;
      for (Sphere& sphere : second) sphere.radius *= 0.01;
      const double gap =
          size * (i % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, random.uniform(-17.0, -12.0));
      const Vector3d at =
          world_from_a * first[0].center +
          (first[0].radius + second[0].radius + gap) * random.point(1.0).normalized();
      const Pose turned(world_from_b.rotation(), Vector3d::Zero());
      world_from_b = Pose(world_from_b.rotation(), at - turned * second[0].center);
    }
    std::optional<Contact> expected;
    for (const int branching : {2, 8, 16}) {
      const SphereTree a = build_tree(first, {.branching = branching});
      const SphereTree b = build_tree(second, {.branching = branching});
      const std::optional<Contact> contact = deepest_contact(a, world_from_a, b, world_from_b);
      ASSERT_EQ(contact.has_value(), collides(a, world_from_a, b, world_from_b)) << i;
      if (branching > 2) {
        ASSERT_EQ(contact.has_value(), expected.has_value());
        if (!contact) continue;
        ASSERT_EQ(contact->spheres, expected->spheres);
        ASSERT_EQ(contact->overlap_depth, expected->overlap_depth);
        ASSERT_EQ(contact->world_point, expected->world_point);
        continue;
      }
      expected = contact;
      if (!contact) {
        ++free;
        continue;
      }
      ASSERT_EQ(contact->kind, ContactKind::kSpheres);
      ASSERT_FALSE(contact->triangles);
      expect_true(*contact, a, world_from_a, b, world_from_b);
      const double slack = collision_slack(a, world_from_a, b, world_from_b);
      for (const SpherePair& other : collide(a, world_from_a, b, world_from_b).pairs) {
        ASSERT_LE(exact_overlap(a, world_from_a, b, world_from_b, other),
                  contact->overlap_depth + 2.0 * slack);
      }
      (contact->overlap_depth > 4.0 * slack ? deep : grazing) += 1;
    }
  }
  EXPECT_GT(deep, effort(100, 3));
  EXPECT_GT(grazing, effort(50, 5));
  EXPECT_GT(free, effort(50, 5));
}

TEST(Contact, OfSpheresAboutOnePoint) {
  const auto outer = one_sphere_tree({1.0, 2.0, 3.0}, 2.0);
  const auto inner = one_sphere_tree({1.0, 2.0, 3.0}, 0.5);
  const std::optional<Contact> contact = deepest_contact(*outer, Pose(), *inner, Pose());
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->overlap_depth, 2.5, 1e-12);
  EXPECT_LE(contact->overlap_depth, 2.5);
  EXPECT_EQ(contact->world_point, Vector3d(1.0, 2.0, 3.0));
}

// For meshes apart, touching, near contact and inside each other.
TEST(Contact, OfMeshesIsTheDeepestThatTrianglesConfirm) {
  SceneRandom random(2);
  int triangles = 0;
  int inside = 0;
  int removed = 0;
  int not_deepest = 0;
  for (int i = 0; i < effort(300, 60); ++i) {
    const auto mesh_a = covered_tetrahedron(random, random.uniform(0.1, 2.0));
    const bool small = i % 4 == 0;  // so that it is inside the other now and then
    const auto mesh_b = covered_tetrahedron(random, random.uniform(0.1, 2.0) * (small ? 0.1 : 1.0));
    const SphereTree& a = mesh_a->cover();
    const SphereTree& b = mesh_b->cover();
    const Pose world_from_a = random.pose(i % 2 == 0 ? 0.5 : 100.0);
    const Pose world_from_b(random.quaternion(),
                            world_from_a.translation() + random.point(small ? 0.2 : 1.0));
    const std::optional<Contact> contact =
        deepest_contact(*mesh_a, world_from_a, *mesh_b, world_from_b);
    ASSERT_EQ(contact.has_value(), collides(*mesh_a, world_from_a, *mesh_b, world_from_b)) << i;
    const std::vector<SpherePair> pairs = collide(a, world_from_a, b, world_from_b).pairs;
    if (!contact) {
      removed += !pairs.empty();
      continue;
    }
    expect_true(*contact, a, world_from_a, b, world_from_b);
    const double slack = collision_slack(a, world_from_a, b, world_from_b);
    int confirmed = 0;
    int deeper = 0;
    for (const SpherePair& pair : pairs) {
      const bool is_confirmed =
          triangles_touch(*mesh_a, pair.a, world_from_a, *mesh_b, pair.b, world_from_b);
      confirmed += is_confirmed;
      const bool is_deeper = exact_overlap(a, world_from_a, b, world_from_b, pair) >
                             contact->overlap_depth + 2.0 * slack;
      deeper += is_deeper;
      const bool counts = is_confirmed || contact->kind == ContactKind::kInside;
      ASSERT_FALSE(is_deeper && counts) << i;
    }
    not_deepest += deeper > 0;
    ASSERT_EQ(contact->kind, confirmed > 0 ? ContactKind::kTriangles : ContactKind::kInside);
    ASSERT_EQ(contact->triangles.has_value(), confirmed > 0);
    if (confirmed == 0) {
      ++inside;
      continue;
    }
    ++triangles;
    ASSERT_LE(exact_gap(mesh_a->mesh().triangle(contact->triangles->a), world_from_a,
                        mesh_b->mesh().triangle(contact->triangles->b), world_from_b),
              slack);
  }
  EXPECT_GT(triangles, effort(60, 10));
  EXPECT_GT(inside, effort(5, 0));
  EXPECT_GT(removed, effort(20, 3));
  EXPECT_GE(not_deepest, effort(1, 0));
}

}  // namespace
}  // namespace spherule::test::contact_test
