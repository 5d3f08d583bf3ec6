// SPDX-License-Identifier: BSD-3-Clause
// collides(), within(), distance() and deepest_contact() of a sphere tree and a shape: another
// tree, a primitive, a mesh with its inside. Next to contact, against 100 digits.
#include "base/error.h"
#include "collide/collide.h"
#include "collide/contact.h"
#include "collide/meshes/solid_mesh.h"
#include "collide/search/relative_pose.h"
#include "collide/shapes.h"
#include "collide/solids/primitive.h"
#include "spheretree/sphere_tree.h"
#include "tests/soak/scale.h"
#include "tests/support/effort.h"
#include "tests/support/exact/shapes.h"
#include "tests/support/random_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;

// From a placed sphere to a placed shape: negative where it has to move by as much to part from it.
Real gap_of(const Sphere& sphere, const Pose& world_from_sphere, const SphereTree& tree,
            const Pose& world_from_tree) {
  return exact_gap({std::span(&sphere, 1), world_from_sphere}, {tree.spheres(), world_from_tree});
}
Real gap_of(const Sphere& sphere, const Pose& world_from_sphere, const Primitive& solid,
            const Pose& world_from_solid) {
  return exact_gap(sphere, world_from_sphere, solid, world_from_solid);
}
// Of a convex mesh: inside is what is on the side of every face on which the mean of all is.
Real gap_of(const Sphere& sphere, const Pose& world_from_sphere, const SolidMesh& solid,
            const Pose& world_from_solid) {
  const Vector<Real> center = transform(world_from_sphere, exact<Real>(sphere.center));
  const auto count = static_cast<std::int32_t>(solid.mesh().tree().spheres().size());
  std::vector<ExactTriangle<Real>> faces;
  Vector<Real> mean = {0, 0, 0};
  for (std::int32_t i = 0; i < count; ++i) {
    faces.push_back(placed<Real>(world_from_solid, solid.mesh().triangle(i)));
    for (const Vector<Real>& corner : faces.back())
      mean = plus(mean, Real(1) / (3 * count), corner);
  }
  Real least = std::numeric_limits<double>::infinity();
  bool is_inside = true;
  for (const ExactTriangle<Real>& t : faces) {
    least = std::min(least, squared_distance_to_triangle(center, t));
    const Vector<Real> normal = cross(difference(t[1], t[0]), difference(t[2], t[0]));
    is_inside = is_inside &&
                dot(normal, difference(center, t[0])) * dot(normal, difference(mean, t[0])) > 0;
  }
  const Real distance = sqrt(least);
  return (is_inside ? Real(-distance) : distance) - sphere.radius - solid.inflation();
}

double slack_of(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                const Pose& world_from_b, double clearance) {
  return within_slack(a, world_from_a, b, world_from_b, clearance);
}
double slack_of(const SphereTree& tree, const Pose& world_from_tree, const Primitive& solid,
                const Pose& world_from_solid, double clearance) {
  return primitive_slack(tree, world_from_tree, solid, world_from_solid, clearance);
}
// What two times the rounding of relative_pose.h is, and the leaves of a mesh give away.
double slack_of(const SphereTree& tree, const Pose& world_from_tree, const SolidMesh& solid,
                const Pose& world_from_solid, double clearance) {
  return 2.5 * collision_slack(tree, world_from_tree, solid.mesh().tree(), world_from_solid) +
         4e-16 * solid.inflation() + 1e-14 * clearance;
}

// How far the bounds of a distance may lie apart, but for the loss of a scene.
double width_of(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                const Pose& world_from_b) {
  return 2.5 * internal::RelativePose(a, world_from_a, b, world_from_b).gap_error();
}
template <class Solid>
double width_of(const SphereTree& tree, const Pose& world_from_tree, const Solid& solid,
                const Pose& world_from_solid) {
  return 2.0 * slack_of(tree, world_from_tree, solid, world_from_solid, 0.0);
}

template <class Shape>
struct Scene {
  SphereTree tree;
  Pose world_from_tree;
  Shape shape;
  Pose world_from_shape;
  double loss = 0.0;  // of depths and distances, beside the slack

