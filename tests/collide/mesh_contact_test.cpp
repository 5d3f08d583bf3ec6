// SPDX-License-Identifier: BSD-3-Clause
// Contact of covered meshes, against rational numbers and against what is built in.

#include "collide/meshes/mesh_contact.h"

#include "base/error.h"
#include "geometry/enclosing_sphere.h"
#include "spheretree/build.h"
#include "tests/collide/exact_triangles.h"
#include "tests/collide/trees.h"
#include "tests/support/effort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace spherule::test {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;
using Eigen::Vector3d;

Corners corners_of(const TriangleMesh& mesh, std::size_t triangle) {
  const Eigen::Vector3i& t = mesh.triangles[triangle];
  const auto corner = [&](int k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
  return {corner(0), corner(1), corner(2)};
}

// A box from -half to half, facing outwards or inwards, its triangles added to `mesh` with corners
// of their own, as STL files have them.
void add_box(TriangleMesh& mesh, const Vector3d& half, bool inwards = false,
             const Vector3d& center = Vector3d::Zero()) {
  constexpr int kFaces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  for (const auto& face : kFaces) {
    const int first = static_cast<int>(mesh.vertices.size());
    for (const int i : face) {
      const Vector3d sign((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
      mesh.vertices.push_back(center + sign.cwiseProduct(half));
    }
    mesh.triangles.emplace_back(first, first + (inwards ? 2 : 1), first + (inwards ? 1 : 2));
  }
}

TriangleMesh box_mesh(const Vector3d& half) {
  TriangleMesh mesh;
  add_box(mesh, half);
  return mesh;
}

std::shared_ptr<const SphereTree> tree_of(const std::vector<Sphere>& spheres) {
  return std::make_shared<const SphereTree>(build_tree(spheres));
}

// The smallest spheres around the triangles, each cut into 4^levels, and a bit more where cut.
std::vector<Sphere> surface_spheres(const TriangleMesh& mesh, int levels) {
  std::vector<Corners> pieces;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) pieces.push_back(corners_of(mesh, i));
  for (int level = 0; level < levels; ++level) {
    std::vector<Corners> finer;
    for (const auto& [a, b, c] : pieces) {
      const Vector3d ab = (a + b) / 2.0, bc = (b + c) / 2.0, ca = (c + a) / 2.0;
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    pieces = std::move(finer);
  }
  std::vector<Sphere> spheres;
  for (const Corners& piece : pieces) {
    spheres.push_back(enclosing_sphere(piece));
    if (levels > 0) spheres.back().radius *= 1.01;
  }
  return spheres;
}

CoveredMesh surface_covered(const TriangleMesh& mesh, int levels) {
  return {mesh, tree_of(surface_spheres(mesh, levels))};
}

// Spheres around the cells of a grid, which cover a box from -half to half with its inside.
CoveredMesh solid_covered(const TriangleMesh& mesh, const Vector3d& half, int cells) {
  std::vector<Sphere> spheres;
  const Vector3d cell = 2.0 * half / cells;
  for (int i = 0; i < cells * cells * cells; ++i) {
    const Vector3d index(i % cells, i / cells % cells, i / (cells * cells));
    spheres.push_back(
        {(index.array() + 0.5).matrix().cwiseProduct(cell) - half, 0.51 * cell.norm()});
  }
  return {mesh, tree_of(spheres)};
}

TriangleMesh random_mesh(SceneRandom& random, int triangles, double width) {
  TriangleMesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const Vector3d a = random.point(1.0), edge = random.point(1.0);
    mesh.vertices.insert(
        mesh.vertices.end(),
        {a, a + edge, a + random.uniform(0.0, 1.0) * edge + width * random.point(1.0)});
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return mesh;
}

// Whether any two triangles touch, exactly; only those are examined that are not clearly apart.
bool touch_exactly(const TriangleMesh& a, const Pose& world_from_a, const TriangleMesh& b,
                   const Pose& world_from_b) {
  const auto sphere = [](const TriangleMesh& mesh, std::size_t i, const Pose& pose) -> Sphere {
    const Sphere around = enclosing_sphere(corners_of(mesh, i));
    return {pose * around.center, around.radius};
  };
  for (std::size_t i = 0; i < a.triangles.size(); ++i) {
    const Sphere of_a = sphere(a, i, world_from_a);
    for (std::size_t j = 0; j < b.triangles.size(); ++j) {
      const Sphere of_b = sphere(b, j, world_from_b);
      if ((of_a.center - of_b.center).norm() > of_a.radius + of_b.radius + 1e-9) continue;
      if (exact_gap(corners_of(a, i), world_from_a, corners_of(b, j), world_from_b) == 0.0) {
        return true;
      }
    }
  }
  return false;
}

double mesh_gap(const TriangleMesh& a, const Pose& world_from_a, const TriangleMesh& b,
                const Pose& world_from_b) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.triangles.size(); ++i) {
    for (std::size_t j = 0; j < b.triangles.size(); ++j) {
      least = std::min(least,
                       exact_gap(corners_of(a, i), world_from_a, corners_of(b, j), world_from_b));
    }
  }
  return least;
}

// Meshes brought near contact at random points of two triangles, anywhere in the world. What is
// extra is apart by no more than the slack of the spheres and a rest.
void compare_near_contact(double world, double width, double rest, int least_extra,
                          std::uint64_t seed) {
  SceneRandom random(seed);
  int touching = 0, free = 0, extra = 0;
  // Those without width seldom touch.
  for (int i = 0; i < effort(500, width > 0.0 ? 100 : 500); ++i) {
    const TriangleMesh a = random_mesh(random, random.whole(1, 2), width);
    const TriangleMesh b = random_mesh(random, random.whole(1, 2), width);
    const CoveredMesh covered_a = surface_covered(a, random.whole(0, 2));
    const CoveredMesh covered_b = surface_covered(b, random.whole(0, 2));
    const Pose world_from_a = random.pose(world);
    const Pose turned(random.quaternion(), Vector3d::Zero());
    // A corner, or a point of an edge or of the face.
    const auto point = [&](const TriangleMesh& mesh, int kind) -> Vector3d {
      const auto [p, q, r] = corners_of(mesh, 0);
      const double v = kind > 0 ? random.uniform(0.0, 1.0) : 0.0;
      const double w = kind > 1 ? random.uniform(0.0, 1.0 - v) : 0.0;
      return p + v * (q - p) + w * (r - p);
    };
    const int kind = random.whole(0, 3);
    const Vector3d from = point(a, kind == 3 ? 1 : kind), to = point(b, kind == 3 ? 1 : 0);
    constexpr double kOffsets[] = {0.0, 0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3};
    const Vector3d offset = kOffsets[random.whole(0, 6)] * random.point(1.0);
    const Pose world_from_b(turned.rotation(), world_from_a * from - turned * to + offset);
    const bool hit = collides(covered_a, world_from_a, covered_b, world_from_b);
    ASSERT_EQ(hit, collides(covered_b, world_from_b, covered_a, world_from_a));
    const double gap = mesh_gap(a, world_from_a, b, world_from_b);
    ASSERT_TRUE(hit || gap > 0.0) << "missed in case " << i;
    const double slack =
        rest + collision_slack(covered_a.cover(), world_from_a, covered_b.cover(), world_from_b);
    ASSERT_TRUE(!hit || gap <= slack) << "apart by " << gap << " in case " << i;
    touching += gap == 0.0;
    free += !hit;
    extra += hit && gap > 0.0;
  }
  EXPECT_GT(touching, width > 0.0 ? effort(100, 20) : 0);
  EXPECT_GT(free, effort(50, 10));
  EXPECT_GE(extra, least_extra);
}

TEST(MeshContact, IsNeverMissed) {
  compare_near_contact(1.0, 1.0, 0.0, 20, 1);
}
TEST(MeshContact, IsNeverMissedFarFromTheOrigin) {
  // The poses' translations are whole multiples of 1e-10 there, which the exact gap knows.
  compare_near_contact(1e6, 1.0, 0.0, 0, 2);
}
TEST(MeshContact, IsNeverMissedOfNeedles) {
  compare_near_contact(1.0, 1e-7, 1e-9, 20, 3);
}
TEST(MeshContact, IsNeverMissedOfDegenerateTriangles) {
  compare_near_contact(1.0, 0.0, 1e-9, 20, 4);
}

// Many triangles under few spheres, so that trees of boxes have several levels.
TEST(MeshContact, IsNeverMissedAmongManyTriangles) {
  SceneRandom random(8);
  int hits = 0, alarms = 0;
  for (int i = 0; i < effort(60, 20); ++i) {
    TriangleMesh meshes[2];
    std::vector<Sphere> spheres[2];
    for (int k = 0; k < 2; ++k) {
      for (int t = 0; t < 90; ++t) {
        const Vector3d p = random.point(1.0);
        const int first = static_cast<int>(meshes[k].vertices.size());
        for (const double size : {0.0, 0.15, 0.15}) {
          meshes[k].vertices.push_back(p + size * random.point(1.0));
        }
        meshes[k].triangles.emplace_back(first, first + 1, first + 2);
      }
      spheres[k] = {{Vector3d(-0.4, 0, 0), 1.9}, {Vector3d(0.4, 0, 0), 1.9}};
    }
    const CoveredMesh a(meshes[0], tree_of(spheres[0])), b(meshes[1], tree_of(spheres[1]));
    const Pose world_from_a = random.pose(1.0), turned(random.quaternion(), Vector3d::Zero());
    const Pose world_from_b(turned.rotation(),
                            world_from_a.translation() + 1.9 * random.point(1.0));
    const bool hit = collides(a, world_from_a, b, world_from_b);
    ASSERT_EQ(hit, touch_exactly(meshes[0], world_from_a, meshes[1], world_from_b)) << i;
    ASSERT_EQ(hit, collides(b, world_from_b, a, world_from_a)) << i;
    hits += hit;
    alarms += !hit && collides(a.cover(), world_from_a, b.cover(), world_from_b);
  }
  EXPECT_GT(hits, effort(10, 3));
  EXPECT_GT(alarms, effort(10, 3));
}

// The answer from its parts, by trying all pairs of spheres.
bool collides_by_parts(const CoveredMesh& a, const Pose& world_from_a, const CoveredMesh& b,
                       const Pose& world_from_b) {
  bool touch = false;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(a.cover().spheres().size()); ++i) {
    for (std::int32_t j = 0; j < static_cast<std::int32_t>(b.cover().spheres().size()); ++j) {
      if (!spheres_touch(a.cover(), i, world_from_a, b.cover(), j, world_from_b)) continue;
      touch = true;
      if (triangles_touch(a, i, world_from_a, b, j, world_from_b)) return true;
    }
  }
  return touch && contains_component(a, world_from_a, b, world_from_b);
}

