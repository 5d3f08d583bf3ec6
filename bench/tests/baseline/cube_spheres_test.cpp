// SPDX-License-Identifier: BSD-3-Clause
// Spheres of voxels and of octrees, and the test of a triangle against a cube beneath both.
#include "base/error.h"
#include "bench/baseline/cell_octree.h"
#include "bench/baseline/sphere_methods.h"
#include "bench/tests/baseline/cover_check.h"
#include "geometry/mesh_distance.h"
#include "simplifier/simplify.h"
#include "spheretree/sphere_tree.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <Eigen/Core>
#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using internal::Triangle;
using Index = std::array<int, 3>;
using Rational = boost::multiprecision::cpp_rational;
using ExactPoint = std::array<Rational, 3>;

ExactPoint exact(const Eigen::Vector3d& p) {
  return {Rational(p.x()), Rational(p.y()), Rational(p.z())};
}

// Whether the closed triangle and the closed cube of half the edge `half` have a point in common,
// in rational arithmetic: the triangle is clipped at the six faces in turn.
bool exactly_intersects(const std::array<Eigen::Vector3d, 3>& triangle, const ExactPoint& center,
                        const Rational& half) {
  std::vector<ExactPoint> polygon = {exact(triangle[0]), exact(triangle[1]), exact(triangle[2])};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      const auto beyond = [&](const ExactPoint& p) -> Rational {
        return side * (p[axis] - center[axis]) - half;
      };
      std::vector<ExactPoint> clipped;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const ExactPoint& a = polygon[i];
        const ExactPoint& b = polygon[(i + 1) % polygon.size()];
        const Rational da = beyond(a);
        const Rational db = beyond(b);
        if (da <= 0) clipped.push_back(a);
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
          const Rational share = da / (da - db);
          ExactPoint cut;
          for (std::size_t k = 0; k < 3; ++k) cut[k] = a[k] + share * (b[k] - a[k]);
          clipped.push_back(cut);
        }
      }
      polygon = clipped;
    }
  }
  return !polygon.empty();
}

struct Tally {
  int meet = 0;
  int apart = 0;
  int only_possibly = 0;  // said to meet, but apart
};

// Compares with the exact answer: never apart where they meet, and never together where even the
// cube grown by `slack` is apart.
Tally compare(int cases, const std::function<Triangle()>& make, const Vector3d& center, double half,
              double slack) {
  Tally tally;
  for (int i = 0; i < cases; ++i) {
    const Triangle triangle = make();
    const bool exact_answer = exactly_intersects(triangle, exact(center), Rational(half));
    const bool answer = internal::may_intersect(triangle, center, half);
    ++(exact_answer ? tally.meet : tally.apart);
    EXPECT_TRUE(answer || !exact_answer) << i;
    if (answer && !exact_answer) {
      ++tally.only_possibly;
      EXPECT_TRUE(exactly_intersects(triangle, exact(center), Rational(half) + Rational(slack)))
          << i;
    }
  }
  return tally;
}

TEST(TriangleIntersectsCube, AgreesWithRationalClipping) {
  Random random(1);
  const Eigen::AlignedBox3d field(Vector3d::Constant(-2.5), Vector3d::Constant(2.5));
  const Tally tally = compare(
      effort(20000, 2000),
      [&] {
        return Triangle{random.in_box(field), random.in_box(field), random.in_box(field)};
      },
      Vector3d::Zero(), 1.0, 1e-12);
  EXPECT_GT(tally.meet, tally.apart / 10);
  EXPECT_GT(tally.apart, tally.meet / 10);
}

// Coordinates on a coarse lattice: corners and edges on faces, edges and corners of the cube,
// triangles that are segments or points.
TEST(TriangleIntersectsCube, TouchingAndDegenerate) {
  Random random(2);
  const auto lattice = [&] {
    Vector3d p;
    for (int k = 0; k < 3; ++k) p[k] = 0.5 * (static_cast<double>(random.index(13)) - 6.0);
    return p;
  };
  const Tally tally = compare(
      effort(20000, 2000),
      [&] {
        return Triangle{lattice(), lattice(), lattice()};
      },
      Vector3d::Zero(), 1.0, 1e-12);
  EXPECT_GT(tally.meet, effort(1000, 100));
  EXPECT_GT(tally.apart, effort(1000, 50));
}