  bool collides() const {
    return spherule::collides(tree, world_from_tree, shape, world_from_shape);
  }
  bool within(double clearance) const {
    return spherule::within(tree, world_from_tree, shape, world_from_shape, clearance);
  }
  CollisionResult collide(const CollisionRequest& request = {}) const {
    return spherule::collide(tree, world_from_tree, shape, world_from_shape, request);
  }
  DistanceResult distance(const DistanceRequest& request = {}) const {
    return spherule::distance(tree, world_from_tree, shape, world_from_shape, request);
  }
  auto deepest_contact() const {
    return spherule::deepest_contact(tree, world_from_tree, shape, world_from_shape);
  }
  double slack(double clearance = 0.0) const {
    return slack_of(tree, world_from_tree, shape, world_from_shape, clearance);
  }
  double width() const { return width_of(tree, world_from_tree, shape, world_from_shape); }
  Real gap(const Sphere& sphere) const {
    return gap_of(sphere, world_from_tree, shape, world_from_shape);
  }
  // The smallest of all.
  Real gap() const {
    Real least = std::numeric_limits<double>::infinity();
    for (const Sphere& sphere : tree.spheres()) least = std::min(least, gap(sphere));
    return least;
  }
};

// Zero, a few units in the last place, 1e-12 and 1e-9 of the size, or in sight.
double random_gap(Random& random, double size) {
  constexpr double kSteps[] = {0.0, 4e-16, 2e-15, 1e-14, 4e-14, 1e-13, 1e-12, 1e-9, 0.1};
  return random.sign() * kSteps[random.whole(0, 8)] * size;
}

int random_branching(Random& random) {
  return random.whole(2, SphereTree::kMaxBranching);
}

// --- two trees ---

// Up to 20, scattered or of any family.
std::vector<Sphere> few_spheres(Random& random, double size) {
  const int count = random.whole(1, 20);
  if (!random.chance(0.2)) return random_spheres(random, count, size, 0.3 * size);
  std::vector<Family> families = sphere_families(static_cast<std::size_t>(count), random.bits());
  return families[random.index(families.size())].spheres;
}

// Deep in each other, or with two spheres as near as `gap` and all small. Some spheres stand twice.
Scene<SphereTree> near_contact(Random& random, const SphereTree*) {
  const double size = std::ldexp(1.0, random.whole(-20, 20));
  std::vector<Sphere> a = few_spheres(random, size);
  std::vector<Sphere> b = few_spheres(random, size);
  if (random.whole(0, 4) == 0) a.push_back(a.front());
  const Pose world_from_a = random.pose(size);
  Pose world_from_b(random.quaternion(), world_from_a.translation() + random.point(1.5 * size));
  if (random.whole(0, 2) != 0) {
    for (std::vector<Sphere>* spheres : {&a, &b}) {
      for (Sphere& sphere : *spheres) sphere.radius *= 0.01;
    }
    const double way = a[0].radius + b[0].radius + random_gap(random, size);
    const Vector3d at = world_from_a * a[0].center + way * random.direction();
    const Pose turned(world_from_b.rotation(), Vector3d::Zero());
    world_from_b = Pose(world_from_b.rotation(), at - turned * b[0].center);
  }
  SphereTree first = build_tree(a, {.branching = random_branching(random)});
  return {std::move(first), world_from_a, build_tree(b, {.branching = random_branching(random)}),
          world_from_b};
}

// --- a tree and a primitive ---

// A solid, a point of its surface and a direction in which spheres that touch there lie.
struct SurfacePoint {
  Primitive solid;
  Vector3d point;
  Vector3d normal;
};

// Around a corner, along an edge or on a face: each coordinate of the normal is zero or outward.
SurfacePoint box_contact(Random& random, const Vector3d& size) {
  SurfacePoint contact{Box{size}, Vector3d::Zero(), Vector3d::Zero()};
  const int features = random.whole(1, 7);
  for (int i = 0; i < 3; ++i) {
    const double side = random.sign();
    const bool outward = (features >> i & 1) != 0;
    contact.point[i] = side * 0.5 * size[i] * (outward ? 1.0 : random.between(0.0, 1.0));
    contact.normal[i] = outward ? side * random.between(0.1, 1.0) : 0.0;
  }
  contact.normal.normalize();
  return contact;
}