TEST(MeshContact, IsTheSumOfItsParts) {
  SceneRandom random(5);
  const Vector3d half(0.5, 0.4, 0.3);
  const CoveredMesh box = solid_covered(box_mesh(half), half, 4);
  int hits = 0, alarms = 0;
  for (int i = 0; i < 400; ++i) {
    const CoveredMesh other = surface_covered(random_mesh(random, 6, 0.2), 1);
    const Pose world_from_box = random.pose(1.0);
    const Pose world_from_other = random.pose(1.0);
    const bool hit = collides(box, world_from_box, other, world_from_other);
    ASSERT_EQ(hit, collides_by_parts(box, world_from_box, other, world_from_other));
    hits += hit;
    alarms += !hit && collides(box.cover(), world_from_box, other.cover(), world_from_other);
  }
  EXPECT_GT(hits, 50);
  EXPECT_GT(alarms, 10);
}

TEST(MeshContact, ABodyInsideAnotherCollides) {
  SceneRandom random(6);
  const Vector3d large = Vector3d::Constant(1.0), small = Vector3d::Constant(0.2);
  const CoveredMesh outer = solid_covered(box_mesh(large), large, 3);
  const CoveredMesh inner = surface_covered(box_mesh(small), 0);
  EXPECT_TRUE(outer.is_closed());
  for (int i = 0; i < 2000; ++i) {
    const Pose world_from_outer = random.pose(10.0);
    // A sphere around the small box stays within the large one, or goes beyond it for sure.
    Vector3d center = random.point(0.6);
    const bool inside = random.whole(0, 1) == 0;
    if (!inside) center[random.whole(0, 2)] = random.whole(0, 1) == 0 ? 1.4 : -1.4;
    const Pose world_from_inner(random.quaternion(), world_from_outer * center);
    ASSERT_EQ(collides(outer, world_from_outer, inner, world_from_inner), inside) << i;
    ASSERT_EQ(collides(inner, world_from_inner, outer, world_from_outer), inside) << i;
  }
}