// Moved so that the cube is touched in one point, give or take some units in the last place.
TEST(TriangleIntersectsCube, WithinRoundingOfTouching) {
  Random random(3);
  const Eigen::AlignedBox3d field(Vector3d::Constant(-3.0), Vector3d::Constant(3.0));
  for (const double offset : {0.0, 1e3, 1e9}) {
    const Vector3d center = Vector3d(offset + 1.0 / 3.0, -offset, 0.7 * offset);
    const Tally tally = compare(
        effort(5000, 400),
        [&] {
          Vector3d normal = random.direction();
          Vector3d corner;
          for (int k = 0; k < 3; ++k) corner[k] = normal[k] > 0.0 ? 1.0 : -1.0;
          const double by = 1e-16 * (static_cast<double>(random.index(41)) - 20.0);
          Triangle triangle;
          const Vector3d aside = normal.cross(random.direction());
          const double turns[] = {0.0, 2.1, 4.2};
          for (std::size_t k = 0; k < 3; ++k) {
            const Vector3d in_plane =
                std::cos(turns[k]) * aside + std::sin(turns[k]) * normal.cross(aside);
            triangle[k] = center + corner + by * normal + (1.0 + 40.0 * random.unit()) * in_plane;
          }
          return triangle;
        },
        center, 1.0, 1e-13 * (1.0 + offset));
    EXPECT_GT(tally.meet, effort(100, 4)) << offset;
    EXPECT_GT(tally.only_possibly, offset < 1e6 ? effort(10, 0) : -1) << offset;
  }
}

TEST(TriangleIntersectsCube, NeedlesAndGiants) {
  Random random(4);
  for (const double length : {1e3, 1e8}) {
    const Tally tally = compare(
        effort(5000, 500),
        [&] {
          const Vector3d through = 1.2 * random.direction();
          const Vector3d way = random.direction();
          const Vector3d a = through - length * way;
          return Triangle{a, Vector3d(through + length * way),
                          Vector3d(a + 1e-6 * random.direction())};
        },
        Vector3d::Zero(), 1.0, 1e-12 * length);
    EXPECT_GT(tally.meet, effort(100, 5));
    EXPECT_GT(tally.apart, effort(100, 5));
  }
}

// Centres as whole steps from the first one.
std::set<Index> indices(const Voxelisation& voxels, const Vector3d& from) {
  std::set<Index> result;
  for (const Sphere& sphere : voxels.spheres) {
    const Vector3d at = (sphere.center - from) / voxels.step;
    result.insert({static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())),
                   static_cast<int>(std::lround(at.z()))});
  }
  return result;
}

Eigen::AlignedBox3d box_of(const std::set<Index>& cells) {
  Eigen::AlignedBox3d box;
  for (const Index& c : cells) box.extend(Vector3d(c[0], c[1], c[2]));
  return box;
}

// All coordinates to a multiple of 2^-10, so that the grid's planes are exact and often touched.
TriangleMesh on_lattice(TriangleMesh mesh) {
  for (Vector3d& v : mesh.vertices) v = (v * 1024.0).array().round() / 1024.0;
  return mesh;
}

// The voxels of the surface are those that a triangle intersects in rational arithmetic.
TEST(Voxelise, FindsTheCubesThatTheSurfaceIntersects) {
  for (const std::string& name :
       effort(std::vector<std::string>{"soup", "l bracket", "thin sheet", "cube", "needles"}, 1)) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = on_lattice(name == "cube"         ? cube_mesh()
                                         : name == "l bracket"  ? l_bracket()
                                         : name == "thin sheet" ? thin_sheet(1.0 / 64.0)
                                         : name == "needles"    ? needles(5)
                                                                : soup(20, 3));
    const Voxelisation voxels = voxelise(mesh, {.step = 0.125, .filling = Filling::kSurface});
    ASSERT_FALSE(voxels.spheres.empty());
    EXPECT_EQ(voxels.surface, voxels.spheres.size());
    const Vector3d first = voxels.spheres.front().center;
    const std::set<Index> found = indices(voxels, first);
    EXPECT_EQ(found.size(), voxels.spheres.size());
    const Eigen::AlignedBox3d range = box_of(found);
    int touching = 0;
    for (int x = static_cast<int>(range.min().x()) - 1; x <= range.max().x() + 1; ++x) {
      for (int y = static_cast<int>(range.min().y()) - 1; y <= range.max().y() + 1; ++y) {
        for (int z = static_cast<int>(range.min().z()) - 1; z <= range.max().z() + 1; ++z) {
          const Vector3d center = first + 0.125 * Vector3d(x, y, z);
          const auto intersects = [&](const Rational& half) {
            return std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                               [&](const Eigen::Vector3i& t) {
                                 const auto v = [&](int k) {
                                   return mesh.vertices[static_cast<std::size_t>(t[k])];
                                 };
                                 return exactly_intersects({v(0), v(1), v(2)}, exact(center), half);
                               });
          };
          const bool is_found = found.count({x, y, z}) > 0;
          const bool is_met = intersects(Rational(0.0625));
          EXPECT_TRUE(is_found || !is_met) << center.transpose();
          if (is_found && !is_met) {
            ++touching;
            EXPECT_TRUE(intersects(Rational(0.0625 + 1e-12))) << center.transpose();
          }
        }
      }
    }
    EXPECT_LE(touching, static_cast<int>(found.size()) / 20);
  }
}

