// SPDX-License-Identifier: BSD-3-Clause
// Spheres and solids next to contact, against 100 digits.

#include "collide/solids/primitive.h"

#include "base/error.h"
#include "collide/solids/solid_pose.h"
#include "spheretree/build.h"
#include "tests/collide/exact_solids.h"
#include "tests/collide/trees.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

namespace spherule::test::primitive_test {
namespace {

using Eigen::Vector3d;

struct Scene {
  SphereTree tree;
  Pose world_from_tree;
  Primitive solid;
  Pose world_from_solid;

  bool collides() const {
    return spherule::collides(tree, world_from_tree, solid, world_from_solid);
  }
  bool within(double clearance) const {
    return spherule::within(tree, world_from_tree, solid, world_from_solid, clearance);
  }
  CollisionResult collide(const CollisionRequest& request = {}) const {
    return spherule::collide(tree, world_from_tree, solid, world_from_solid, request);
  }
  DistanceResult distance(const DistanceRequest& request = {}) const {
    return spherule::distance(tree, world_from_tree, solid, world_from_solid, request);
  }
  double slack(double clearance = 0.0) const {
    return primitive_slack(tree, world_from_tree, solid, world_from_solid, clearance);
  }
  Real gap(std::int32_t sphere) const {
    return exact_gap(tree.spheres()[static_cast<std::size_t>(sphere)], world_from_tree, solid,
                     world_from_solid);
  }
  // The smallest of all.
  Real gap() const {
    Real least = std::numeric_limits<double>::infinity();
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(tree.spheres().size()); ++i) {
      least = std::min(least, gap(i));
    }
    return least;
  }
};

// A solid, a point of its surface and a direction in which spheres that touch there lie.
struct Contact {
  Primitive solid;
  Vector3d point;
  Vector3d normal;
};

double sign(SceneRandom& random) {
  return random.whole(0, 1) == 0 ? 1.0 : -1.0;
}

// Around a corner, along an edge or on a face: each coordinate of the normal is zero or outward.
Contact box_contact(SceneRandom& random, const Vector3d& size) {
  Contact contact{Box{size}, Vector3d::Zero(), Vector3d::Zero()};
  const int features = random.whole(1, 7);
  for (int i = 0; i < 3; ++i) {
    const double side = sign(random);
    const bool outward = (features >> i & 1) != 0;
    contact.point[i] = side * 0.5 * size[i] * (outward ? 1.0 : random.uniform(0.0, 1.0));
    contact.normal[i] = outward ? side * random.uniform(0.1, 1.0) : 0.0;
  }
  contact.normal.normalize();
  return contact;
}

Vector3d on_circle(SceneRandom& random) {
  const double angle = random.uniform(0.0, 7.0);
  return {std::cos(angle), std::sin(angle), 0.0};
}

Contact cylinder_contact(SceneRandom& random, double radius, double length) {
  const Vector3d out = on_circle(random);
  const double side = sign(random);
  const Vector3d end(0.0, 0.0, side * 0.5 * length);
  const Primitive solid = Cylinder{radius, length};
  switch (random.whole(0, 2)) {
    case 0:
      return {solid, radius * out + random.uniform(0.0, 1.0) * end, out};
    case 1:
      return {solid, random.uniform(0.0, 1.0) * radius * out + end, Vector3d(0.0, 0.0, side)};
    default:
      return {solid, radius * out + end,
              (out + Vector3d(0.0, 0.0, side * random.uniform(0.1, 5.0))).normalized()};
  }
}

Contact capsule_contact(SceneRandom& random, double radius, double length) {
  const double side = sign(random);
  const Vector3d end(0.0, 0.0, side * 0.5 * length);
  Vector3d out = on_circle(random);
  double along = random.uniform(-1.0, 1.0);
  if (random.whole(0, 1) == 0) {
    out = (out + Vector3d(0.0, 0.0, side * random.uniform(0.0, 5.0))).normalized();
    along = 1.0;
  }
  return {Capsule{radius, length}, along * end + radius * out, out};
}

// Sizes over many orders of magnitude, and needles and plates among them.
Contact random_contact(SceneRandom& random, double size) {
  const auto length = [&] {
    return size * (random.whole(0, 3) == 0 ? std::ldexp(1.0, random.whole(-30, -1))
                                           : random.uniform(0.1, 1.0));
  };
  switch (random.whole(0, 4)) {
    case 0:
      return box_contact(random, {length(), length(), length()});
    case 1: {
      const double radius = length();
      const Vector3d out = random.point(1.0).normalized();
      return {SolidSphere{radius}, radius * out, out};
    }
    case 2:
      return cylinder_contact(random, length(), length());
    case 3:
      return capsule_contact(random, length(), random.whole(0, 5) == 0 ? 0.0 : length());
    default:
      return {HalfSpace{}, Vector3d(random.uniform(-size, size), random.uniform(-size, size), 0.0),
              Vector3d::UnitZ()};
  }
}

// A sphere `gap` away from a solid, and smaller ones that are nearer by no more than rounding; tree
// and solid are placed anywhere, far from the origin of the world and of their frames at times.
Scene near_contact(SceneRandom& random, double size, double gap) {
  const Contact contact = random_contact(random, size);
  const double radius = random.whole(0, 4) == 0 ? 0.0 : size * random.uniform(0.01, 2.0);
  const Vector3d center = contact.point + (radius + gap) * contact.normal;
  const double frame = size * std::ldexp(1.0, random.whole(0, 10));
  const double world = size * std::ldexp(1.0, random.whole(0, 1) * random.whole(0, 30));
  const Pose world_from_solid = random.pose(world);
  const Pose solid_from_tree = random.pose(frame);
  const Pose tree_from_solid = solid_from_tree.inverse();

  std::vector<Sphere> spheres = {{tree_from_solid * center, radius}};
  for (int i = random.whole(0, 12); i > 0; --i) {
    const double share = random.uniform(0.0, 1.0);
    spheres.push_back({tree_from_solid * (center + share * radius * contact.normal),
                       (1.0 - random.uniform(0.0, 1.0)) * share * radius});
  }
  return {build_tree(spheres, {.branching = random.whole(2, SphereTree::kMaxBranching)}),
          world_from_solid * solid_from_tree, contact.solid, world_from_solid};
}

double random_size(SceneRandom& random) {
  return std::ldexp(1.0, random.whole(-40, 17));
}

// Zero, a few units in the last place, 1e-12 and 1e-9 of the size, or in sight.
double random_gap(SceneRandom& random, double size) {
  const double steps[] = {0.0, 4e-16, 2e-15, 1e-14, 4e-14, 1e-13, 1e-12, 1e-9, 0.1};
  return sign(random) * steps[random.whole(0, 8)] * size;
}

TEST(PrimitiveTest, NeitherMissesNorInventsAContact) {
  SceneRandom random(1);
  int touching = 0, slack_needed = 0, free = 0;
  for (int i = 0; i < effort(1200, 100); ++i) {
    const double size = random_size(random);
    const Scene scene = near_contact(random, size, random_gap(random, size));
    const Real gap = scene.gap();
    const bool hit = scene.collides();
    ASSERT_TRUE(hit || gap > 0) << i;
    ASSERT_TRUE(!hit || gap <= scene.slack()) << i;
    touching += gap <= 0;
    slack_needed += hit && gap > 0;
    free += !hit;
  }
  EXPECT_GT(touching, effort(300, 25));
  EXPECT_GT(slack_needed, effort(30, 2));
  EXPECT_GT(free, effort(150, 12));
}

// The pad is no larger than it need be by orders of magnitude: a gap of 1e-9 of the scene is seen.
TEST(PrimitiveTest, SlackIsSmall) {
  SceneRandom random(2);
  for (int i = 0; i < effort(300, 30); ++i) {
    const Scene scene = near_contact(random, 1.0, 0.0);
    const double reach =
        scene.tree.reach() + 4.0 +
        (scene.world_from_tree.translation() - scene.world_from_solid.translation()).lpNorm<1>();
    ASSERT_LE(scene.slack(), 5e-14 * reach);
  }
}

TEST(PrimitiveTest, PairsAreThoseOfSingleSpheres) {
  SceneRandom random(3);
  int some = 0;
  for (int i = 0; i < effort(500, 50); ++i) {
    const double size = random_size(random);
    const Scene scene = near_contact(random, size, random_gap(random, size));
    const CollisionResult result = scene.collide();
    ASSERT_TRUE(result.complete);
    ASSERT_EQ(result.verdict, scene.collides() ? Verdict::kCollision : Verdict::kFree) << i;
    ASSERT_EQ(result.pairs.empty(), result.verdict == Verdict::kFree);
    std::set<std::int32_t> found;
    for (const SpherePair& pair : result.pairs) {
      ASSERT_EQ(pair.b, 0);
      found.insert(pair.a);
    }
    ASSERT_EQ(found.size(), result.pairs.size());
    ASSERT_TRUE(std::is_sorted(result.pairs.begin(), result.pairs.end()));
    for (std::int32_t k = 0; k < static_cast<std::int32_t>(scene.tree.spheres().size()); ++k) {
      const Real gap = scene.gap(k);
      ASSERT_TRUE(gap > 0 || found.contains(k));
      ASSERT_TRUE(gap <= scene.slack() || !found.contains(k));
    }
    const SphereTree other = build_tree(scene.tree.spheres(), {.branching = 2});
    ASSERT_EQ(collide(other, scene.world_from_tree, scene.solid, scene.world_from_solid).pairs,
              result.pairs);
    if (result.pairs.empty()) {
      ASSERT_LE(result.distance_lower_bound, scene.gap());
    }
    some += result.pairs.size() > 1;
  }
  EXPECT_GT(some, effort(40, 2));
}

TEST(PrimitiveTest, LimitsGiveUnknownNeverFree) {
  SceneRandom random(4);
  int unknown = 0;
  for (int i = 0; i < effort(300, 30); ++i) {
    const double size = random_size(random);
    const Scene scene = near_contact(random, size, random_gap(random, size));
    const CollisionResult full = scene.collide();
    for (std::uint64_t tests = 0; tests < 40; tests = 2 * tests + 1) {
      const CollisionResult result = scene.collide({.max_node_tests = tests});
      ASSERT_LE(result.cost.node_tests, tests);
      ASSERT_TRUE(result.verdict == full.verdict || result.verdict == Verdict::kUnknown);
      unknown += result.verdict == Verdict::kUnknown;
    }
    const CollisionResult first = scene.collide({.max_pairs = 1});
    ASSERT_EQ(first.verdict, full.verdict);
    ASSERT_EQ(first.pairs.size(), std::min<std::size_t>(full.pairs.size(), 1));
    ASSERT_EQ(scene.collide({.max_time = std::chrono::nanoseconds(0)}).verdict, Verdict::kUnknown);
  }
  EXPECT_GT(unknown, effort(300, 30));
}

TEST(PrimitiveTest, WithinAClearance) {
  SceneRandom random(5);
  int counts[2] = {};
  for (int i = 0; i < effort(700, 60); ++i) {
    const double size = random_size(random);
    const double clearance = size * std::ldexp(random.uniform(0.5, 1.0), random.whole(-30, 20));
    const double gap = clearance * (1.0 + sign(random) * (random.whole(0, 1) == 0 ? 1e-15 : 0.01));
    const Scene scene = near_contact(random, size, gap + 0.1 * random_gap(random, size));
    const Real exact = scene.gap();
    const bool hit = scene.within(clearance);
    ASSERT_TRUE(hit || exact > clearance) << i;
    ASSERT_TRUE(!hit || exact <= Real(clearance) + scene.slack(clearance)) << i;
    ASSERT_EQ(scene.within(0.0), scene.collides());
    ++counts[hit];
  }
  EXPECT_GT(counts[0], effort(90, 5));
  EXPECT_GT(counts[1], effort(90, 5));
}

TEST(PrimitiveTest, DistanceBoundsAreNeverCrossed) {
  SceneRandom random(6);
  int apart = 0, overlapping = 0;
  for (int i = 0; i < effort(300, 40); ++i) {
    const double size = random_size(random);
    const Scene scene = near_contact(random, size, random_gap(random, size));
    const Real exact = std::max(Real(0), scene.gap());
    const DistanceResult result = scene.distance();
    ASSERT_LE(result.lower, exact) << i;
    ASSERT_GE(result.upper, exact) << i;
    ASSERT_LE(result.upper - result.lower, scene.slack() * 2.0 + 1e-14 * result.upper);
    ASSERT_LE(scene.gap(result.nearest.a), result.upper);
    ASSERT_EQ(result.nearest.b, 0);
    ASSERT_TRUE(!scene.collides() || result.lower == 0.0);
    for (const DistanceRequest& request :
         {DistanceRequest{.tolerance = 0.3 * result.upper},
          DistanceRequest{.enough = 0.25 * result.lower}, DistanceRequest{.max_node_tests = 0},
          DistanceRequest{.max_node_tests = 5},
          DistanceRequest{.max_time = std::chrono::nanoseconds(300)}}) {
      const DistanceResult rough = scene.distance(request);
      ASSERT_LE(rough.lower, exact);
      ASSERT_GE(rough.upper, exact);
      ASSERT_LE(rough.cost.node_tests, request.max_node_tests);
    }
    ++(exact > 0 ? apart : overlapping);
  }
  EXPECT_GT(apart, effort(90, 5));
  EXPECT_GT(overlapping, effort(90, 5));
}

TEST(PrimitiveTest, DeepestContact) {
  SceneRandom random(7);
  int found = 0;
  for (int i = 0; i < effort(300, 40); ++i) {
    const double size = random_size(random);
    const Scene scene =
        near_contact(random, size, random_gap(random, size) - 0.2 * size * random.whole(0, 4));
    const auto contact =
        deepest_contact(scene.tree, scene.world_from_tree, scene.solid, scene.world_from_solid);
    ASSERT_EQ(contact.has_value(), scene.collides());
    if (!contact) continue;
    ++found;
    const Real depth = -scene.gap(contact->sphere);
    ASSERT_LE(contact->overlap_depth, depth);
    ASSERT_GE(contact->overlap_depth, depth - 2.0 * scene.slack());
    ASSERT_GE(contact->overlap_depth, -scene.gap() - 4.0 * scene.slack());
    const Sphere point{contact->world_point, 0.0};
    const double error = 1e-14 * (scene.world_from_solid.translation().lpNorm<1>() +
                                  scene.world_from_tree.translation().lpNorm<1>()) +
                         4.0 * scene.slack();
    ASSERT_LE(exact_gap(point, Pose(), scene.solid, scene.world_from_solid), error);
    const Sphere sphere = scene.tree.spheres()[static_cast<std::size_t>(contact->sphere)];
    ASSERT_LE((PlacedSphereSets{sphere, point, scene.world_from_tree, Pose()}.gap()), error);
  }
  EXPECT_GT(found, effort(150, 20));
  // Of equally deep ones the first.
  for (const double side : {-1.0, 1.0}) {
    std::vector<Sphere> spheres = {{{0.0, 0.0, 9.0}, 1.0}};
    for (int i = 0; i < 9; ++i) spheres.push_back({{side * i, 0.0, 0.5}, 1.0});
    EXPECT_EQ(deepest_contact(build_tree(spheres), Pose(), HalfSpace{}, Pose())->sphere, 1);
  }
}

TEST(PrimitiveTest, OneWhollyInsideTheOther) {
  const auto sphere = [](double radius) {
    return build_tree(std::vector<Sphere>{{{0.1, 0.2, 0.3}, radius}});
  };
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const Primitive& solid : {Primitive(Box{{scale, 2 * scale, 3 * scale}}),
                                   Primitive(SolidSphere{scale}), Primitive(Cylinder{scale, scale}),
                                   Primitive(Capsule{scale, 0.0}), Primitive(HalfSpace{})}) {
      const Pose under = Pose::from_translation({0.1, 0.2, 0.3 + 2e-8});
      EXPECT_TRUE(collides(sphere(1e-7), Pose(), solid, under));
      EXPECT_TRUE(collides(sphere(1e7), Pose(), solid, under));
    }
  }
}

