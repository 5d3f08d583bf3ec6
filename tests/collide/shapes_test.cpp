// SPDX-License-Identifier: BSD-3-Clause
// Any shape against any, by every verb: against distances in long double, found by nested searches
// for the minimum of a convex function, and against exact triangles next to contact.
#include "collide/shapes.h"

#include "base/error.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/effort.h"
#include "tests/support/exact/shapes.h"
#include "tests/support/random_scene.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Long = long double;
using Point = Eigen::Matrix<Long, 3, 1>;
using Turn = Eigen::Matrix<Long, 3, 3>;

constexpr Long kInfinite = std::numeric_limits<Long>::infinity();

// A convex core in the world: what `at` takes a box of parameters to, and the distance from a
// point.
struct Core {
  int parameters = 0;  // each from -1 to 1
  std::function<Point(Long, Long, Long)> at;
  std::function<Long(const Point&)> distance;
  std::function<Long(const Point&)> reach;  // the greatest d.x
  Long radius = 0;
};

Point exactly(const Vector3d& v) {
  return v.cast<Long>();
}

Turn turn_of(const Pose& pose) {
  return Eigen::Quaternion<Long>(pose.rotation().cast<Long>()).normalized().toRotationMatrix();
}

Long to_segment(const Point& p, const Point& a, const Point& b) {
  const Point e = b - a;
  const Long square = e.squaredNorm();
  const Long t = square > 0 ? std::clamp<Long>((p - a).dot(e) / square, 0, 1) : 0;
  return (a + t * e - p).norm();
}

Core triangle_core(const std::array<Vector3d, 3>& corners, const Pose& pose, double radius) {
  std::array<Point, 3> t;
  for (std::size_t i = 0; i < 3; ++i) {
    t[i] = turn_of(pose) * exactly(corners[i]) + exactly(pose.translation());
  }
  const auto at = [t](Long u, Long v, Long) -> Point {
    const Long s = (u + 1) / 2, w = (v + 1) / 2;
    return t[0] + s * ((1 - w) * (t[1] - t[0]) + w * (t[2] - t[0]));
  };
  const auto distance = [t](const Point& p) {
    const Point n = (t[1] - t[0]).cross(t[2] - t[0]);
    const auto side = [&](std::size_t i) {
      return n.dot((t[(i + 1) % 3] - t[i]).cross(p - t[i])) >= 0;
    };
    if (n.squaredNorm() > 0 && side(0) && side(1) && side(2)) {
      return std::abs(n.dot(p - t[0])) / n.norm();
    }
    return std::min(
        {to_segment(p, t[0], t[1]), to_segment(p, t[1], t[2]), to_segment(p, t[2], t[0])});
  };
  const auto reach = [t](const Point& d) {
    return std::max({d.dot(t[0]), d.dot(t[1]), d.dot(t[2])});
  };
  return {2, at, distance, reach, radius};
}

// The points z, x or (x, y) of a frame that a solid is made of.
Core solid_core(const Primitive& solid, const Pose& pose, double rounding) {
  const Turn turn = turn_of(pose);
  const Point place = exactly(pose.translation());
  Core core;
  core.radius = rounding;
  Point half = Point::Zero();
  Long disc = 0;
  if (const auto* box = std::get_if<Box>(&solid)) half = exactly(box->size) / 2;
  if (const auto* sphere = std::get_if<SolidSphere>(&solid)) core.radius += sphere->radius;
  if (const auto* capsule = std::get_if<Capsule>(&solid)) {
    half.z() = Long(capsule->length) / 2;
    core.radius += capsule->radius;
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&solid)) {
    half.z() = Long(cylinder->length) / 2;
    disc = cylinder->radius;
  }
  const bool is_half_space = std::holds_alternative<HalfSpace>(solid);
  core.parameters = is_half_space ? 4 : half.x() > 0 || disc > 0 ? 3 : half.z() > 0 ? 1 : 0;
  core.at = [=](Long u, Long v, Long w) -> Point {
    Point p(v * half.x(), w * half.y(), u * half.z());
    if (disc > 0) p += disc * Point(v, w * std::sqrt(std::max<Long>(0, 1 - v * v)), 0);
    return turn * p + place;
  };
  core.distance = [=](const Point& x) -> Long {
    const Point p = turn.transpose() * (x - place);
    if (is_half_space) return std::max<Long>(p.z(), 0);
    if (disc > 0) {
      return std::hypot(std::max<Long>(std::hypot(p.x(), p.y()) - disc, 0),
                        std::max<Long>(std::abs(p.z()) - half.z(), 0));
    }
    return (p.cwiseAbs() - half).cwiseMax(Long(0)).norm();
  };
  core.reach = [=](const Point& d) -> Long {
    const Point local = turn.transpose() * d;
    if (is_half_space) {
      return local.z() > 0 && local.head<2>().norm() < 1e-9 * local.z() ? d.dot(place) : kInfinite;
    }
    return d.dot(place) + local.cwiseAbs().dot(half) + disc * local.head<2>().norm();
  };
  return core;
}