// Rays that run through edges and corners.
TEST(MeshContact, ABodyInsideIsFoundFromTheCentre) {
  const Vector3d large = Vector3d::Constant(1.0);
  const CoveredMesh outer = solid_covered(box_mesh(large), large, 3);
  for (const double size : {1e-3, 1e-9, 1e-15}) {
    const CoveredMesh inner = surface_covered(box_mesh(Vector3d::Constant(size)), 0);
    EXPECT_TRUE(collides(outer, Pose(), inner, Pose()));
    EXPECT_FALSE(collides(outer, Pose(), inner, Pose::from_translation({1.0 + 2 * size, 0, 0})) &&
                 size > 1e-9);
  }
}

TEST(MeshContact, EachComponentIsLookedFor) {
  TriangleMesh two = box_mesh(Vector3d::Constant(0.1));
  add_box(two, Vector3d::Constant(0.1), false, {5, 0, 0});
  const Vector3d large = Vector3d::Constant(1.0);
  const CoveredMesh outer = solid_covered(box_mesh(large), large, 3);
  const CoveredMesh inner = surface_covered(two, 0);
  EXPECT_TRUE(collides(outer, Pose(), inner, Pose()));
  EXPECT_TRUE(collides(outer, Pose(), inner, Pose::from_translation({-5, 0, 0})));
  EXPECT_FALSE(collides(outer, Pose(), inner, Pose::from_translation({-2.5, 0, 0})));
}