TEST(PrimitiveTest, HoldsForTheSmallestAndTheLargest) {
  for (const double size : {0x1p-1074, 0x1p-1000, 0x1p-540, 0x1p-500, 1e-30, 1e14}) {
    const SphereTree tree =
        build_tree(std::vector<Sphere>{{{size, 0.0, 0.0}, 0.0}, {{0.0, size, -size}, size}});
    for (const Primitive& solid : {Primitive(Box{{size, size, size}}), Primitive(SolidSphere{size}),
                                   Primitive(Cylinder{size, size}), Primitive(Capsule{size, size}),
                                   Primitive(HalfSpace{})}) {
      for (const double way : {0.0, 0.5, 3.0, 7.0}) {
        const Pose pose(Eigen::Quaterniond(1.0, 2.0, -3.0, 4.0), Vector3d(way, 0.0, way) * size);
        const Scene scene = {tree, pose, solid, Pose()};
        const Real exact = scene.gap();
        ASSERT_TRUE(scene.collides() || exact > 0);
        ASSERT_LE(scene.distance().lower, std::max(exact, Real(0)));
        ASSERT_GE(scene.distance().upper, exact);
      }
    }
  }
}

TEST(PrimitiveTest, RefusesWhatIsNoSolid) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, infinity, std::nan(""), 2e15}) {
    for (const Primitive& solid : {Primitive(Box{{1.0, bad, 1.0}}), Primitive(SolidSphere{bad}),
                                   Primitive(Cylinder{bad, 1.0}), Primitive(Cylinder{1.0, bad}),
                                   Primitive(Capsule{bad, 1.0})}) {
      EXPECT_THROW(require_primitive(solid, "table"), Error) << bad << ' ' << solid.index();
    }
    if (bad != 0.0) {
      EXPECT_THROW(require_primitive(Capsule{1.0, bad}, "table"), Error);
    }
  }
  EXPECT_NO_THROW(require_primitive(Capsule{1.0, 0.0}, "table"));
  EXPECT_NO_THROW(require_primitive(HalfSpace{}, "table"));
  try {
    require_primitive(SolidSphere{-1.0}, "table");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.subject(), "table");
  }
  const SphereTree tree = build_tree(std::vector<Sphere>{{Vector3d::Zero(), 1.0}});
  EXPECT_THROW(within(tree, Pose(), SolidSphere{1.0}, Pose(), -1.0), Error);
}

}  // namespace
}  // namespace spherule::test::primitive_test