Vector3d on_circle(Random& random) {
  const double angle = random.between(0.0, 7.0);
  return {std::cos(angle), std::sin(angle), 0.0};
}

SurfacePoint cylinder_contact(Random& random, double radius, double length) {
  const Vector3d out = on_circle(random);
  const double side = random.sign();
  const Vector3d end(0.0, 0.0, side * 0.5 * length);
  const Primitive solid = Cylinder{radius, length};
  switch (random.whole(0, 2)) {
    case 0:
      return {solid, radius * out + random.between(0.0, 1.0) * end, out};
    case 1:
      return {solid, random.between(0.0, 1.0) * radius * out + end, Vector3d(0.0, 0.0, side)};
    default:
      return {solid, radius * out + end,
              (out + Vector3d(0.0, 0.0, side * random.between(0.1, 5.0))).normalized()};
  }
}

SurfacePoint capsule_contact(Random& random, double radius, double length) {
  const double side = random.sign();
  const Vector3d end(0.0, 0.0, side * 0.5 * length);
  Vector3d out = on_circle(random);
  double along = random.between(-1.0, 1.0);
  if (random.whole(0, 1) == 0) {
    out = (out + Vector3d(0.0, 0.0, side * random.between(0.0, 5.0))).normalized();
    along = 1.0;
  }
  return {Capsule{radius, length}, along * end + radius * out, out};
}

// Sizes over many orders of magnitude, and needles and plates among them.
SurfacePoint random_contact(Random& random, double size) {
  const auto length = [&] {
    return size * (random.whole(0, 3) == 0 ? std::ldexp(1.0, random.whole(-30, -1))
                                           : random.between(0.1, 1.0));
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
      return {HalfSpace{}, Vector3d(random.between(-size, size), random.between(-size, size), 0.0),
              Vector3d::UnitZ()};
  }
}

// A sphere near a solid, and smaller ones that are nearer by no more than rounding; tree and solid
// are placed anywhere, far from the origin of the world and of their frames at times.
Scene<Primitive> near_contact(Random& random, const Primitive*) {
  const double size = std::ldexp(1.0, random.whole(-40, 17));
  const SurfacePoint contact = random_contact(random, size);
  const double radius = random.whole(0, 4) == 0 ? 0.0 : size * random.between(0.01, 2.0);
  const double deeper = random.whole(0, 3) == 0 ? 0.2 * size * random.whole(0, 4) : 0.0;
  const Vector3d center =
      contact.point + (radius + random_gap(random, size) - deeper) * contact.normal;
  const double frame = size * std::ldexp(1.0, random.whole(0, 10));
  const double world = size * std::ldexp(1.0, random.whole(0, 1) * random.whole(0, 30));
  const Pose world_from_solid = random.pose(world);
  const Pose solid_from_tree = random.pose(frame);
  const Pose tree_from_solid = solid_from_tree.inverse();
  std::vector<Sphere> spheres = {{tree_from_solid * center, radius}};
  for (int i = random.whole(0, 12); i > 0; --i) {
    const double share = random.between(0.0, 1.0);
    spheres.push_back({tree_from_solid * (center + share * radius * contact.normal),
                       (1.0 - random.between(0.0, 1.0)) * share * radius});
  }
  return {build_tree(spheres, {.branching = random_branching(random)}),
          world_from_solid * solid_from_tree, contact.solid, world_from_solid};
}

// --- a tree and a solid mesh ---