// Inside is what a walk over a dense grid does not reach.
TEST(Voxelise, FillsWhatCannotBeReached) {
  for (const NamedMesh& named : mesh_zoo()) {
    SCOPED_TRACE(named.name);
    Eigen::AlignedBox3d box;
    for (const Vector3d& v : named.mesh.vertices) box.extend(v);
    const double step = box.sizes().maxCoeff() / effort(25, 12);
    const Voxelisation surface = voxelise(named.mesh, {.step = step, .filling = Filling::kSurface});
    const Voxelisation solid = voxelise(named.mesh, {.step = step});
    const Vector3d first = surface.spheres.front().center;
    const std::set<Index> walls = indices(surface, first);
    const Eigen::AlignedBox3d range = box_of(walls);
    std::set<Index> reached;
    std::vector<Index> waiting = {{static_cast<int>(range.min().x()) - 1,
                                   static_cast<int>(range.min().y()) - 1,
                                   static_cast<int>(range.min().z()) - 1}};
    reached.insert(waiting.front());
    while (!waiting.empty()) {
      const Index at = waiting.back();
      waiting.pop_back();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int by : {-1, 1}) {
          Index next = at;
          next[axis] += by;
          const auto k = static_cast<Eigen::Index>(axis);
          if (next[axis] < range.min()[k] - 1 || next[axis] > range.max()[k] + 1) continue;
          if (walls.count(next) > 0 || !reached.insert(next).second) continue;
          waiting.push_back(next);
        }
      }
    }
    const std::set<Index> filled = indices(solid, first);
    std::size_t expected = 0;
    for (int x = static_cast<int>(range.min().x()); x <= range.max().x(); ++x) {
      for (int y = static_cast<int>(range.min().y()); y <= range.max().y(); ++y) {
        for (int z = static_cast<int>(range.min().z()); z <= range.max().z(); ++z) {
          if (reached.count({x, y, z}) > 0) continue;
          ++expected;
          EXPECT_EQ(filled.count({x, y, z}), 1U);
        }
      }
    }
    EXPECT_EQ(filled.size(), expected);
    EXPECT_EQ(solid.spheres.size(), expected);
    EXPECT_EQ(solid.surface + solid.inside, expected);
    EXPECT_EQ(solid.surface, surface.surface);
  }
}

TEST(Voxelise, GrowsByPaddingAndVertexError) {
  TriangleMesh mesh = cube_mesh();
  mesh.vertex_error = 0.1;
  const Voxelisation voxels = voxelise(mesh, {.step = 0.11, .padding = 0.2});
  expect_inflated_covered(mesh, 0.2999, 3000, voxels.spheres, 6);
}

TEST(Voxelise, ThePapersSpheresLeaveCorners) {
  const VoxelisationOptions options{.step = 0.1, .sphere = VoxelSphere::kInscribed};
  const TriangleMesh mesh = slender(l_bracket());
  const Voxelisation voxels = voxelise(mesh, options);
  for (const Sphere& sphere : voxels.spheres) EXPECT_EQ(sphere.radius, 0.05);
  const Certificate certificate = certify(mesh, voxels.spheres, {.resolution = 1.0 / 512.0});
  EXPECT_FALSE(certificate.covered);
  EXPECT_GT(certificate.uncovered_depth.lower, 0.01);
}

