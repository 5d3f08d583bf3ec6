// SPDX-License-Identifier: BSD-3-Clause
// Spheres and meshes with their inside: tetrahedra next to contact in 100 digits, and shells of all
// kinds against winding numbers from solid angles.

#include "collide/meshes/solid_mesh.h"

#include "base/error.h"
#include "collide/search/relative_pose.h"
#include "spheretree/build.h"
#include "tests/collide/exact_triangles.h"
#include "tests/collide/trees.h"
#include "tests/support/effort.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spherule::test::solid_mesh_test {
namespace {

using Eigen::Vector3d;

SphereTree tree_of(const Sphere& sphere) {
  return build_tree(std::span(&sphere, 1));
}

// --- next to contact ---

struct TetrahedronScene {
  std::array<Vector3d, 4> corners;
  TriangleMesh mesh;
  Pose world_from_mesh;
  Sphere sphere;
  Pose world_from_sphere;
  double size = 0.0;

  Vector<Real> center() const { return transform(world_from_sphere, exact<Real>(sphere.center)); }
  Real distance_to_surface() const {
    Real least = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3i& t : mesh.triangles) {
      const std::array<Vector3d, 3> triangle = {corners[static_cast<std::size_t>(t[0])],
                                                corners[static_cast<std::size_t>(t[1])],
                                                corners[static_cast<std::size_t>(t[2])]};
      least = std::min(
          least, squared_distance_to_triangle(center(), placed<Real>(world_from_mesh, triangle)));
    }
    return sqrt(least);
  }
  // On the side of every face on which the fourth corner is.
  bool is_inside() const {
    std::array<Vector<Real>, 4> at;
    for (std::size_t i = 0; i < 4; ++i) {
      at[i] = transform(world_from_mesh, exact<Real>(corners[i]));
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector<Real>& a = at[(i + 1) % 4];
      const Vector<Real> normal =
          cross(difference(at[(i + 2) % 4], a), difference(at[(i + 3) % 4], a));
      const Real of_corner = dot(normal, difference(at[i], a));
      if (dot(normal, difference(center(), a)) * of_corner <= 0) return false;
    }
    return true;
  }
  // From the sphere to the solid; where negative, how far the sphere has to move, with the sign
  // changed.
  Real gap() const {
    const Real distance = distance_to_surface();
    return (is_inside() ? Real(-distance) : distance) - sphere.radius - mesh.vertex_error;
  }
  // What two times the rounding of relative_pose.h is, and the leaves of a mesh give away.
  double slack() const {
    const SphereTree tree = tree_of(sphere);
    return 2.5 * collision_slack(tree, world_from_sphere, MeshTree(mesh).tree(), world_from_mesh) +
           4e-16 * mesh.vertex_error;
  }
};

TetrahedronScene random_scene(SceneRandom& random) {
  const double size = std::ldexp(1.0, random.whole(-20, 17));
  TetrahedronScene scene;
  scene.size = size;
  const double flatness = random.whole(0, 3) == 0 ? std::ldexp(1.0, random.whole(-12, 0)) : 1.0;
  for (Vector3d& corner : scene.corners) {
    corner = random.point(size);
    corner.x() *= flatness;
  }
  scene.mesh.vertices.assign(scene.corners.begin(), scene.corners.end());
  scene.mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  if (random.whole(0, 1) == 0) {
    for (Eigen::Vector3i& t : scene.mesh.triangles) std::swap(t[0], t[1]);
  }
  scene.mesh.vertex_error = random.whole(0, 1) * size * std::ldexp(1.0, random.whole(-50, -3));
  scene.world_from_mesh = random.pose(size * random.whole(0, 8));
  scene.world_from_sphere = random.pose(size * random.whole(0, 8));
  // Where a weighted mean of the corners is, inside or out.
  Vector3d place = Vector3d::Zero();
  double sum = 0.0;
  for (const Vector3d& corner : scene.corners) {
    const double weight = random.uniform(-0.1, 1.0);
    place += weight * corner;
    sum += weight;
  }
  scene.sphere.center =
      scene.world_from_sphere.inverse() * (scene.world_from_mesh * Vector3d(place / sum));
  const double steps[] = {0.0, 4e-16, 2e-15, 1e-14, 1e-13, 1e-12, 1e-9, 1e-3};
  const double way = scene.distance_to_surface().convert_to<double>() - scene.mesh.vertex_error +
                     (random.whole(0, 1) == 0 ? 1.0 : -1.0) * steps[random.whole(0, 7)] * size;
  scene.sphere.radius = random.whole(0, 3) == 0 ? 0.0 : std::max(0.0, way);
  return scene;
}