TEST(MeshContact, ASealedHollowIsInside) {
  const Vector3d large = Vector3d::Constant(1.0);
  TriangleMesh shell = box_mesh(large);
  add_box(shell, Vector3d::Constant(0.6), true);
  const CoveredMesh outer = solid_covered(shell, large, 3);
  EXPECT_TRUE(outer.is_closed());
  const CoveredMesh inner = surface_covered(box_mesh(Vector3d::Constant(0.1)), 0);
  EXPECT_TRUE(collides(outer, Pose(), inner, Pose()));
  EXPECT_TRUE(collides(outer, Pose(), inner, Pose::from_translation({0.8, 0, 0})));
  EXPECT_TRUE(collides(outer, Pose(), inner, Pose::from_translation({0.6, 0, 0})));
  // An inverted shell, and a double-sided one.
  for (const bool twice : {false, true}) {
    TriangleMesh inverted;
    add_box(inverted, large, true);
    if (twice) add_box(inverted, large);
    EXPECT_TRUE(collides(solid_covered(inverted, large, 3), Pose(), inner, Pose()));
  }
}

TEST(MeshContact, AnOpenMeshHasNoInside) {
  const Vector3d large = Vector3d::Constant(1.0);
  TriangleMesh open = box_mesh(large);
  open.triangles.pop_back();
  const CoveredMesh outer = solid_covered(open, large, 3);
  EXPECT_FALSE(outer.is_closed());
  const CoveredMesh inner = surface_covered(box_mesh(Vector3d::Constant(0.1)), 0);
  EXPECT_FALSE(collides(outer, Pose(), inner, Pose()));
  EXPECT_TRUE(collides(outer, Pose(), inner, Pose::from_translation({-1, 0, 0})));
  // It does not take the inside from a closed component beside it.
  TriangleMesh with_flap = box_mesh(large);
  with_flap.vertices.insert(with_flap.vertices.end(), {{0, 0, .5}, {.1, 0, .5}, {0, .1, .5}});
  with_flap.triangles.emplace_back(36, 37, 38);
  const CoveredMesh flapped = solid_covered(with_flap, large, 3);
  EXPECT_FALSE(flapped.is_closed());
  EXPECT_TRUE(collides(flapped, Pose(), inner, Pose()));
}