TEST(Voxelise, LeavesTheBoreOfAPipeOpen) {
  const Voxelisation voxels = voxelise(pipe(20.0, 17.0, 100.0, 40), {.step = 2.0});
  for (const Sphere& sphere : voxels.spheres) {
    EXPECT_GT(std::hypot(sphere.center.x(), sphere.center.y()), 14.0);
  }
  EXPECT_EQ(voxelise(nested_shells(3), {.step = 0.1}).inside,
            voxelise(nested_shells(1), {.step = 0.1}).spheres.size() -
                voxelise(nested_shells(3), {.step = 0.1}).surface);
}

TEST(Voxelise, RefusesWithNumbers) {
  try {
    voxelise(cube_mesh(100.0), {.step = 1e-3});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.subject(), "step");
    EXPECT_NE(error.reason().find("0.001 for a model of size 100"), std::string::npos)
        << error.reason();
    EXPECT_NE(error.reason().find("16777216"), std::string::npos) << error.reason();
  }
  // Few cells of the octree, but too many voxels inside.
  if (!kSanitized) {
    EXPECT_THROW(voxelise(cube_mesh(500.0), {.step = 1.0}), Error);
  }
  EXPECT_THROW(voxelise(cube_mesh(), {}), Error);
  EXPECT_THROW(voxelise(cube_mesh(), {.step = 0.1, .max_error = 0.1}), Error);
  EXPECT_THROW(voxelise(cube_mesh(), {.step = -1.0}), Error);
  EXPECT_THROW(voxelise(cube_mesh(), {.step = 1e-12}), Error);
  EXPECT_THROW(voxelise(cube_mesh(), {.step = std::nan("")}), Error);
  EXPECT_THROW(voxelise(cube_mesh(), {.step = 0.1, .padding = -1.0}), Error);
  EXPECT_THROW(voxelise({}, {.step = 0.1}), Error);
  Eigen::Isometry3d far = Eigen::Isometry3d::Identity();
  far.translate(Vector3d(1e12, 0.0, 0.0));
  EXPECT_THROW(voxelise(moved(cube_mesh(), far), {.step = 0.1}), Error);
}

// The tree's parents enclose their children, by long double; its leaves are spheres around cubes.
void expect_layered(const SphereTree& tree) {
  EXPECT_TRUE(check(tree).valid);
  for (std::size_t node = 0; node < tree.node_count(); ++node) {
    if (tree.is_leaf(node)) continue;
    const Sphere parent = tree.sphere(node);
    for (std::int32_t k = 0; k < tree.child_count(node); ++k) {
      const Sphere child = tree.sphere(static_cast<std::size_t>(tree.first_child(node) + k));
      ASSERT_LE(judged_distance(parent.center, child.center) + static_cast<Real>(child.radius),
                static_cast<Real>(parent.radius));
      // The method's own sphere around the cube, not one made for the children.
      ASSERT_NEAR(child.radius, parent.radius / 2.0, 1e-4 * child.radius);
    }
  }
}

// Spheres around cubes cover, by samples, near the origin and far from it, and by the certificate.
TEST(SpheresAroundCubes, CoverWhereverTheMeshIs) {
  Random random(5);
  for (const NamedMesh& named : effort(zoo_to_fit(), 2)) {
    SCOPED_TRACE(named.name);
    for (const double offset : effort(std::vector{1e6, 0.0}, 1)) {
      SCOPED_TRACE(offset);
      const TriangleMesh mesh = moved_far(named.mesh, offset);
      const double max_error = 0.08 * diagonal_of(mesh);
      expect_samples_covered(mesh, voxelise(mesh, {.max_error = max_error}).spheres, random);
      const OctreeSpheres octree = octree_spheres(mesh, {.max_error = max_error});
      expect_layered(octree.tree);
      expect_samples_covered(mesh, octree.tree.spheres(), random);
    }
  }
}

TEST(SpheresAroundCubes, CoverAsCertified) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  for (const std::string& name :
       effort(std::vector<std::string>{"l-bracket", "soup", "open-box"}, 2)) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = moved_far(slender(mesh_named(name)), 1e6);
    const double max_error = 0.02 * diagonal_of(mesh);
    expect_certified(mesh, voxelise(mesh, {.max_error = max_error}).spheres, max_error);
    expect_certified(mesh, octree_spheres(mesh, {.max_error = max_error}).tree.spheres(),
                     max_error);
  }
}