TEST(SolidMeshTest, NeitherMissesNorInventsAContact) {
  SceneRandom random(1);
  int inside_untouched = 0, touching = 0, free = 0, slack_needed = 0;
  for (int i = 0; i < effort(700, 60); ++i) {
    const TetrahedronScene scene = random_scene(random);
    const SolidMesh solid(scene.mesh);
    ASSERT_TRUE(solid.is_closed());
    const SphereTree tree = tree_of(scene.sphere);
    const Real gap = scene.gap();
    const bool hit = collides(tree, scene.world_from_sphere, solid, scene.world_from_mesh);
    ASSERT_TRUE(hit || gap > 0) << i;
    ASSERT_TRUE(!hit || gap <= scene.slack()) << i << ' ' << gap;
    inside_untouched += scene.is_inside() && scene.sphere.radius == 0.0;
    touching += gap <= 0 && !scene.is_inside();
    free += !hit;
    slack_needed += hit && gap > 0;
  }
  EXPECT_GT(inside_untouched, effort(30, 2));
  EXPECT_GT(touching, effort(60, 5));
  EXPECT_GT(free, effort(60, 2));
  EXPECT_GT(slack_needed, effort(15, 1));
}

TEST(SolidMeshTest, WithinAClearance) {
  SceneRandom random(2);
  int counts[2] = {};
  for (int i = 0; i < effort(300, 40); ++i) {
    TetrahedronScene scene = random_scene(random);
    scene.sphere.radius *= 0.5;
    const SolidMesh solid(scene.mesh);
    const SphereTree tree = tree_of(scene.sphere);
    const double gap = std::max(0.0, scene.gap().convert_to<double>());
    for (const double factor : {0.5, 1.0 - 1e-12, 1.0, 1.0 + 1e-15, 1.0 + 1e-12, 20.0}) {
      const double clearance = factor * gap;
      const bool hit =
          within(tree, scene.world_from_sphere, solid, scene.world_from_mesh, clearance);
      ASSERT_TRUE(hit || scene.gap() > clearance) << i << ' ' << factor;
      ASSERT_TRUE(!hit || scene.gap() <= clearance + scene.slack() + 1e-14 * clearance)
          << i << ' ' << factor;
      ++counts[hit];
    }
  }
  EXPECT_GT(counts[0], effort(60, 5));
  EXPECT_GT(counts[1], effort(60, 5));
  const TetrahedronScene scene = random_scene(random);
  EXPECT_THROW(within(tree_of(scene.sphere), Pose(), SolidMesh(scene.mesh), Pose(), std::nan("")),
               Error);
}