TEST(MeshContact, EveryPointIsInASphereThatListsItsTriangle) {
  SceneRandom random(7);
  const TriangleMesh mesh = random_mesh(random, 40, 0.5);
  std::vector<Sphere> spheres = surface_spheres(mesh, 1);
  const std::vector<Sphere> finer = surface_spheres(mesh, 3);
  spheres.insert(spheres.end(), finer.begin(), finer.end() - 500);
  const CoveredMesh covered(mesh, tree_of(spheres));
  for (std::int32_t triangle = 0; triangle < 40; ++triangle) {
    const auto [a, b, c] = corners_of(mesh, static_cast<std::size_t>(triangle));
    for (int k = 0; k < 200; ++k) {
      const double v = random.whole(0, 4) / 4.0 * random.uniform(0.0, 1.0);
      const double w = (1.0 - v) * random.whole(0, 4) / 4.0;
      const Vector<Real> p = exact<Real>(a + v * (b - a) + w * (c - a));
      bool found = false;
      for (std::size_t i = 0; i < spheres.size() && !found; ++i) {
        const auto listed = covered.triangles_under(static_cast<std::int32_t>(i));
        ASSERT_TRUE(std::is_sorted(listed.begin(), listed.end()));
        const Real limit = spheres[i].radius * (1.0 + 1e-14);  // p is rounded
        found = std::binary_search(listed.begin(), listed.end(), triangle) &&
                squared_distance(p, exact<Real>(spheres[i].center)) <= limit * limit;
      }
      ASSERT_TRUE(found);
    }
  }
}

std::string refusal(const TriangleMesh& mesh, std::vector<Sphere> spheres) {
  try {
    const CoveredMesh covered(mesh, tree_of(spheres));
  } catch (const Error& error) {
    return error.reason();
  }
  return {};
}

TEST(MeshContact, RefusesWhatDoesNotCover) {
  const TriangleMesh box = box_mesh(Vector3d::Constant(1.0));
  std::vector<Sphere> spheres = surface_spheres(box, 2);
  EXPECT_EQ(refusal(box, spheres), "");
  // A hole in the middle of a triangle (two spheres have the same hypotenuse as diameter), and
  // spheres around the corners only.
  std::vector<Sphere> holed = spheres;
  for (Sphere& sphere : holed) {
    if ((sphere.center - spheres[15].center).norm() < 1e-9) sphere.radius *= 0.5;
  }
  EXPECT_NE(refusal(box, holed).find("triangle 0"), std::string::npos) << refusal(box, holed);
  std::vector<Sphere> corners;
  for (const Vector3d& vertex : box.vertices) corners.push_back({vertex, 0.9});
  EXPECT_NE(refusal(box, corners), "");
  spheres.erase(spheres.end() - 16, spheres.end());
  EXPECT_NE(refusal(box, spheres).find("triangle 11"), std::string::npos) << refusal(box, spheres);
  // Spheres that meet in points only are more than can be proved.
  EXPECT_NE(refusal(TriangleMesh{{{-1, 0, 0}, {1, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}},
                    {{{-2.0 / 3.0, 0, 0}, 1.0 / 3.0}, {{1.0 / 3.0, 0, 0}, 2.0 / 3.0}}),
            "");
  EXPECT_THROW(CoveredMesh(box, nullptr), Error);
  EXPECT_THROW(CoveredMesh(TriangleMesh{}, tree_of(spheres)), Error);
}

}  // namespace
}  // namespace spherule::test