Core sphere_core(const Sphere& sphere, const Pose& pose) {
  const Point c = turn_of(pose) * exactly(sphere.center) + exactly(pose.translation());
  return {0, [c](Long, Long, Long) { return c; },
          [c](const Point& p) -> Long { return (p - c).norm(); },
          [c](const Point& d) { return d.dot(c); }, sphere.radius};
}

// The least value of a convex function on [-1, 1].
template <class F>
Long least(const F& f) {
  constexpr Long kGolden = 0.61803398874989484820L;
  Long low = -1, high = 1, a = high - kGolden * 2, b = low + kGolden * 2;
  Long at_a = f(a), at_b = f(b), best = std::min({f(-1), f(1), at_a, at_b});
  for (int i = 0; i < 36; ++i) {
    if (at_a < at_b) {
      high = b, b = a, at_b = at_a;
      at_a = f(a = high - kGolden * (high - low));
    } else {
      low = a, a = b, at_a = at_b;
      at_b = f(b = low + kGolden * (high - low));
    }
    best = std::min({best, at_a, at_b});
  }
  return best;
}

// Never below the exact one, and above it by the search only.
Long core_distance(const Core& a, const Core& b) {
  if (a.parameters > b.parameters) return core_distance(b, a);
  const auto f = [&](Long u, Long v, Long w) { return b.distance(a.at(u, v, w)); };
  Long found = 0;
  if (a.parameters == 0) {
    found = f(0, 0, 0);
  } else if (a.parameters == 1) {
    found = least([&](Long u) { return f(u, 0, 0); });
  } else if (a.parameters == 2) {
    found = least([&](Long u) { return least([&](Long v) { return f(u, v, 0); }); });
  } else {
    found = least([&](Long u) {
      return least([&](Long v) { return least([&](Long w) { return f(u, v, w); }); });
    });
  }
  return std::max<Long>(0, found - a.radius - b.radius);
}

// A shape of the library and the cores that it consists of, placed.
struct Body {
  std::string name;
  Shape shape;
  std::function<std::vector<Core>(const Pose&)> cores;
  bool has_leaves_of_cores = true;  // the cores are the leaves, in their order
};

Body solid_body(const std::string& name, const Primitive& solid, double rounding = 0.0) {
  return {name, RoundedSolid{solid, rounding},
          [=](const Pose& pose) { return std::vector{solid_core(solid, pose, rounding)}; }};
}