// A sphere inside or outside a tetrahedron, flat at times, whose vertices may be uncertain.
Scene<SolidMesh> near_contact(Random& random, const SolidMesh*) {
  const double size = std::ldexp(1.0, random.whole(-20, 17));
  const double flatness = random.whole(0, 3) == 0 ? std::ldexp(1.0, random.whole(-12, 0)) : 1.0;
  TriangleMesh mesh{{}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  Vector3d place = Vector3d::Zero();
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    const Vector3d corner = random.point(size).cwiseProduct(Vector3d(flatness, 1.0, 1.0));
    const double weight = random.between(-0.1, 1.0);
    place += weight * corner;
    sum += weight;
    mesh.vertices.push_back(corner);
  }
  if (random.coin()) {
    for (Eigen::Vector3i& t : mesh.triangles) std::swap(t[0], t[1]);
  }
  mesh.vertex_error = random.whole(0, 1) * size * std::ldexp(1.0, random.whole(-50, -3));
  const Pose world_from_mesh = random.pose(size * random.whole(0, 8));
  const Pose world_from_tree = random.pose(size * random.whole(0, 8));
  Sphere sphere{world_from_tree.inverse() * (world_from_mesh * Vector3d(place / sum)), 0.0};
  SolidMesh solid(mesh);
  if (random.whole(0, 3) != 0) {
    const Real gap = gap_of(sphere, world_from_tree, solid, world_from_mesh);
    sphere.radius = std::max(0.0, std::abs(gap.convert_to<double>()) + random_gap(random, size));
  }
  return {tree_of(sphere), world_from_tree, std::move(solid), world_from_mesh, 1e-6 * size};
}

// --- what holds for each ---

template <class Shape>
class Queries : public ::testing::Test {
 protected:
  static Scene<Shape> scene(Random& random) {
    return near_contact(random, static_cast<const Shape*>(nullptr));
  }
};
using Shapes = ::testing::Types<SphereTree, Primitive, SolidMesh>;
TYPED_TEST_SUITE(Queries, Shapes);

TYPED_TEST(Queries, NeitherMissNorInventAContact) {
  Random random(seeded(1));
  int touching = 0, slack_needed = 0, free = 0;
  for (int i = 0; i < scaled(1500, 150); ++i) {
    const Scene<TypeParam> scene = this->scene(random);
    const Real gap = scene.gap();
    const bool hit = scene.collides();
    ASSERT_TRUE(hit || gap > 0) << i;
    ASSERT_TRUE(!hit || gap <= scene.slack()) << i << ' ' << gap;
    ASSERT_EQ(scene.within(0.0), hit);
    touching += gap <= 0;
    slack_needed += hit && gap > 0;
    free += !hit;
  }
  EXPECT_GT(touching, effort(200, 20));
  EXPECT_GT(slack_needed, effort(15, 1));
  EXPECT_GT(free, effort(100, 10));
}

TYPED_TEST(Queries, KeepAClearance) {
  Random random(seeded(2));
  int counts[2] = {};
  for (int i = 0; i < scaled(300, 40); ++i) {
    const Scene<TypeParam> scene = this->scene(random);
    const Real exact = scene.gap();
    const double gap = std::max(0.0, exact.convert_to<double>());
    for (const double factor :
         {0.5, 1.0 - 1e-12, 1.0 - 1e-15, 1.0, 1.0 + 1e-15, 1.0 + 1e-12, 20.0}) {
      const double clearance = factor * gap;
      const bool hit = scene.within(clearance);
      ASSERT_TRUE(hit || exact > clearance) << i << ' ' << factor;
      ASSERT_TRUE(!hit || exact <= Real(clearance) + scene.slack(clearance)) << i << ' ' << factor;
      ++counts[hit];
    }
  }
  EXPECT_GT(counts[0], effort(30, 3));
  EXPECT_GT(counts[1], effort(30, 3));
  for (const double bad : {std::nan(""), HUGE_VAL, -1e-300, 2e15}) {
    EXPECT_THROW((void)this->scene(random).within(bad), Error);
  }
}

