// SPDX-License-Identifier: BSD-3-Clause
#include "collide/meshes/mesh_contact.h"

#include "base/error.h"
#include "collide/contact.h"
#include "geometry/sphere.h"
#include "spheretree/sphere_tree.h"
#include "tests/support/effort.h"
#include "tests/support/exact/shapes.h"
#include "tests/support/random_scene.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace spherule::test {
namespace {

// Contact of covered meshes, against rational numbers and against what is built in.

using Corners = std::array<Eigen::Vector3d, 3>;
using Eigen::Vector3d;

TriangleMesh centered_box(const Vector3d& half, const Vector3d& center = Vector3d::Zero()) {
  return test::box_mesh(center - half, center + half);
}

std::shared_ptr<const SphereTree> shared_tree(const std::vector<Sphere>& spheres) {
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
  return {mesh, shared_tree(surface_spheres(mesh, levels))};
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
  return {mesh, shared_tree(spheres)};
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

// Meshes brought near contact at random points of two triangles, anywhere in the world. What is
// extra is apart by no more than the slack of the spheres and a rest.
void compare_near_contact(double world, double width, double rest, int least_extra,
                          std::uint64_t seed) {
  Random random(seed);
  int touching = 0, free = 0, extra = 0;
  // Those without width seldom touch.
  for (int i = 0; i < effort(500, width > 0.0 ? 100 : 500); ++i) {
    const TriangleMesh a = random_triangles(random, random.whole(1, 2), 1.0, width);
    const TriangleMesh b = random_triangles(random, random.whole(1, 2), 1.0, width);
    const CoveredMesh covered_a = surface_covered(a, random.whole(0, 2));
    const CoveredMesh covered_b = surface_covered(b, random.whole(0, 2));
    const Pose world_from_a = random.pose(world);
    const Pose turned(random.quaternion(), Vector3d::Zero());
    // A corner, or a point of an edge or of the face.
    const auto point = [&](const TriangleMesh& mesh, int kind) -> Vector3d {
      const auto [p, q, r] = corners_of(mesh, 0);
      const double v = kind > 0 ? random.between(0.0, 1.0) : 0.0;
      const double w = kind > 1 ? random.between(0.0, 1.0 - v) : 0.0;
      return p + v * (q - p) + w * (r - p);
    };
    const int kind = random.whole(0, 3);
    const Vector3d from = point(a, kind == 3 ? 1 : kind), to = point(b, kind == 3 ? 1 : 0);
    constexpr double kOffsets[] = {0.0, 0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3};
    const Vector3d offset = kOffsets[random.whole(0, 6)] * random.point(1.0);
    const Pose world_from_b(turned.rotation(), world_from_a * from - turned * to + offset);
    const bool hit = collides(covered_a, world_from_a, covered_b, world_from_b);
    ASSERT_EQ(hit, collides(covered_b, world_from_b, covered_a, world_from_a));
    const double gap = exact_gap(a, world_from_a, b, world_from_b);
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
  Random random(8);
  int hits = 0, alarms = 0;
  for (int i = 0; i < effort(60, 20); ++i) {
    TriangleMesh meshes[2];
    std::vector<Sphere> spheres[2];
    for (int k = 0; k < 2; ++k) {
      meshes[k] = random_triangles(random, 90, 0.15, 0.15);
      for (std::size_t first = 0; first < meshes[k].vertices.size(); first += 3) {
        const Vector3d shift = random.point(1.0);
        for (std::size_t v = first; v < first + 3; ++v) meshes[k].vertices[v] += shift;
      }
      spheres[k] = {{Vector3d(-0.4, 0, 0), 1.9}, {Vector3d(0.4, 0, 0), 1.9}};
    }
    const CoveredMesh a(meshes[0], shared_tree(spheres[0])), b(meshes[1], shared_tree(spheres[1]));
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

// What is inside, around a small box that is moved along x.
TEST(MeshContact, TheInsideIsThatOfClosedShells) {
  const Vector3d large = Vector3d::Constant(1.0);
  const TriangleMesh box = centered_box(large);
  const TriangleMesh hollow = joined(box, inverted(centered_box(Vector3d::Constant(0.6))));
  const TriangleMesh inside_out = inverted(box), double_sided = joined(box, inverted(box));
  const TriangleMesh flapped = joined(box, {{{0, 0, .5}, {.1, 0, .5}, {0, .1, .5}}, {{0, 1, 2}}});
  TriangleMesh open = box;
  open.triangles.pop_back();
  const Vector3d tenth = Vector3d::Constant(0.1);
  const TriangleMesh two = joined(centered_box(tenth), centered_box(tenth, {5, 0, 0}));
  struct Case {
    const char* name;
    const TriangleMesh& outer;
    bool is_closed, has_inside;
  };
  const Case cases[] = {{"box", box, true, true},
                        {"hollow", hollow, true, true},
                        {"inside out", inside_out, true, true},
                        {"double-sided", double_sided, true, true},
                        {"open", open, false, false},
                        {"with a flap", flapped, false, true}};
  for (const auto& [name, outer_mesh, is_closed, has_inside] : cases) {
    SCOPED_TRACE(name);
    const CoveredMesh outer = solid_covered(outer_mesh, large, 3);
    EXPECT_EQ(outer.is_closed(), is_closed);
    // The rays of the smallest ones, from the centre, run through edges and corners.
    for (const double size : {0.1, 1e-3, 1e-9, 1e-15}) {
      const CoveredMesh inner = surface_covered(centered_box(Vector3d::Constant(size)), 0);
      EXPECT_EQ(collides(outer, Pose(), inner, Pose()), has_inside) << size;
      EXPECT_TRUE(collides(outer, Pose(), inner, Pose::from_translation({-1, 0, 0})));
      EXPECT_FALSE(collides(outer, Pose(), inner, Pose::from_translation({1.3, 0, 0})));
    }
    // Each component is looked for.
    const CoveredMesh pair = surface_covered(two, 0);
    EXPECT_EQ(collides(outer, Pose(), pair, Pose::from_translation({-5, 0, 0})), has_inside);
    EXPECT_FALSE(collides(outer, Pose(), pair, Pose::from_translation({-2.5, 0, 0})));
  }
}

TEST(MeshContact, EveryPointIsInASphereThatListsItsTriangle) {
  Random random(7);
  const TriangleMesh mesh = random_triangles(random, 40, 1.0, 0.5);
  std::vector<Sphere> spheres = surface_spheres(mesh, 1);
  const std::vector<Sphere> finer = surface_spheres(mesh, 3);
  spheres.insert(spheres.end(), finer.begin(), finer.end() - 500);
  const CoveredMesh covered(mesh, shared_tree(spheres));
  for (std::int32_t triangle = 0; triangle < 40; ++triangle) {
    const auto [a, b, c] = corners_of(mesh, static_cast<std::size_t>(triangle));
    for (int k = 0; k < 200; ++k) {
      const double v = random.whole(0, 4) / 4.0 * random.between(0.0, 1.0);
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

Real exact_overlap(const SphereTree& a, const Pose& world_from_a, const SphereTree& b,
                   const Pose& world_from_b, const SpherePair& pair) {
  return -PlacedSphereSets{a.spheres()[static_cast<std::size_t>(pair.a)],
                           b.spheres()[static_cast<std::size_t>(pair.b)], world_from_a,
                           world_from_b}
              .gap();
}

// For meshes apart, touching, near contact and inside each other.
TEST(Contact, OfMeshesIsTheDeepestThatTrianglesConfirm) {
  Random random(2);
  int triangles = 0;
  int inside = 0;
  int removed = 0;
  int not_deepest = 0;
  for (int i = 0; i < effort(300, 60); ++i) {
    const auto mesh_a = covered_tetrahedron(random, random.between(0.1, 2.0));
    const bool small = i % 4 == 0;  // so that it is inside the other now and then
    const auto mesh_b = covered_tetrahedron(random, random.between(0.1, 2.0) * (small ? 0.1 : 1.0));
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
    ASSERT_LE(contact->penetration_depth,
              exact_overlap(a, world_from_a, b, world_from_b, contact->leaves));
    const double slack = collision_slack(a, world_from_a, b, world_from_b);
    int confirmed = 0;
    int deeper = 0;
    for (const SpherePair& pair : pairs) {
      const bool is_confirmed =
          triangles_touch(*mesh_a, pair.a, world_from_a, *mesh_b, pair.b, world_from_b);
      confirmed += is_confirmed;
      const bool is_deeper = exact_overlap(a, world_from_a, b, world_from_b, pair) >
                             contact->penetration_depth + 2.0 * slack;
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

std::string refusal(const TriangleMesh& mesh, std::vector<Sphere> spheres) {
  try {
    const CoveredMesh covered(mesh, shared_tree(spheres));
  } catch (const Error& error) {
    return error.reason();
  }
  return {};
}

TEST(MeshContact, RefusesWhatDoesNotCover) {
  const TriangleMesh box = centered_box(Vector3d::Constant(1.0));
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
  EXPECT_THROW(CoveredMesh(TriangleMesh{}, shared_tree(spheres)), Error);
}

// A triangle that touches another with a corner, so tiny that its normal underflows: a plane whose
// normal is not known keeps nothing apart.
TEST(ListedTriangles, ATriangleWithoutANormalIsNotMissed) {
  const auto covered = [](const Corners& corners, double radius) {
    TriangleMesh mesh;
    mesh.vertices.assign(corners.begin(), corners.end());
    mesh.triangles.emplace_back(0, 1, 2);
    const Sphere around{Vector3d::Zero(), radius};
    return CoveredMesh(mesh, std::make_shared<const SphereTree>(build_tree(std::span(&around, 1))));
  };
  const CoveredMesh tiny =
      covered({Vector3d::Zero(),
               {0x1.3ecbe6e51fc91p-538, 0x1.c15a47cf5c6b2p-537, -0x1.1b6007535326ap-537},
               {0x1.5d7930423d229p-537, -0x1.380a5555657e3p-539, -0x1.1ee029e7e25e5p-538}},
              1e-3);
  const CoveredMesh other = covered({Vector3d(-0x1.b8156a4p-3, 0x1.3fd9d288p-1, -0x1.a3a8fp-3),
                                     {0x1.3e8ee648p-1, -0x1.8cbe252p-2, -0x1.e0bf4ecp-4},
                                     {-0x1.a113177p-2, -0x1.e5eaffep-3, 0x1.4a044bbp-2}},
                                    2.0);
  EXPECT_TRUE(collides(tiny, Pose(), other, Pose()));
  EXPECT_TRUE(collides(other, Pose(), tiny, Pose()));
}

}  // namespace
}  // namespace spherule::test