// Meshes with an inside are boxes, so that one core is the whole.
std::vector<Body> bodies(Random& random) {
  const auto length = [&] { return random.between(0.3, 1.5); };
  const std::vector<Sphere> spheres = random_spheres(random, 4, 0.8, 0.4);
  const TriangleMesh surface =
      random_triangles(random, 3, 0.8, random.whole(0, 3) == 0 ? 1e-7 : 1.0);
  const Vector3d size(length(), length(), length());
  TriangleMesh grown = make_box(size);
  grown.vertex_error = 0.125;
  const TriangleMesh plain = make_box(size);
  const std::vector<Sphere> around{{Vector3d::Zero(), 0.51 * size.norm()}};
  const auto box_cores = [size](double growth) {
    return [=](const Pose& pose) { return std::vector{solid_core(Box{size}, pose, growth)}; };
  };
  return {
      {"tree", std::make_shared<const SphereTree>(build_tree(spheres)),
       [=](const Pose& pose) {
         std::vector<Core> cores;
         for (const Sphere& sphere : spheres) cores.push_back(sphere_core(sphere, pose));
         return cores;
       }},
      {"surface", std::make_shared<const MeshTree>(surface),
       [=](const Pose& pose) {
         std::vector<Core> cores;
         for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
           cores.push_back(triangle_core(corners_of(surface, i), pose, 0.0));
         }
         return cores;
       }},
      {"solid mesh", std::make_shared<const SolidMesh>(grown), box_cores(0.125), false},
      {"covered mesh",
       std::make_shared<const CoveredMesh>(plain,
                                           std::make_shared<const SphereTree>(build_tree(around))),
       box_cores(0.0), false},
      solid_body("box", Box{size}),
      solid_body("sphere", SolidSphere{length()}),
      solid_body("cylinder", Cylinder{length(), length()}),
      solid_body("capsule", Capsule{length(), length()}),
      solid_body("half-space", HalfSpace{}),
      solid_body("rounded box", Box{size}, 0.25),
      solid_body("rounded cylinder", Cylinder{length(), 1e-3}, 0.1),
      solid_body("rounded half-space", HalfSpace{}, 0.3),
  };
}

bool is_half_space(const Body& body) {
  return body.name.ends_with("half-space");
}

Long oracle(const Body& a, const Pose& world_from_a, const Body& b, const Pose& world_from_b) {
  Long found = kInfinite;
  for (const Core& of_a : a.cores(world_from_a)) {
    for (const Core& of_b : b.cores(world_from_b)) {
      found = std::min(found, core_distance(of_a, of_b));
    }
  }
  return found;
}

// What a contact says of its two leaves, where these are the oracle's cores.
void expect_contact(const Contact& contact, const std::vector<Core>& cores_a,
                    const std::vector<Core>& cores_b, double size, const std::string& what) {
  ASSERT_NEAR(contact.normal.norm(), 1.0, 1e-12) << what;
  const Core& a =
      cores_a.size() == 1 ? cores_a[0] : cores_a.at(static_cast<std::size_t>(contact.leaves.a));
  const Core& b =
      cores_b.size() == 1 ? cores_b[0] : cores_b.at(static_cast<std::size_t>(contact.leaves.b));
  EXPECT_LE(a.distance(exactly(contact.nearest_points[0])), a.radius + 1e-6 * size) << what;
  EXPECT_LE(b.distance(exactly(contact.nearest_points[1])), b.radius + 1e-6 * size) << what;
  const auto overlap = [&](const Point& d) {
    return (a.reach(d) + b.reach(-d)) / d.norm() + a.radius + b.radius;
  };
  // Along any direction the two overlap by as much at least, and along the normal by little more.
  const Point normal = exactly(contact.normal);
  ASSERT_LE(contact.penetration_depth, overlap(normal)) << what;
  EXPECT_GE(contact.penetration_depth, overlap(normal) * 0.98L - 1e-6 * size) << what;
  Random random(7);
  for (int i = 0; i < 300; ++i) {
    const Point d = i % 2 == 0 ? exactly(random.direction())
                               : Point(normal + 0.1 * exactly(random.direction()));
    ASSERT_LE(contact.penetration_depth, overlap(d)) << what;
  }
}