TEST(SolidMeshTest, DistanceBoundsAreNeverCrossed) {
  SceneRandom random(3);
  int inside = 0, apart = 0;
  for (int i = 0; i < effort(300, 40); ++i) {
    TetrahedronScene scene = random_scene(random);
    if (random.whole(0, 1) == 0) scene.sphere.radius *= 0.5;
    const SolidMesh solid(scene.mesh);
    const SphereTree tree = tree_of(scene.sphere);
    const auto query = [&](const DistanceRequest& request) {
      return distance(tree, scene.world_from_sphere, solid, scene.world_from_mesh, request);
    };
    const Real exact = std::max(Real(0), scene.gap());
    const DistanceResult result = query({});
    ASSERT_LE(result.lower, exact) << i;
    ASSERT_GE(result.upper, exact) << i;
    ASSERT_LE(result.upper - result.lower, 2.0 * scene.slack() + 1e-6 * scene.size) << i;
    for (const DistanceRequest& request :
         {DistanceRequest{.tolerance = 0.3 * result.upper},
          DistanceRequest{.enough = 0.25 * result.lower}, DistanceRequest{.max_node_tests = 0},
          DistanceRequest{.max_node_tests = 2}}) {
      const DistanceResult rough = query(request);
      ASSERT_LE(rough.lower, exact);
      ASSERT_GE(rough.upper, exact);
    }
    ASSERT_TRUE(result.nearest.b >= 0 || result.nearest.a < 0 || scene.is_inside());
    inside += result.nearest.b < 0;
    apart += exact > 0;
  }
  EXPECT_GT(inside, effort(20, 2));
  EXPECT_GT(apart, effort(60, 5));
}

TEST(SolidMeshTest, DeepestContact) {
  SceneRandom random(4);
  int inside = 0, outside = 0;
  for (int i = 0; i < effort(250, 40); ++i) {
    TetrahedronScene scene = random_scene(random);
    scene.sphere.radius *= random.uniform(0.9, 2.0);
    const SolidMesh solid(scene.mesh);
    const SphereTree tree = tree_of(scene.sphere);
    const auto contact =
        deepest_contact(tree, scene.world_from_sphere, solid, scene.world_from_mesh);
    ASSERT_EQ(contact.has_value(),
              collides(tree, scene.world_from_sphere, solid, scene.world_from_mesh));
    if (!contact) continue;
    const Real depth = -scene.gap();
    ASSERT_LE(contact->overlap_depth, depth) << i;
    ASSERT_GE(contact->overlap_depth, depth - 4.0 * scene.slack() - 1e-6 * scene.size) << i;
    const double way =
        (contact->world_point - scene.world_from_sphere * scene.sphere.center).norm();
    ASSERT_LE(way, (scene.sphere.radius + scene.mesh.vertex_error) * (1.0 + 1e-6) +
                       10.0 * scene.slack() +
                       1e-14 * scene.world_from_sphere.translation().lpNorm<1>());
    ++(scene.is_inside() ? inside : outside);
  }
  EXPECT_GT(inside, effort(20, 2));
  EXPECT_GT(outside, effort(40, 4));
}

// --- shells of all kinds ---

// By the solid angles of the triangles (Van Oosterom and Strackee, "The Solid Angle of a Plane
// Triangle", 1983); for points off the surface.
double winding_number(const TriangleMesh& mesh, const Vector3d& p) {
  double sum = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto at = [&](int k) -> Vector3d {
      return mesh.vertices[static_cast<std::size_t>(t[k])] - p;
    };
    const Vector3d a = at(0), b = at(1), c = at(2);
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2.0 * std::numbers::pi);
}

double distance_to_surface(const TriangleMesh& mesh, const Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3i& t : mesh.triangles) {
    ExactTriangle<double> triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle[k] = exact<double>(mesh.vertices[static_cast<std::size_t>(t[static_cast<int>(k)])]);
    }
    least = std::min(least, squared_distance_to_triangle(exact<double>(p), triangle));
  }
  return std::sqrt(least);
}

// A mesh of parts that are closed each; what one of them encloses is inside.
struct Shell {
  std::string name;
  std::vector<TriangleMesh> parts;

  TriangleMesh mesh() const {
    TriangleMesh all;
    for (const TriangleMesh& part : parts) all = joined(all, part);
    return all;
  }
  bool encloses(const Vector3d& p) const {
    return std::any_of(parts.begin(), parts.end(), [&](const TriangleMesh& part) {
      return std::abs(winding_number(part, p)) > 0.5;
    });
  }
};

