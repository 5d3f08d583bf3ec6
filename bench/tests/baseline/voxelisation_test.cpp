// SPDX-License-Identifier: BSD-3-Clause
#include "bench/baseline/voxelisation.h"

#include "base/error.h"
#include "bench/tests/baseline/cover_check.h"
#include "bench/tests/baseline/exact_cube.h"
#include "simplifier/simplify.h"
#include "tests/simplifier/judge.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"
#include "tests/support/zoo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

namespace spherule::test {
namespace {

using Eigen::Vector3d;
using Index = std::array<int, 3>;

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

// Circumscribed spheres cover, by the certificate and by samples, near the origin and far from it.
TEST(Voxelise, CoversWithCircumscribedSpheres) {
  Random random(5);
  for (const NamedMesh& named : effort(zoo_to_fit(), 2)) {
    SCOPED_TRACE(named.name);
    for (const double offset : effort(std::vector{1e6, 0.0}, 1)) {
      SCOPED_TRACE(offset);
      const TriangleMesh mesh = moved_far(named.mesh, offset);
      const Voxelisation voxels = voxelise(mesh, {.max_error = 0.05 * diagonal_of(mesh)});
      expect_samples_covered(mesh, voxels.spheres, random);
    }
  }
}

TEST(Voxelise, CoversAsCertified) {
  if (kSanitized) GTEST_SKIP() << kLeftToRelease;
  for (const std::string& name :
       effort(std::vector<std::string>{"l-bracket", "soup", "open-box"}, 2)) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = moved_far(slender(mesh_named(name)), 1e6);
    const double max_error = 0.02 * diagonal_of(mesh);
    expect_certified(mesh, voxelise(mesh, {.max_error = max_error}).spheres, max_error);
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

}  // namespace
}  // namespace spherule::test