TEST(Shapes, EveryPairByEveryVerb) {
  Random random(20);
  double widest = 0.0;
  int apart = 0, touching = 0;
  for (int round = 0; round < 2; ++round) {
    const std::vector<Body> all = bodies(random);
    for (const Body& a : all) {
      for (const Body& b : all) {
        if (is_half_space(a) && is_half_space(b)) continue;
        const std::string what = a.name + ", " + b.name + " " + std::to_string(round);
        const Pose world_from_a = random.pose(round % 2 == 0 ? 1.0 : 100.0);
        const Pose world_from_b(random.quaternion(),
                                world_from_a.translation() + random.point(round == 0 ? 0.5 : 2.5));
        const Long exact = oracle(a, world_from_a, b, world_from_b);
        const auto exact_up = static_cast<double>(exact) + 1e-15;
        const ShapeRef x = a.shape, y = b.shape;
        const DistanceResult found = distance(x, world_from_a, y, world_from_b);
        ASSERT_TRUE(found.complete);
        ASSERT_LE(found.lower, exact_up) << what;
        ASSERT_GE(found.upper, static_cast<double>(exact) - 1e-7) << what;
        ASSERT_LE(found.upper - found.lower, 1e-7) << what;
        widest = std::max(widest, found.upper - found.lower);
        const bool hit = collides(x, world_from_a, y, world_from_b);
        ASSERT_EQ(hit, within(x, world_from_a, y, world_from_b, 0.0)) << what;
        ASSERT_TRUE(hit || exact > 0) << what;
        ASSERT_TRUE(!hit || exact < 1e-7) << what;
        (hit ? touching : apart) += 1;
        ASSERT_TRUE(within(x, world_from_a, y, world_from_b, exact_up)) << what;
        if (exact > 1e-6) {
          ASSERT_FALSE(within(x, world_from_a, y, world_from_b, static_cast<double>(exact) - 1e-7));
        }
        const CollisionResult pairs = collide(x, world_from_a, y, world_from_b);
        ASSERT_EQ(pairs.verdict == Verdict::kCollision, hit) << what;
        ASSERT_LE(pairs.distance_lower_bound, exact_up) << what;
        const std::optional<Contact> contact = deepest_contact(x, world_from_a, y, world_from_b);
        ASSERT_EQ(contact.has_value(), hit) << what;
        if (contact && a.has_leaves_of_cores && b.has_leaves_of_cores) {
          expect_contact(*contact, a.cores(world_from_a), b.cores(world_from_b), 10.0, what);
        }
        // Exchanged.
        const DistanceResult back = distance(y, world_from_b, x, world_from_a);
        ASSERT_TRUE(back.lower <= found.upper && found.lower <= back.upper) << what;
        ASSERT_EQ(collides(y, world_from_b, x, world_from_a), hit) << what;
        ASSERT_EQ(deepest_contact(y, world_from_b, x, world_from_a).has_value(), hit) << what;
      }
    }
  }
  EXPECT_LT(widest, 1e-10);
  EXPECT_GT(apart, 50);
  EXPECT_GT(touching, 50);
}

// A corner, an edge or a face of a triangle next to one of another, or of a box made of triangles.
struct NearTriangles {
  TriangleMesh a, b;
  Pose world_from_a, world_from_b;
  double size;
};

NearTriangles near_triangles(Random& random, int i) {
  const double size = std::pow(10.0, random.whole(-9, 9));
  NearTriangles scene;
  scene.size = size;
  const double width = i % 5 == 0 ? 1e-6 : 1.0;  // needles
  scene.a = random_triangles(random, 1, 1.0, width);
  scene.b = random_triangles(random, 1, 1.0, width);
  const auto corner = [](TriangleMesh& mesh, int k) -> Vector3d& {
    return mesh.vertices[static_cast<std::size_t>(mesh.triangles[0][k])];
  };
  if (i % 7 == 0) corner(scene.a, 2) = corner(scene.a, 1);  // a segment
  if (i % 14 == 0) corner(scene.b, 1) = corner(scene.b, 2) = corner(scene.b, 0);
  if (i % 3 == 0) scene.b = scene.a;  // face to face
  for (TriangleMesh* mesh : {&scene.a, &scene.b}) {
    for (Vector3d& vertex : mesh->vertices) vertex *= size;
  }
  const Vector3d normal =
      (corner(scene.a, 1) - corner(scene.a, 0)).cross(corner(scene.a, 2) - corner(scene.a, 0));
  const Vector3d way =
      i % 2 == 0 && normal.norm() > 0 ? Vector3d(normal.normalized()) : random.direction();
  const auto on = [&](TriangleMesh& mesh) -> Vector3d {
    const double s = i % 4 == 0 ? 0.0 : random.between(0.0, 1.0);
    return corner(mesh, 0) + s * (corner(mesh, random.whole(1, 2)) - corner(mesh, 0));
  };
  constexpr double kSteps[] = {0.0, 1e-15, 1e-13, 1e-12, 1e-11, 1e-9, 1e-8, 1e-6, 1e-3, 0.1};
  const double gap = size * kSteps[random.whole(0, 9)];
  const Quaterniond turn = i % 3 == 0 ? Quaterniond::Identity() : random.rotation();
  scene.world_from_a = Pose(random.quaternion(), size * random.point(i % 2 == 0 ? 0.0 : 3.0));
  scene.world_from_b =
      scene.world_from_a * Pose(turn, on(scene.a) - turn * on(scene.b) + gap * way);
  return scene;
}