std::vector<Shell> closed_shells() {
  const TriangleMesh cube = cube_mesh(), shifted = box_mesh({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5});
  const TriangleMesh ring = torus(1.0, 0.3, 24, 12);
  const TriangleMesh core = box_mesh({0.3, 0.3, 0.3}, {0.6, 0.6, 0.6});
  return effort(std::vector<Shell>{{"nested", {cube, inverted(core)}},
                                   {"double-sided", {cube, inverted(cube)}},
                                   {"one inverted", {cube, inverted(shifted)}},
                                   {"torus", {ring}},
                                   {"overlapping", {cube, shifted}},
                                   {"inverted", {inverted(icosphere(2))}},
                                   {"bracket", {l_bracket()}},
                                   {"apart", {cube, box_mesh({2.0, 0.0, 0.0}, {2.5, 0.5, 0.5})}},
                                   {"twice", {cube, cube}},
                                   {"double-sided ring", {inverted(ring), ring}},
                                   {"double-sided, overlapping",
                                    {shifted, cube, inverted(cube), inverted(shifted)}}},
                4);
}

// Sets of small spheres all over the place, of which none, one or many are inside.
TEST(SolidMeshTest, AgreesWithWindingNumbers) {
  SceneRandom random(5);
  for (const Shell& shell : closed_shells()) {
    SCOPED_TRACE(shell.name);
    const TriangleMesh mesh = shell.mesh();
    const SolidMesh solid(mesh);
    ASSERT_TRUE(solid.has_inside());
    ASSERT_TRUE(solid.is_closed());
    Eigen::AlignedBox3d box;
    for (const Vector3d& vertex : mesh.vertices) box.extend(vertex);
    const double size = box.diagonal().norm();
    int counts[2] = {}, only_inside = 0;
    for (int i = 0; i < effort(150, 20); ++i) {
      const Pose world_from_mesh = random.pose(3.0);
      const Pose world_from_tree = random.pose(3.0);
      const Pose tree_from_mesh = world_from_tree.inverse() * world_from_mesh;
      std::vector<Sphere> spheres;
      bool touches = false, is_inside = false;
      double least = std::numeric_limits<double>::infinity();
      // Mostly outside, so that many sets are free in spite of their number.
      const bool may_enter = random.whole(0, 2) == 0;
      for (int k = random.whole(1, 40); k > 0; --k) {
        const Vector3d p = box.center() + random.point(0.7 * size);
        const double distance = distance_to_surface(mesh, p);
        const bool inside = shell.encloses(p);
        if (inside && !may_enter) continue;
        const double radius = distance * random.uniform(0.0, random.whole(0, 30) == 0 ? 1.5 : 0.98);
        touches = touches || radius > distance;
        is_inside = is_inside || inside;
        least = std::min(least, inside ? 0.0 : std::max(0.0, distance - radius));
        spheres.push_back({tree_from_mesh * p, radius});
      }
      if (spheres.empty()) continue;
      const SphereTree tree = build_tree(spheres);
      const bool hit = collides(tree, world_from_tree, solid, world_from_mesh);
      ASSERT_EQ(hit, touches || is_inside) << i;
      const DistanceResult result = distance(tree, world_from_tree, solid, world_from_mesh);
      ASSERT_LE(result.lower, least + 1e-12) << i;
      ASSERT_GE(result.upper, least - 1e-12) << i;
      ASSERT_LE(result.upper - result.lower, 1e-6) << i;
      ASSERT_EQ(deepest_contact(tree, world_from_tree, solid, world_from_mesh).has_value(), hit);
      ++counts[hit];
      only_inside += is_inside && !touches;
    }
    EXPECT_GT(counts[0], effort(20, 2));
    EXPECT_GT(counts[1], effort(20, 2));
    EXPECT_GT(only_inside, effort(3, 0));
  }
}