TEST(OctreeSpheres, ProtrusionIsProvedOnAWholePart) {
  const TriangleMesh mesh = slender(l_bracket());
  const OctreeSpheres result = octree_spheres(mesh, {.max_error = 0.05});
  const Certificate certificate =
      certify(mesh, result.tree.spheres(),
              {.resolution = 1.0 / 512.0, .protrusion_tolerance = 5e-3, .volume = false});
  // The certificate's bounds are 0.5 % of the diagonal apart.
  EXPECT_LE(certificate.protrusion_over_mesh->upper, 0.06);
  EXPECT_GT(certificate.protrusion_over_mesh->lower, 0.02);
}

TEST(OctreeSpheres, ADepthGivesCubesOfOneSizeOnTheSurface) {
  Random random(12);
  for (const int depth : {1, 3, 5}) {
    SCOPED_TRACE(depth);
    const OctreeSpheres solid = octree_spheres(l_bracket(), {.depth = depth});
    EXPECT_EQ(solid.tree.depth(), depth);
    expect_layered(solid.tree);
    expect_samples_covered(l_bracket(), solid.tree.spheres(), random);
    const OctreeSpheres surface =
        octree_spheres(l_bracket(), {.depth = depth, .filling = Filling::kSurface});
    expect_layered(surface.tree);
    const double radius = surface.tree.spheres().front().radius;
    EXPECT_NEAR(radius, std::sqrt(0.75) * surface.step, 1e-9);
    for (const Sphere& sphere : surface.tree.spheres()) EXPECT_EQ(sphere.radius, radius);
    EXPECT_EQ(
        judge_cover(points_on_surface(l_bracket(), 2000, random), surface.tree.spheres()).uncovered,
        0U);
    EXPECT_LE(surface.tree.spheres().size(), solid.tree.spheres().size());
  }
}

// Large cubes stay whole where they may: far fewer spheres than cubes of the smallest size.
TEST(OctreeSpheres, KeepsLargeCubesInside) {
  const OctreeSpheres result = octree_spheres(icosphere(3), {.max_error = 0.1});
  const auto [least, most] =
      std::minmax_element(result.tree.spheres().begin(), result.tree.spheres().end(),
                          [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
  EXPECT_GE(most->radius, 3.9 * least->radius);
}

TEST(OctreeSpheres, FillsSealedHollows) {
  const TriangleMesh shells = nested_shells(2);
  const OctreeSpheres result = octree_spheres(shells, {.max_error = 0.1});
  const Vector3d middle = MeshDistance(shells).box().center();
  EXPECT_LE(gap_to_spheres(middle, result.tree.spheres()), 0.0L);
  const OctreeSpheres surface =
      octree_spheres(shells, {.max_error = 0.1, .filling = Filling::kSurface});
  EXPECT_GT(gap_to_spheres(middle, surface.tree.spheres()), 0.0L);
}

TEST(OctreeSpheres, Refuses) {
  EXPECT_THROW(octree_spheres(cube_mesh(), {}), Error);
  EXPECT_THROW(octree_spheres(cube_mesh(), {.depth = -1}), Error);
  EXPECT_THROW(octree_spheres(cube_mesh(), {.depth = 21}), Error);
  EXPECT_THROW(octree_spheres(cube_mesh(), {.depth = 3, .max_error = 0.1}), Error);
  EXPECT_THROW(octree_spheres(cube_mesh(), {.depth = 15}), Error);
  EXPECT_THROW(octree_spheres(cube_mesh(), {.max_error = 1e-4}), Error);
  EXPECT_THROW(octree_spheres(cube_mesh(), {.max_error = 0.1, .padding = -0.1}), Error);
  EXPECT_THROW(octree_spheres({}, {.max_error = 0.1}), Error);
  TriangleMesh point;
  point.vertices = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  point.triangles = {{0, 1, 2}};
  EXPECT_THROW(octree_spheres(point, {.depth = 2}), Error);
  EXPECT_EQ(octree_spheres(point, {.max_error = 0.1}).tree.spheres().size(), 1U);
}

}  // namespace
}  // namespace spherule::test