TEST(Shapes, TrianglesNextToContactAgainstExactOnes) {
  Random random(21);
  int apart = 0, touching = 0;
  for (int i = 0; i < effort(1500, 300); ++i) {
    const NearTriangles scene = near_triangles(random, i);
    const MeshTree a(scene.a), b(scene.b);
    const double exact = exact_gap(corners_of(scene.a, 0), scene.world_from_a,
                                   corners_of(scene.b, 0), scene.world_from_b);
    const DistanceResult found = distance(a, scene.world_from_a, b, scene.world_from_b);
    ASSERT_LE(found.lower, exact * (1.0 + 1e-15)) << i;
    ASSERT_GE(found.upper, exact * (1.0 - 1e-15)) << i;
    // Corners of needles are nearest to each other in a direction that rounding decides.
    const double slack = (i % 5 == 0 ? 1e-9 : 1e-12) * scene.size;
    ASSERT_LE(found.upper - found.lower, slack) << i << " " << exact / scene.size;
    const bool hit = collides(a, scene.world_from_a, b, scene.world_from_b);
    ASSERT_TRUE(hit || exact > 0.0) << i;
    ASSERT_TRUE(!hit || exact <= slack) << i;
    ASSERT_TRUE(within(a, scene.world_from_a, b, scene.world_from_b, exact)) << i;
    ASSERT_TRUE(within(b, scene.world_from_b, a, scene.world_from_a, exact)) << i;
    if (exact > slack) {
      ASSERT_FALSE(within(a, scene.world_from_a, b, scene.world_from_b, exact - slack)) << i;
    }
    const auto contact = deepest_contact(a, scene.world_from_a, b, scene.world_from_b);
    ASSERT_EQ(contact.has_value(), hit) << i;
    if (contact) {
      ASSERT_LE(contact->penetration_depth, exact > 0.0 ? -exact : 2.0 * scene.size) << i;
    }
    (hit ? touching : apart) += 1;
  }
  EXPECT_GT(apart, effort(300, 50));
  EXPECT_GT(touching, effort(150, 20));
}

TEST(Shapes, SolidsFaceToFaceNextToContact) {
  Random random(22);
  for (int i = 0; i < effort(3000, 300); ++i) {
    const double size = std::pow(10.0, random.whole(-9, 9));
    const bool flat = i % 3 == 0;
    const Vector3d half = size * Vector3d(1.0, 0.5, flat ? 1e-9 : 0.25);
    const double rounding = i % 2 == 0 ? 0.0 : 0.125 * size;
    const RoundedSolid box{Box{2.0 * half}, rounding};
    const Primitive other =
        i % 4 < 2 ? Primitive(Box{{size, size, size}}) : Primitive(Cylinder{0.5 * size, size});
    // Along z, both as they stand; then both by one pose, which moves them by rounding only.
    const std::array<double, 6> gaps = {1e-3, 1e-9, 1e-12, 0.0, -1e-12, -1e-3};
    const double gap = size * gaps[static_cast<std::size_t>(i % 6)];
    const Pose beside(Quaterniond(Eigen::AngleAxisd(random.between(-3, 3), Vector3d::UnitZ())),
                      {0.3 * size, 0.1 * size, half.z() + rounding + 0.5 * size + gap});
    const Pose world = i % 5 == 0 ? Pose() : random.pose(size);
    const DistanceResult found = distance(box, world, other, world * beside);
    const double exact = std::max(gap, 0.0);
    ASSERT_LE(found.lower, exact + 2e-14 * size) << i;
    ASSERT_GE(found.upper, exact - 2e-14 * size) << i;
    ASSERT_LE(found.upper - found.lower, 1e-12 * size) << i;
    ASSERT_EQ(collides(box, world, other, world * beside), gap < 1e-12 * size * 0.5 + 0.0) << i;
    const auto contact = deepest_contact(box, world, other, world * beside);
    if (!contact) continue;
    ASSERT_LE(contact->penetration_depth, -gap + 2e-14 * size) << i;
    ASSERT_GE(contact->penetration_depth, -gap * 0.98 - 1e-12 * size) << i;
    if (gap < -1e-6 * size && !flat) {
      ASSERT_GT(contact->normal.dot(world.matrix().col(2)), 1.0 - 1e-3) << i;
    }
  }
}

