// SPDX-License-Identifier: BSD-3-Clause
// Any shape against any, by every verb: against distances in long double, found by nested searches
// for the minimum of a convex function, and against exact triangles next to contact.
#include "base/error.h"
#include "collide/shapes.h"
#include "spheretree/build.h"
#include "tests/support/effort.h"
#include "tests/support/exact/shapes.h"
#include "tests/support/random_scene.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using Long = long double;
using Point = Eigen::Matrix<Long, 3, 1>;
using Turn = Eigen::Matrix<Long, 3, 3>;

constexpr Long kInfinite = std::numeric_limits<Long>::infinity();

// A convex core in the world: what `at` takes a box of parameters to, and the distance from a point.
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
    return std::min({to_segment(p, t[0], t[1]), to_segment(p, t[1], t[2]), to_segment(p, t[2], t[0])});
  };
  const auto reach = [t](const Point& d) { return std::max({d.dot(t[0]), d.dot(t[1]), d.dot(t[2])}); };
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
  return {0, [c](Long, Long, Long) { return c; }, [c](const Point& p) -> Long { return (p - c).norm(); },
          [c](const Point& d) { return d.dot(c); }, sphere.radius};
}

// The least value of a convex function on [-1, 1].
template <class F>
Long least(const F& f) {
  constexpr Long kGolden = 0.61803398874989484820L;
  Long low = -1, high = 1, a = high - kGolden * 2, b = low + kGolden * 2;
  Long at_a = f(a), at_b = f(b), best = std::min({f(-1), f(1), at_a, at_b});
  for (int i = 0; i < 44; ++i) {
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
  const TriangleMesh surface = random_triangles(random, 3, 0.8, random.whole(0, 3) == 0 ? 1e-7 : 1.0);
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
       std::make_shared<const CoveredMesh>(
           plain, std::make_shared<const SphereTree>(build_tree(around))),
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
  const Core& a = cores_a.size() == 1 ? cores_a[0] : cores_a.at(static_cast<std::size_t>(contact.leaves.a));
  const Core& b = cores_b.size() == 1 ? cores_b[0] : cores_b.at(static_cast<std::size_t>(contact.leaves.b));
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
  for (int round = 0; round < effort(4, 1); ++round) {
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
  EXPECT_GT(apart, 100);
  EXPECT_GT(touching, 100);
  std::printf("widest %g apart %d touching %d\n", widest, apart, touching);
}

}  // namespace
}  // namespace spherule::test