TYPED_TEST(Queries, BoundTheDistance) {
  Random random(seeded(3));
  int apart = 0, overlapping = 0;
  for (int i = 0; i < scaled(250, 40); ++i) {
    const Scene<TypeParam> scene = this->scene(random);
    const Real exact = std::max(Real(0), scene.gap());
    const DistanceResult result = scene.distance();
    ASSERT_LE(result.lower, exact) << i;
    ASSERT_GE(result.upper, exact) << i;
    ASSERT_LE(result.upper - result.lower, scene.width() + 1e-14 * result.upper + scene.loss) << i;
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
  EXPECT_GT(apart, effort(50, 5));
  EXPECT_GT(overlapping, effort(50, 5));
}

TYPED_TEST(Queries, FindTheDeepestContact) {
  Random random(seeded(4));
  int found = 0;
  for (int i = 0; i < scaled(250, 40); ++i) {
    const Scene<TypeParam> scene = this->scene(random);
    const auto contact = scene.deepest_contact();
    ASSERT_EQ(contact.has_value(), scene.collides());
    if (!contact) continue;
    ++found;
    const Real depth = -scene.gap();
    ASSERT_LE(contact->penetration_depth, depth) << i;
    ASSERT_GE(contact->penetration_depth, depth - 4.0 * scene.slack() - scene.loss) << i;
    // The point is in both.
    const Sphere point{contact->position, 0.0};
    double error = 1e-14 * (scene.world_from_shape.translation().template lpNorm<1>() +
                            scene.world_from_tree.translation().template lpNorm<1>()) +
                   10.0 * scene.slack() + scene.loss;
    // The nearest point of a triangle is known to a millionth of its distance, and the point may
    // be on the surface before the solid is inflated.
    if constexpr (std::is_same_v<TypeParam, SolidMesh>) {
      error += 1e-6 * scene.tree.root().radius + (1.0 + 1e-6) * scene.shape.inflation();
    }
    ASSERT_LE(gap_of(point, Pose(), scene.shape, scene.world_from_shape), error) << i;
    ASSERT_LE(gap_of(point, Pose(), scene.tree, scene.world_from_tree), error) << i;
  }
  EXPECT_GT(found, effort(80, 10));
}

// --- lists of pairs ---

template <class Shape>
class Pairs : public Queries<Shape> {};
using ShapesWithPairs = ::testing::Types<SphereTree, Primitive>;
TYPED_TEST_SUITE(Pairs, ShapesWithPairs);

// By the exact gaps of single spheres, and the same for every tree.
TYPED_TEST(Pairs, AreThoseOfSingleSpheres) {
  Random random(seeded(5));
  int several = 0;
  for (int i = 0; i < scaled(300, 120); ++i) {
    const Scene<TypeParam> scene = this->scene(random);
    const CollisionResult result = scene.collide();
    ASSERT_TRUE(result.complete);
    ASSERT_EQ(result.verdict, scene.collides() ? Verdict::kCollision : Verdict::kFree) << i;
    ASSERT_EQ(result.pairs.empty(), result.verdict == Verdict::kFree);
    ASSERT_TRUE(std::is_sorted(result.pairs.begin(), result.pairs.end()));
    ASSERT_EQ(std::adjacent_find(result.pairs.begin(), result.pairs.end()), result.pairs.end());
    std::set<std::int32_t> found;
    for (const SpherePair& pair : result.pairs) found.insert(pair.a);
    for (std::size_t k = 0; k < scene.tree.spheres().size(); ++k) {
      const Real gap = scene.gap(scene.tree.spheres()[k]);
      ASSERT_TRUE(gap > 0 || found.contains(static_cast<std::int32_t>(k)));
      ASSERT_TRUE(gap <= scene.slack() || !found.contains(static_cast<std::int32_t>(k)));
    }
    for (const int branching : {2, 16}) {
      const SphereTree other = build_tree(scene.tree.spheres(), {.branching = branching});
      ASSERT_EQ(collide(other, scene.world_from_tree, scene.shape, scene.world_from_shape).pairs,
                result.pairs);
    }
    ASSERT_TRUE(result.pairs.empty() ? result.distance_lower_bound <= scene.gap()
                                     : result.distance_lower_bound == 0.0);
    several += result.pairs.size() > 1;
  }
  EXPECT_GT(several, effort(30, 2));
}

TYPED_TEST(Pairs, WithinLimitsAreSomeOfThemAndNeverFree) {
  Random random(seeded(6));
  int unknown = 0, limited = 0;
  for (int i = 0; i < scaled(100, 20); ++i) {
    const Scene<TypeParam> scene = this->scene(random);
    const CollisionResult full = scene.collide();
    const auto expect_part = [&](const CollisionResult& part) {
      EXPECT_TRUE(std::includes(full.pairs.begin(), full.pairs.end(), part.pairs.begin(),
                                part.pairs.end()));
      EXPECT_TRUE(!part.complete || part.pairs == full.pairs);
      EXPECT_TRUE(part.verdict == full.verdict || part.verdict == Verdict::kUnknown);
      if (part.verdict != Verdict::kUnknown) return;
      EXPECT_TRUE(part.pairs.empty() && !part.complete && part.distance_lower_bound == 0.0);
      ++unknown;
    };
    for (std::uint64_t budget = 0; budget < 200; budget = budget * 2 + 1) {
      const CollisionResult result = scene.collide({.max_node_tests = budget});
      ASSERT_LE(result.cost.node_tests, budget);
      expect_part(result);
    }
    for (const std::size_t limit : {std::size_t{0}, std::size_t{1}, std::size_t{3}}) {
      const CollisionResult result = scene.collide({.max_pairs = limit});
      expect_part(result);
      ASSERT_EQ(result.pairs.size(), std::min(limit, full.pairs.size()));
      ASSERT_EQ(result.verdict, full.verdict);
      limited += result.pairs.size() < full.pairs.size();
    }
    const CollisionResult none = scene.collide({.max_time = std::chrono::nanoseconds(0)});
    ASSERT_EQ(none.verdict, Verdict::kUnknown);
    ASSERT_EQ(none.cost.node_tests, 0u);
    expect_part(scene.collide({.max_time = std::chrono::nanoseconds(500)}));
    ASSERT_EQ(scene.collide({.max_time = std::chrono::hours(1)}).pairs, full.pairs);
  }
  EXPECT_GT(unknown, effort(100, 15));
  EXPECT_GT(limited, effort(30, 5));
}

// --- trees alone ---

// Beside every second sphere one of the other set, at a gap of a share of the slack: there the pads
// decide, and least of all may the trees (G7).
TEST(Trees, FindExactlyThePairsThatTheCanonicalTestAccepts) {
  Random random(seeded(7));
  std::size_t pairs = 0, close = 0;
  for (int i = 0; i < scaled(300, 60); ++i) {
    const double size = std::ldexp(1.0, random.whole(-20, 20));
    const int count = random.whole(1, 120);
    const double largest_radius = size * random.between(0.0, 4.0) / std::sqrt(count);
    const std::vector<Sphere> first = random_spheres(random, count, size, largest_radius);
    std::vector<Sphere> second = random_spheres(random, count, size, largest_radius);
    const Pose world_from_a = random.pose(size), world_from_b = random.pose(1.5 * size);
    for (std::size_t k = 0; k < first.size(); k += 2) {
      const double gap = size * random.between(-1e-13, 4e-13);
      const double way = first[k].radius + second[k].radius + gap;
      second[k].center = world_from_b.inverse() *
                         (world_from_a * Vector3d(first[k].center + way * random.direction()));
    }
    std::vector<SpherePair> expected;
    for (const int branching : {2, 8, 16}) {
      const SphereTree a = build_tree(first, {.branching = branching});
      const SphereTree b = build_tree(second, {.branching = branching});
      const internal::RelativePose pose(a, world_from_a, b, world_from_b);
      for (std::int32_t j = 0; branching == 2 && j < count; ++j) {
        for (std::int32_t k = 0; k < count; ++k) {
          const Sphere &of_a = first[static_cast<std::size_t>(j)],
                       &of_b = second[static_cast<std::size_t>(k)];
          if (pose.touches(of_a, of_b)) expected.push_back({j, k});
          close += std::abs(pose.gap(of_a, of_b)) < 4e-13 * size;
        }
      }
      ASSERT_EQ(collide(a, world_from_a, b, world_from_b).pairs, expected) << branching;
      std::vector<SpherePair> swapped = collide(b, world_from_b, a, world_from_a).pairs;
      for (SpherePair& pair : swapped) std::swap(pair.a, pair.b);
      std::sort(swapped.begin(), swapped.end());
      ASSERT_EQ(swapped, expected) << branching;
    }
    pairs += expected.size();
  }
  EXPECT_GT(pairs, effort(1000u, 200u));
  EXPECT_GT(close, effort(1000u, 200u));
}

TEST(Trees, HaveOneDeepestContactWhateverTheirShape) {
  Random random(8);
  for (int i = 0; i < 100; ++i) {
    const Scene<SphereTree> scene = near_contact(random, static_cast<const SphereTree*>(nullptr));
    const std::optional<Contact> expected = scene.deepest_contact();
    for (const int branching : {2, 16}) {
      const SphereTree a = build_tree(scene.tree.spheres(), {.branching = branching});
      const SphereTree b = build_tree(scene.shape.spheres(), {.branching = branching});
      const auto contact = deepest_contact(a, scene.world_from_tree, b, scene.world_from_shape);
      ASSERT_EQ(contact.has_value(), expected.has_value());
      if (!contact) continue;
      ASSERT_EQ(contact->kind, ContactKind::kLeaves);
      ASSERT_EQ(contact->leaves, expected->leaves);
      ASSERT_EQ(contact->penetration_depth, expected->penetration_depth);
      ASSERT_EQ(contact->position, expected->position);
    }
  }
}

TEST(Trees, OfOneSphereCostOneTest) {
  const SphereTree sphere = tree_of({Vector3d::Zero(), 1.0});
  const CollisionResult far = collide(sphere, Pose(), sphere, Pose::from_translation({5, 0, 0}));
  EXPECT_EQ(far.verdict, Verdict::kFree);
  EXPECT_EQ(far.cost.node_tests, 1u);
  EXPECT_EQ(far.cost.leaf_tests, 1u);
  EXPECT_NEAR(far.distance_lower_bound, 3.0, 1e-12);
  const DistanceResult result = distance(sphere, Pose(), sphere, Pose::from_translation({3, 4, 0}));
  EXPECT_NEAR(result.lower, 3.0, 1e-12);
  EXPECT_NEAR(result.upper, 3.0, 1e-12);
  EXPECT_EQ(result.nearest, (SpherePair{0, 0}));
  EXPECT_EQ(result.cost.leaf_tests, 1u);
  EXPECT_EQ(distance(sphere, Pose(), sphere, Pose()).upper, 0.0);
}

// --- primitives alone ---

TEST(Primitives, OfEquallyDeepSpheresTheFirstIsTheDeepest) {
  for (const double side : {-1.0, 1.0}) {
    std::vector<Sphere> spheres = {{{0.0, 0.0, 9.0}, 1.0}};
    for (int i = 0; i < 9; ++i) spheres.push_back({{side * i, 0.0, 0.5}, 1.0});
    EXPECT_EQ(deepest_contact(build_tree(spheres), Pose(), HalfSpace{}, Pose())->leaves.a, 1);
  }
}

TEST(Primitives, HoldsForTheSmallestAndTheLargest) {
  for (const double size : {0x1p-1074, 0x1p-1000, 0x1p-540, 0x1p-500, 1e-30, 1e14}) {
    const SphereTree tree =
        build_tree(std::vector<Sphere>{{{size, 0.0, 0.0}, 0.0}, {{0.0, size, -size}, size}});
    for (const Primitive& solid : {Primitive(Box{{size, size, size}}), Primitive(SolidSphere{size}),
                                   Primitive(Cylinder{size, size}), Primitive(Capsule{size, size}),
                                   Primitive(HalfSpace{})}) {
      for (const double way : {0.0, 0.5, 3.0, 7.0}) {
        const Pose pose(Eigen::Quaterniond(1.0, 2.0, -3.0, 4.0), Vector3d(way, 0.0, way) * size);
        const Scene<Primitive> scene = {tree, pose, solid, Pose()};
        const Real exact = scene.gap();
        ASSERT_TRUE(scene.collides() || exact > 0);
        ASSERT_LE(scene.distance().lower, std::max(exact, Real(0)));
        ASSERT_GE(scene.distance().upper, exact);
      }
    }
  }
}

TEST(Primitives, RefusesWhatIsNoSolid) {
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
}  // namespace spherule::test