TEST(Shapes, WhatIsInsideTouches) {
  const TriangleMesh hull = make_box({4, 4, 4});
  const SolidMesh solid(hull), small(make_box({1, 1, 1}));
  const MeshTree surface(make_box({1, 1, 1})), shell(hull);
  const Pose inside = Pose::from_translation({0.5, 0.25, 0}),
             outside = Pose::from_translation({4, 0, 0});
  const std::vector<ShapeRef> kept = {small, surface, Box{{1, 1, 1}}, Capsule{0.25, 0.5},
                                      RoundedSolid{SolidSphere{0.25}, 0.25}};
  for (const ShapeRef& body : kept) {
    for (const auto& [a, b, at_a, at_b] : {std::tuple(ShapeRef(solid), body, Pose(), inside),
                                           std::tuple(body, ShapeRef(solid), inside, Pose())}) {
      EXPECT_TRUE(collides(a, at_a, b, at_b) && within(a, at_a, b, at_b, 0.1));
      EXPECT_EQ(distance(a, at_a, b, at_b).upper, 0.0);
      const CollisionResult found = collide(a, at_a, b, at_b);
      EXPECT_TRUE(found.verdict == Verdict::kCollision && found.pairs.empty());
      const auto contact = deepest_contact(a, at_a, b, at_b);
      ASSERT_TRUE(contact && contact->kind == ContactKind::kInside);
      const double rounding =
          body.get().index() == 4 ? std::get<RoundedSolid>(body.get()).rounding : 0;
      EXPECT_NEAR(contact->penetration_depth,
                  distance(shell, {}, body, inside).lower + 2.0 * rounding, 1e-9);
    }
    EXPECT_FALSE(collides(solid, {}, body, outside));
    EXPECT_FALSE(collides(shell, {}, body, inside));  // a surface has no inside
  }
  // A solid has one, whatever is in it.
  EXPECT_TRUE(collides(small, inside, Box{{4, 4, 4}}, {}) &&
              collides(HalfSpace{}, outside, surface, inside));
}

// A tree is where its spheres are, not where its frame is.
TEST(Shapes, ATreeInsideASolidIsFoundByItsSpheres) {
  const SolidMesh solid(make_box({4, 4, 4}));
  const SphereTree tree = build_tree(std::vector<Sphere>{{{10, 0, 0}, 0.1}});
  const Pose into = Pose::from_translation({-10, 0, 0});
  for (const auto& [at, verdict] :
       {std::pair(into, Verdict::kCollision), std::pair(Pose(), Verdict::kFree)}) {
    EXPECT_EQ(collide(tree, at, solid, Pose()).verdict, verdict);
    EXPECT_EQ(collide(solid, Pose(), tree, at).verdict, verdict);
    EXPECT_EQ(collides(tree, at, solid, Pose()), verdict == Verdict::kCollision);
  }
}

// A disc that is all but parallel to the plane: its rim reaches below its centre.
TEST(Shapes, ARimThatDipsIntoAHalfSpaceIsFound) {
  const Cylinder cylinder{.radius = 1.0, .length = 0.2};
  for (const double tilt : {1e-13, 4e-13, 8e-13, 1e-12, 1e-10}) {
    // The lowest point of the rim is at about length / 2 + tilt below the centre.
    const Pose at(Eigen::Quaterniond(1.0, 0.5 * tilt, 0.0, 0.0),
                  Eigen::Vector3d(0.0, 0.0, 0.1 + 0.7 * tilt));
    EXPECT_TRUE(collides(cylinder, at, HalfSpace{}, Pose())) << tilt;
    EXPECT_TRUE(collides(HalfSpace{}, Pose(), cylinder, at)) << tilt;
    EXPECT_EQ(distance(cylinder, at, HalfSpace{}, Pose()).lower, 0.0) << tilt;
  }
}