// The way out of the hollow of a shell is through its wall.
TEST(SolidMeshTest, ASealedHollowIsInside) {
  const SolidMesh solid(nested_shells(2));  // a wall of 0.2 around a hollow
  EXPECT_TRUE(collides(tree_of({{0.5, 0.5, 0.5}, 0.05}), Pose(), solid, Pose()));
  EXPECT_TRUE(collides(tree_of({{0.1, 0.1, 0.1}, 0.01}), Pose(), solid, Pose()));
  EXPECT_FALSE(collides(tree_of({{0.5, 0.5, -0.2}, 0.05}), Pose(), solid, Pose()));
}

// Spheres in a row that overlap each other, as a cover's do, are free where nothing encloses them.
TEST(SolidMeshTest, ABoreIsFree) {
  const SolidMesh solid(pipe(0.5, 0.4, 1.0, 24));
  std::vector<Sphere> spheres;
  for (int i = 0; i <= 40; ++i) spheres.push_back({{0.0, 0.0, 0.3 + 0.01 * i}, 0.05});
  EXPECT_FALSE(collides(build_tree(spheres), Pose(), solid, Pose()));
  for (int i = 0; i <= 40; ++i) spheres.push_back({{0.7, 0.0, 0.3 + 0.01 * i}, 0.05});
  EXPECT_FALSE(collides(build_tree(spheres), Pose(), solid, Pose()));
  spheres.push_back({{0.45, 0.0, 0.5}, 0.01});  // in the wall
  EXPECT_TRUE(collides(build_tree(spheres), Pose(), solid, Pose()));
}

TEST(SolidMeshTest, OpenAndUnorientableShellsHaveNoInside) {
  const SolidMesh open(open_box());
  EXPECT_FALSE(open.is_closed());
  EXPECT_FALSE(open.has_inside());
  EXPECT_FALSE(collides(tree_of({{0.5, 0.5, 0.5}, 0.1}), Pose(), open, Pose()));
  EXPECT_TRUE(collides(tree_of({{0.5, 0.5, 0.1}, 0.2}), Pose(), open, Pose()));
  EXPECT_FALSE(SolidMesh(klein_bottle(16, 24)).has_inside());

  const SolidMesh half(joined(open_box(), box_mesh({2.0, 0.0, 0.0}, {3.0, 1.0, 1.0})));
  EXPECT_FALSE(half.is_closed());
  EXPECT_TRUE(half.has_inside());
  EXPECT_FALSE(collides(tree_of({{0.5, 0.5, 0.5}, 0.1}), Pose(), half, Pose()));
  EXPECT_TRUE(collides(tree_of({{2.5, 0.5, 0.5}, 0.1}), Pose(), half, Pose()));
}

TEST(SolidMeshTest, GrowsByTheVertexError) {
  TriangleMesh mesh = cube_mesh();
  mesh.vertex_error = 0.1;
  const SolidMesh solid(mesh);
  EXPECT_EQ(solid.inflation(), 0.1);
  const SphereTree sphere = tree_of({{1.5, 0.5, 0.5}, 0.25});
  const auto at = [](double x) { return Pose::from_translation({x, 0.0, 0.0}); };
  EXPECT_TRUE(collides(sphere, at(-0.16), solid, Pose()));
  EXPECT_FALSE(collides(sphere, at(-0.14), solid, Pose()));
  EXPECT_TRUE(within(sphere, at(-0.14), solid, Pose(), 0.02));
  const DistanceResult result = distance(sphere, at(0.0), solid, Pose());
  EXPECT_NEAR(result.lower, 0.15, 1e-12);
  EXPECT_NEAR(result.upper, 0.15, 1e-12);
  EXPECT_EQ(distance(sphere, at(-0.2), solid, Pose()).upper, 0.0);
}

}  // namespace
}  // namespace spherule::test::solid_mesh_test