TEST(Shapes, MotionsThatAreFreeAreFreeAtEveryInstant) {
  Random random(23);
  int free = 0, hits = 0;
  for (int round = 0; round < effort(2, 1); ++round) {
    const std::vector<Body> all = bodies(random);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Body& a = all[i];
      const Body& b = all[(i + 1 + random.index(all.size() - 1)) % all.size()];
      if (is_half_space(a) && is_half_space(b)) continue;
      const auto motion = [&](double away) {
        const Pose start = Pose(random.quaternion(), random.point(away));
        return Motion::between(start, Pose(random.quaternion(), random.point(away)),
                               random.point(1.0));
      };
      const Motion of_a = motion(6.0);
      const Motion of_b = i % 2 == 0 ? motion(2.0) : Motion::still(random.pose(2.0));
      const double clearance = i % 3 == 0 ? 0.1 : 0.0;
      const SweepResult swept =
          sweep(a.shape, of_a, b.shape, of_b, {.clearance = clearance, .resolution = 1e-3});
      const auto is_within = [&](double t) {
        return within(a.shape, of_a.pose_at(t), b.shape, of_b.pose_at(t), clearance);
      };
      for (int k = 0; k <= 500; ++k) {
        const double t = swept.free_until * k / 500.0;
        ASSERT_TRUE(swept.free_until == 0.0 || !is_within(t)) << a.name << ", " << b.name << t;
      }
      ASSERT_TRUE(swept.verdict != Verdict::kCollision || is_within(swept.contact_at));
      ASSERT_EQ(swept.verdict == Verdict::kFree, swept.free_until == 1.0);
      free += swept.verdict == Verdict::kFree;
      hits += swept.verdict == Verdict::kCollision;
    }
  }
  EXPECT_GT(free, 2);
  EXPECT_GT(hits, 2);
  // A thin wall between two instants that are both free.
  const Motion through =
      Motion::between(Pose::from_translation({-9, 0, 0}), Pose::from_translation({9, 0, 0}));
  const Primitive wall = Box{{1e-6, 4, 4}};
  const auto still = Motion::still(Pose());
  const SweepResult hit = sweep(RoundedSolid{Box{{1e-3, 1e-3, 1e-3}}, 0.0}, through, wall, still);
  EXPECT_NE(hit.verdict, Verdict::kFree);
  EXPECT_LE(hit.free_until, 0.5);
  EXPECT_EQ(sweep(Box{}, through, wall, still, {.max_node_tests = 0}).verdict, Verdict::kUnknown);
}

template <class Any>
concept IsShape = requires(const Any& any) {
  collides(any, Pose(), any, Pose());
};
static_assert(IsShape<Box> && IsShape<Shape> && IsShape<MeshTree> && IsShape<RoundedSolid>);
static_assert(!IsShape<int> && !IsShape<TriangleMesh> && !IsShape<Sphere>);

TEST(Shapes, RefusesWhatIsNoNumberAndEndsAtLimits) {
  const Box box;
  const MeshTree mesh(make_sphere(1.0, 12, 11));
  for (const double wrong : {-1.0, std::nan(""), 1e16, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(collides(RoundedSolid{box, wrong}, {}, mesh, {}), Error);
    EXPECT_THROW(within(box, {}, mesh, {}, wrong), Error);
    EXPECT_THROW(sweep(box, Motion::still({}), mesh, Motion::still({}), {.clearance = wrong}),
                 Error);
  }
  const Pose apart = Pose::from_translation({9, 0, 0});
  EXPECT_FALSE(distance(mesh, {}, mesh, apart, {.max_node_tests = 3}).complete);
  EXPECT_EQ(collide(mesh, {}, mesh, {}, {.max_node_tests = 0}).verdict, Verdict::kUnknown);
  EXPECT_EQ(
      collide(mesh, {}, box, Pose::from_translation({1, 0, 0}), {.max_pairs = 2}).pairs.size(), 2U);
  EXPECT_GT(distance(mesh, {}, mesh, apart, {.enough = 1.0}).lower, 1.0);
  EXPECT_TRUE(collides(HalfSpace{}, {}, HalfSpace{}, apart));
  EXPECT_EQ(distance(HalfSpace{}, {}, HalfSpace{}, apart).lower, 0.0);
}

}  // namespace
}  // namespace spherule::test
